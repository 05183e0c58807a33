"""Write the evidence of a study as one file, and check such a file without a network.

A bundle of a study has its texts and files in ``sources/``, all its results in ``study/results.json`` and the traces
that the study has kept in ``study/traces/``. Most studies keep none or few: an execution follows from its seed, so the
check executes some of them again.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby, islice
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any, cast

from robbdd_tools import __version__
from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import load_bytes, load_text, uri_to_path
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.campaign.evidence_parts import (
    Bundle,
    Check,
    NoEvidence,
    json_bytes,
    sha256,
    source_names,
    write_archive,
)
from robbdd_tools.campaign.study_again import NotAgain, execute_again
from robbdd_tools.campaign.study_batches import batches
from robbdd_tools.campaign.study_changes import changed_study
from robbdd_tools.campaign.study_evidence_graph import GRAPH, evidence_graph, graph_check
from robbdd_tools.campaign.study_file import Study, load_study
from robbdd_tools.campaign.study_place import BATCHES, open_results, study_folder
from robbdd_tools.campaign.study_traces import TRACES, kept_trace, traces_in
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.run.study_store import restore
from robbdd_tools.run.user_code import UserCodeRefused

if TYPE_CHECKING:
    from robbdd_tools.run.study_reader import StudyReader

STUDY = "study"
"""The kind of these bundles, and their folder."""
RESULTS = f"{STUDY}/results.json"
MOST_PROBLEMS = 20
"""At most this many contradictions of a kind are listed."""
_FILES = "files "
Key = tuple[str, str, int, str, int, int]
"""Cell, variant, variation, ``.bddx`` execution, repetition and seed of an execution."""


def pack_study(path: Path, store: Path | None, output: Path, *, traces: bool = True) -> Bundle:
    """Write the bundle of a study. Raises ``NoEvidence``, ``StudyProblem``, ``DatabaseProblem`` and ``OSError``.

    The study, its models and files must be unchanged since its executions. Equal studies make equal bundles. Without
    ``traces``, the bundle of a study that has kept some has no graph either, since the check could not build it again.
    """
    folder = study_folder(path, store)
    study = load_study(path)
    if any(one.is_error for one in study.findings):
        raise NoEvidence(f"{path} has errors: a bundle contains the study that was executed")
    with open_results(folder) as results:
        reason = changed_study(study, results)
        if reason:
            raise NoEvidence(f"{reason}, or execute it again")
        tables, facts = results.tables(), results.facts()
        graph = evidence_graph(study, results, folder) if traces or not traces_in(folder) else None
        total = sum(results.verdicts().values())
    used = _used(folder, facts)
    for name, (file, digest) in used.items():
        if not file.is_file() or sha256(load_bytes(file, RESULT_SIZE)) != digest:
            raise NoEvidence(
                f"{PurePosixPath(name).name} changed since the study began: undo that, or execute it again"
            )
    names = source_names([*_texts(study), *(file for file, _ in used.values())])
    files = {name: load_bytes(file, RESULT_SIZE) for file, name in names.items()}
    files[RESULTS] = json_bytes(tables)
    files |= {} if graph is None else {GRAPH: graph}
    for number in traces_in(folder) if traces else ():
        files[f"{STUDY}/{TRACES}/{number}.mcap"] = load_bytes(kept_trace(folder, number), RESULT_SIZE)
    contents = {
        "kind": STUDY,
        "robbdd": facts.get("version", ""),
        "simulator": facts.get("simulator", ""),
        "model": names[path.resolve()],
        "study_digest": study.digest,
        "used": {name: names[file] for name, (file, _) in sorted(used.items())},
    }
    return Bundle(write_archive(output, contents, files), total)


def study_counts(folder: Path) -> tuple[int, int]:
    """Return the number of executions in an unpacked bundle, and how many hold; 0 if they cannot be read."""
    try:
        rows = json.loads(load_text(folder / RESULTS, RESULT_SIZE))["execution"]
        return len(rows), sum(row[5] == 0 for row in rows)
    except (OSError, ValueError, KeyError, TypeError, IndexError):
        return 0, 0


def study_checks(contents: Mapping[str, Any], folder: Path, replays: int) -> Iterator[Check]:
    """Check an unpacked bundle whose files are intact. ``replays`` executions are executed again."""
    path = folder / str(contents.get("model", ""))
    try:
        study = load_study(path)
    except RobbddError as error:
        yield Check(STUDY, "", (f"the study cannot be used: {str(error).replace(str(folder), '')}",))
        return
    errors = [one.message for one in study.findings if one.is_error]
    if errors:
        yield Check(STUDY, "", (f"the study cannot be used: {errors[0]}",))
        return
    try:
        tables = json.loads(load_text(folder / RESULTS, RESULT_SIZE))
        with restore(folder / STUDY, tables) as store:
            yield _same_study(contents, study, store)
            yield _same_files(contents, folder, store)
            yield _planned(study, store)
            yield _consistent(store)
            if GRAPH in contents["files"]:
                yield graph_check(study, store, folder / STUDY, folder / GRAPH)
            yield _again(path, store, folder, replays)
    except (RobbddError, OSError, ValueError, KeyError, TypeError, IndexError) as error:
        yield Check("results", "", (f"{RESULTS} cannot be used: {str(error).replace(str(folder), '')}",))


def _texts(study: Study) -> list[Path]:
    """Return the study, and its models and the scene instances of its levels with everything that they import."""
    assert study.model is not None
    found: dict[Path, None] = {study.path.resolve(): None}
    for one in (*study.model.files, *study.scene_files):
        for analysis in one.snapshot.closure(one.uri):
            file = uri_to_path(analysis.document.uri)
            found |= {} if file is None else {file.resolve(): None}
    return list(found)


def _used(folder: Path, facts: Mapping[str, str]) -> dict[str, tuple[Path, str]]:
    """Return the other files that the executions used, by their names in the facts, with their digests.

    Names are relative to the folder of a batch. Copies of the steps in a model follow from the model.
    """
    found: dict[str, tuple[Path, str]] = {}
    for digests in _digests(facts):
        for name, digest in digests.items():
            if "/" in name:
                found[name] = ((folder / BATCHES / "1" / name).resolve(), digest)
    return found


def _digests(facts: Mapping[str, str]) -> list[dict[str, str]]:
    return [json.loads(content) for fact, content in sorted(facts.items()) if fact.startswith(_FILES)]


def _same_study(contents: Mapping[str, Any], study: Study, store: StudyReader) -> Check:
    stated = ((str(contents.get("study_digest", "")), "bundle.json"), (store.fact("digest") or "", RESULTS))
    problems = tuple(
        f"the digest of the study is {study.digest[:12]}, and {where} states {digest[:12]}"
        for digest, where in stated
        if digest != study.digest
    )
    return Check(STUDY, "the texts in sources give the study that was executed", problems)


def _same_files(contents: Mapping[str, Any], folder: Path, store: StudyReader) -> Check:
    places = cast("dict[str, str]", contents.get("used", {}))
    wanted = {name: digest for digests in _digests(store.facts()) for name, digest in digests.items() if "/" in name}
    problems: list[str] = []
    for name, digest in sorted(wanted.items()):
        entry = places.get(name, "")
        # Only names of the list of contents were written into the folder.
        data = load_bytes(folder / entry, RESULT_SIZE) if entry in contents["files"] else b""
        if sha256(data) != digest:
            problems.append(f"{PurePosixPath(name).name} in sources is not the file that was used")
    detail = f"digests of {len(wanted)} other file{'s' * (len(wanted) != 1)} are those that the executions stated"
    return Check("files", detail, tuple(problems))


def _planned(study: Study, store: StudyReader) -> Check:
    """Compare the stored executions with those that the study plans, in their order."""
    planned: Sequence[Key] = [key for batch in batches(study) for key in _keys(batch.cell.words, batch.plan(), study)]
    stored = [
        (one.cell, one.variant, one.variation, one.execution, one.repetition, one.seed) for one in store.executions()
    ]
    counted = Counter(stored)
    problems = [f"{_named(key)} is not planned" for key in counted.keys() - set(planned)]
    problems += [f"{_named(key)} is stored {number} times" for key, number in counted.items() if number > 1]
    missing = [key for key in planned[: len(stored)] if key not in counted]
    problems += [f"{_named(key)} is missing, and later ones are stored" for key in missing]
    left = len(planned) - len(stored)
    holding = store.verdicts().get(Outcome.HOLDS, 0)
    is_stopped = study.stop is not None and study.stop.ruling(holding, len(stored)) is not None
    open_ = f"{left} of {len(planned)} planned executions have no result" if left > 0 and not is_stopped else ""
    detail = f"{len(stored)} of {len(planned)} executions are those that the study plans, with their seeds"
    return Check("executions", detail, tuple(sorted(problems)[:MOST_PROBLEMS]), open_)


def _keys(cell: str, plan: Any, study: Study) -> Iterator[Key]:
    for spec in plan.specs(repeat=study.repeat):
        execution = "" if spec.execution is None else spec.execution.name
        yield cell, spec.variant, spec.variation, execution, spec.repetition, spec.seed


def _named(key: Key) -> str:
    cell, variant, variation, _, repetition, seed = key
    name = variant.replace("#", "/").rsplit("/", 1)[-1]
    return f"{name} {variation} (repetition {repetition}, seed {seed}{f', {cell}' if cell else ''})"


def _consistent(store: StudyReader) -> Check:
    """Check that the verdict of each execution follows from those of its clauses."""
    problems: list[str] = []
    count = 0
    for number, group in groupby(store.rows(), key=lambda row: int(row["number"])):
        rows = list(group)
        count += 1
        verdicts = {str(row["verdict"]) for row in rows}
        follows = next((str(one) for one in (Outcome.VIOLATED, Outcome.UNKNOWN) if str(one) in verdicts), "holds")
        if str(rows[0]["scenario_verdict"]) != follows:
            problems.append(f"execution {number}: stated is {rows[0]['scenario_verdict']}, its clauses give {follows}")
    stored = sum(store.verdicts().values())
    if count != stored:
        problems.append(f"{stored - count} executions have no clauses")
    return Check("verdicts", f"{count} verdicts follow from those of clauses", tuple(problems[:MOST_PROBLEMS]))


def _again(path: Path, store: StudyReader, folder: Path, replays: int) -> Check:
    """Execute some executions again, spread evenly over the study, and compare verdicts and margins."""
    name = "replays"
    numbers = [one.number for one in store.executions()]
    version = store.fact("version")
    if not replays:
        return Check(name, "", unchecked="no execution was executed again: --replay N executes N of them")
    if version != __version__:
        return Check(name, "", unchecked=f"only RobBDD {version} can execute them again, and this is {__version__}")
    step = max(1, len(numbers) // replays)
    chosen = [number - 1 for number in islice(numbers, 0, None, step)][:replays]
    try:
        execute_again(path, store, chosen, folder / "again", Policy.of(), force=True)
    except NotAgain as error:
        return Check(name, "", (str(error),))
    except UserCodeRefused:
        reason = "the study executes users' Python code in the bundle, which --user-code permits if you trust it"
        return Check(name, "", unchecked=f"no execution was executed again: {reason}")
    return Check(
        name, f"{len(chosen)} of {len(numbers)} executions, executed again, have the same verdicts and margins"
    )
