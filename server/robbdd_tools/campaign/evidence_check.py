"""Check a bundle of evidence without a network: whether it is complete, and whether its parts support each other."""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
import zipfile
import zlib
from collections.abc import Generator, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any, cast

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import load_bytes, load_text
from robbdd_tools.base.isolation import NO_USER_CODE
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.base.writing import replace_file
from robbdd_tools.campaign.evidence_bundle import GRAPH, RUN, graph_of
from robbdd_tools.campaign.evidence_parts import CONTENTS, FORMAT, SOURCES, Check
from robbdd_tools.campaign.study_evidence import STUDY, study_checks, study_counts
from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.run.results import finished_in
from robbdd_tools.run.store import RESULTS, run_in
from robbdd_tools.run.user_code import UserCodeRefused
from robbdd_tools.workbench.execution_rows import execution_results
from robbdd_tools.workbench.judging import judge
from robbdd_tools.workbench.model import load_all
from robbdd_tools.workbench.stored import PastRun

if TYPE_CHECKING:
    from robbdd_tools.workbench.execution_rows import ClauseResult, ExecutionResult
    from robbdd_tools.workbench.model import Model

MOST_ENTRIES = 200_000
"""Limit of the number of files in a bundle."""
MOST_CONTRADICTIONS = 20
"""At most this many contradictions of a kind are listed."""


class NotABundle(RobbddError):
    """The file is not a bundle of evidence, or its version is not supported."""


@dataclass(frozen=True, slots=True)
class Verification:
    """The result for a bundle. ``digest`` is the SHA-256 of its list of contents, which covers all of it."""

    digest: str
    robbdd: str
    simulator: str
    model: str
    executions: int
    holding: int
    checks: tuple[Check, ...]

    @property
    def contradicts(self) -> bool:
        """Whether something in the bundle contradicts the rest."""
        return any(check.problems for check in self.checks)

    @property
    def is_complete(self) -> bool:
        """Whether everything could be checked."""
        return not any(check.unchecked for check in self.checks)


def verify_bundle(path: Path, *, digest: str = "", user_code: bool = False, replays: int = 0) -> Verification:
    """Check a bundle. It must have the ``digest``, if given. With ``user_code``, its users' code may be executed.

    Of a study, this many executions (``replays``) are executed again.

    Raises ``NotABundle`` and ``OSError``.
    """
    try:
        with zipfile.ZipFile(path) as archive, tempfile.TemporaryDirectory(prefix="robbdd-") as folder:
            found = _contents(archive)
            files = _Files(archive, found, Path(folder))
            checks = [files.intact(digest)]
            is_study = found.get("kind") == STUDY
            with code_permitted(permitted=user_code):
                if not checks[0].problems and is_study:
                    checks += study_checks(found, Path(folder), replays)
                elif not checks[0].problems:
                    checks += _derived(found, Path(folder))
            executions, holding = study_counts(Path(folder)) if is_study else files.counts()
            stated = {name: str(found.get(name, "")) for name in ("robbdd", "simulator", "model")}
            return Verification(files.digest, **stated, executions=executions, holding=holding, checks=tuple(checks))
    # zipfile raises NotImplementedError for a compression that it does not know.
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError) as error:
        raise NotABundle(f"{path} is not a bundle of evidence, or it is damaged: {error}") from error


@contextmanager
def code_permitted(*, permitted: bool) -> Generator[None]:
    """Refuse users' code, unless it is ``permitted``."""
    before = os.environ.get(NO_USER_CODE)
    if not permitted:
        os.environ[NO_USER_CODE] = "1"
    try:
        yield
    finally:
        if before is None:
            os.environ.pop(NO_USER_CODE, None)
        else:
            os.environ[NO_USER_CODE] = before


def _contents(archive: zipfile.ZipFile) -> Mapping[str, Any]:
    """Return the list of contents. Raises ``NotABundle``."""
    try:
        document: object = json.loads(_read(archive, CONTENTS))
    except KeyError:
        raise NotABundle(f"{archive.filename} is not a bundle of evidence: it has no {CONTENTS}") from None
    except ValueError as error:
        raise NotABundle(f"{archive.filename}: {CONTENTS} is not JSON: {error}") from error
    if not isinstance(document, dict):
        raise NotABundle(f"{archive.filename}: {CONTENTS} is not an object")
    found = cast(dict[str, Any], document)
    if found.get("format") != FORMAT:
        raise NotABundle(f"{archive.filename} has the format {found.get('format')}, and this RobBDD reads {FORMAT}")
    listed: object = found.get("files")
    if not isinstance(listed, dict) or not all(
        isinstance(one, str) for one in cast(dict[str, object], listed).values()
    ):
        raise NotABundle(f"{archive.filename}: {CONTENTS} does not list files with their digests")
    return found


def _read(archive: zipfile.ZipFile, name: str) -> bytes:
    """Return an entry. Raises ``KeyError``, and ``NotABundle`` if the entry is too large for any result."""
    # No more than the stated size is unpacked, whatever the entry contains.
    limit = RESULT_SIZE.value()
    if archive.getinfo(name).file_size > limit:
        raise NotABundle(f"{archive.filename}: {name} is larger than {limit} bytes")
    return archive.read(name)


class _Files:
    """The files of a bundle. ``intact`` writes them into a folder."""

    def __init__(self, archive: zipfile.ZipFile, contents: Mapping[str, Any], folder: Path) -> None:
        self._archive = archive
        self._listed: Mapping[str, str] = contents["files"]
        self._folder = folder
        self.digest = hashlib.sha256(_read(archive, CONTENTS)).hexdigest()

    def intact(self, digest: str) -> Check:
        """Check that the bundle has exactly the listed files, with the listed digests, and write them."""
        problems: list[str] = []
        if digest and digest.lower() != self.digest:
            problems.append(f"the digest of the bundle is {self.digest}, not {digest}")
        names = self._archive.namelist()
        if len(names) > MOST_ENTRIES:
            raise NotABundle(f"{self._archive.filename} has more than {MOST_ENTRIES} files")
        problems += [f"{name} is listed twice" for name in sorted({one for one in names if names.count(one) > 1})]
        problems += [f"{name} is not listed in {CONTENTS}" for name in names if name not in {CONTENTS, *self._listed}]
        problems += [f"{name} is missing" for name in self._listed if name not in names]
        for name, expected in self._listed.items():
            if not _is_inside(name):
                problems.append(f"{name} is no name of a file in a bundle")
            elif name in names:
                data = _read(self._archive, name)
                if hashlib.sha256(data).hexdigest() != expected:
                    problems.append(f"{name} was changed: its SHA-256 is not the listed one")
                target = self._folder / name
                target.parent.mkdir(parents=True, exist_ok=True)
                replace_file(target, data)
        return Check("contents", f"{len(self._listed)} files have their SHA-256", tuple(problems))

    def counts(self) -> tuple[int, int]:
        """Return the number of executions, and how many hold; 0 if the results cannot be read."""
        try:
            results = execution_results(json.loads(load_text(self._folder / RUN / RESULTS, RESULT_SIZE)))
        except (OSError, ValueError, KeyError, TypeError):
            return 0, 0
        return len(results), sum(one.verdict == "holds" for one in results)


def _is_inside(name: str) -> bool:
    """Return whether the name of an entry stays in the folder into which it is written, on every system."""
    path = PurePosixPath(name)
    return (
        not path.is_absolute()
        and bool(path.parts)
        and not any(set(part) <= {"."} or set(part) & set(":\\\0") for part in path.parts)
    )


def _derived(contents: Mapping[str, Any], folder: Path) -> Iterator[Check]:
    """Derive the model's graph, the graph with results and the verdicts from other parts, and compare them."""
    try:
        model = load_all([folder / str(contents.get("model", ""))])
        graph_digest = model.digest
    except RobbddError as error:
        reason = "; ".join(str(error).splitlines()).replace(f"{folder}{os.sep}", "")
        yield Check("model", "", (f"the model cannot be used: {reason}",))
        return
    run = PastRun(run_in(folder / RUN))
    stated = (str(contents.get("graph_digest", "")), run.record.digest)
    other = tuple(
        f"the digest of the model's graph is {graph_digest[:12]}, and {where} states {one[:12]}"
        for where, one in zip((CONTENTS, "the record of the run"), stated, strict=True)
        if one != graph_digest
    )
    yield Check("model", f"the texts in {SOURCES} give the graph that was executed", other)
    if other:
        return
    document = run.place.results()
    finished = finished_in(document)
    kept = [index for index in sorted(finished) if trace_file(run.folder, index).is_file()]
    yield _judged(run, load_all([folder / str(contents["model"])]), kept, sorted(finished))
    yield _graph(model, document, folder, run, kept)


def _graph(model: Model, document: Mapping[str, Any], folder: Path, run: PastRun, kept: list[int]) -> Check:
    from robbdd_tools.graph.write.run_results import BadResults

    digests = {
        index: hashlib.sha256(load_bytes(trace_file(run.folder, index), RESULT_SIZE)).hexdigest() for index in kept
    }
    name, detail = "graph", f"{GRAPH} is that of the model, its results and its traces"
    try:
        same = graph_of(model, document, digests).encode() == load_bytes(folder / GRAPH, RESULT_SIZE)
    except (BadResults, OSError) as error:
        return Check(name, detail, (str(error),))
    return Check(name, detail, () if same else (f"{GRAPH} is not the graph of the model with these results",))


def _judged(run: PastRun, model: Model, kept: list[int], finished: list[int]) -> Check:
    """Judge the traces again by the model's clauses, and compare verdicts and margins with those in the bundle."""
    name = "verdicts"
    if not kept:
        return Check(name, "", unchecked="the bundle has no traces, so no verdict was judged again")
    try:
        judged = judge(run, model)
    except UserCodeRefused:
        reason = "clauses are evaluated by users' Python code in the bundle, which --user-code executes if you trust it"
        return Check(name, "", unchecked=f"no verdict was judged again: {reason}")
    except RobbddError as error:
        reason = "; ".join(str(error).splitlines())
        return Check(name, "", unchecked=f"no verdict was judged again: {reason}")
    stated = {one.index: one for one in run.results}
    again = {one.index: one for one in judged.results}
    problems = [f"{stated[index].name}: the model has no such scenario" for index in kept if index not in again]
    compared, behaviours = 0, 0
    for index in kept:
        if index in again:
            clauses = zip(stated[index].clauses, again[index].clauses, strict=False)
            pairs = [(old, new) for old, new in clauses if old.role != "when"]
            behaviours += len(stated[index].clauses) - len(pairs)
            compared += len(pairs)
            problems += _differing(stated[index], again[index], pairs)
    open_ = f"{len(finished) - len(kept)} executions have no trace" if len(kept) < len(finished) else ""
    if judged.ending:
        open_ = f"the judgement ended early: {judged.ending}"
    left = f"; {behaviours} verdicts on behaviours are those of the run" if behaviours else ""
    detail = f"{compared} verdicts of {len(kept)} execution{'s' * (len(kept) != 1)} follow from the traces{left}"
    return Check(name, detail, tuple(_first(problems)), open_)


def _differing(
    stated: ExecutionResult, again: ExecutionResult, pairs: list[tuple[ClauseResult, ClauseResult]]
) -> Iterator[str]:
    if [one.iri for one in stated.clauses] != [one.iri for one in again.clauses]:
        yield f"{stated.name}: its clauses are not those of the model"
    for old, new in pairs:
        if (old.verdict, old.margin) != (new.verdict, new.margin):
            said = f"{old.verdict} ({old.margin})"
            yield f"{stated.name}, {old.name}: stated is {said}, and the trace gives {new.verdict} ({new.margin})"
    worst = {str(clause.verdict) for clause in stated.clauses}
    follows = next((one for one in ("violated", "unknown") if one in worst), "holds")
    if stated.verdict != follows:
        yield f"{stated.name}: stated is {stated.verdict}, and its clauses give {follows}"


def _first(problems: list[str]) -> Iterator[str]:
    yield from problems[:MOST_CONTRADICTIONS]
    if len(problems) > MOST_CONTRADICTIONS:
        yield f"and {len(problems) - MOST_CONTRADICTIONS} more"
