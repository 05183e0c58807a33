"""The process that compares stored executions with edited texts, and lets another process re-judge edited clauses.

It reads ``Edited`` messages until its input ends, and answers each with ``Rejudged`` messages. A message replaces an
older one about the same model, even while the older one is being judged. A second process judges the traces
(``agent/rejudge_edits.py``). Neither of them simulates, executes users' code, or writes into the project.
"""

from __future__ import annotations

import logging
import os
import sys
import tempfile
from collections.abc import Container, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.isolation import NO_USER_CODE
from robbdd_tools.base.memory import collect_rarely, collect_recent
from robbdd_tools.base.source_texts import use_unsaved
from robbdd_tools.features.run_verdicts import Digests, Judgement, RejudgedExecution, digests_of
from robbdd_tools.lsp.framing import Edited, Execution, Rejudged, frame
from robbdd_tools.lsp.worker import Inbox
from robbdd_tools.names.project import Project
from robbdd_tools.protocol.judge_orders import JudgeOrder, StoredTrace
from robbdd_tools.protocol.manifest_file import MANIFEST
from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.protocol.spec_changes import AGAIN
from robbdd_tools.run.readable import readable
from robbdd_tools.run.store import NoSuchRun, RunStore
from robbdd_tools.workbench.edited_executions import EditedExecution, edited_executions
from robbdd_tools.workbench.judged_scenarios import judgement, refused_judgement
from robbdd_tools.workbench.model import DraftFile
from robbdd_tools.workbench.trace_judge import JudgeEnded, TraceJudge

if TYPE_CHECKING:
    from robbdd_tools.protocol.messages import ClauseJudged
    from robbdd_tools.protocol.specs import Manifest
    from robbdd_tools.run.store import StoredRun

_LOG = logging.getLogger(__name__)
GONE = f"the run is gone: {AGAIN}"
STEP = 16
"""Maximum number of traces that are judged before a newer edit is noticed."""
BATCH = 64
"""Results are sent in parts of this many executions."""
LOADED = 256
"""At most this many traces are loaded before the first edit of a model."""


@dataclass(slots=True)
class Worker:
    """The state of the process between two messages."""

    inbox: Inbox[Edited]
    folder: Path
    project: Project = field(default_factory=Project)
    judge: TraceJudge | None = None
    manifests: dict[Path, tuple[int, Manifest]] = field(default_factory=dict[Path, "tuple[int, Manifest]"])
    loaded: set[Path] = field(default_factory=set[Path])

    def answers(self, edited: Edited) -> Iterator[Rejudged]:
        """Yield the results of an edit. They end early if a newer edit replaces it."""
        try:
            yield from self._answers(edited)
        except JudgeEnded as error:
            yield Rejudged(edited.revision, edited.uri, {}, 0, 0, str(error))
        except (RobbddError, OSError) as error:
            # A model with errors is the usual case: nobody finishes a word in one keystroke.
            yield Rejudged(edited.revision, edited.uri, {}, 0, 0, str(error))
        except Exception as error:  # An internal error must cost one answer, not the process.
            _LOG.exception("internal error in re-judging %s", edited.uri)
            yield Rejudged(edited.revision, edited.uri, {}, 0, 0, f"{type(error).__name__}: {error}")

    def _answers(self, edited: Edited) -> Iterator[Rejudged]:
        self.project.replace(edited.texts)
        use_unsaved(edited.sources)
        self.project.load(edited.uri)
        snapshot = self.project.snapshot()
        file = DraftFile(snapshot, edited.uri, edited.uri)
        drafts = {uri: text for uri, (_, text) in edited.texts.items()}
        unusable: dict[Execution, RejudgedExecution] = {}
        concerned: list[tuple[StoredRun, list[EditedExecution]]] = []
        for number, indices in edited.executions.items():
            try:
                place = RunStore(Path(edited.store)).find(str(number))
                concerned.append((place, list(edited_executions(place, self._manifest(place), file, indices, drafts))))
            except NoSuchRun:
                unusable |= {(number, index): RejudgedExecution(GONE) for index in indices}
        unusable |= {
            (place.number, one.index): RejudgedExecution(one.reason)
            for place, executions in concerned
            for one in executions
            if one.spec is None
        }
        self._forget_runs(Path(edited.store), {place.folder for place, _ in concerned})
        done, total = 0, len(unusable) + sum(one.spec is not None for _, every in concerned for one in every)
        waiting, digests = unusable, digests_of(snapshot, edited.uri)
        for place, executions in concerned:
            for alike in _alike(executions):
                if self.inbox.has_newer(edited.uri):
                    return
                waiting |= self._judged(place, alike, digests)
                if len(waiting) >= BATCH:
                    done += len(waiting)
                    yield Rejudged(edited.revision, edited.uri, waiting, done, total)
                    waiting = {}
        if waiting or not total:
            yield Rejudged(edited.revision, edited.uri, waiting, total, total)
        if not total:
            self._load(edited, [place for place, _ in concerned])

    def _judged(
        self, place: StoredRun, alike: list[EditedExecution], digests: Digests
    ) -> dict[Execution, RejudgedExecution]:
        """Return the results of executions that differ only in their seeds."""
        spec, first = alike[0].spec, alike[0]
        assert spec is not None
        traces = tuple(_trace(place, one.index, one.stored.seed) for one in alike)
        order = JudgeOrder(spec, first.stored.events, traces)
        judged: Mapping[int, list[ClauseJudged]] = self._verdicts(order) if spec.clauses else {}
        known = {clause.line: clause for clause in spec.clauses}
        found: dict[Execution, RejudgedExecution] = {}
        for one in alike:
            clauses = {clause.iri: refused_judgement(clause, why, digests) for clause, why in one.refused}
            for message in judged.get(one.index, ()):
                clause = known.get(message.line)
                if clause is not None:
                    _keep_worst(clauses, clause.iri, judgement(clause, readable(message, spec), digests))
            found[place.number, one.index] = RejudgedExecution("", clauses)
        return found

    def _verdicts(self, order: JudgeOrder) -> Mapping[int, list[ClauseJudged]]:
        self.judge = self.judge or TraceJudge(self.folder)
        try:
            return self.judge.verdicts(order)
        except JudgeEnded:
            self.judge.end()
            self.judge = None
            raise

    def _load(self, edited: Edited, places: Iterable[StoredRun]) -> None:
        """Load the traces of a model that has not been edited yet, so that its first edit is judged at once."""
        for place in places:
            indices = edited.executions[place.number][:LOADED]
            if place.folder in self.loaded or not indices:
                continue
            spec = replace(self._manifest(place).scenarios[indices[0]], clauses=())
            for start in range(0, len(indices), STEP):
                if self.inbox.has_newer(edited.uri):
                    return
                part = indices[start : start + STEP]
                self._verdicts(JudgeOrder(spec, {}, tuple(_trace(place, index) for index in part)))
            self.loaded.add(place.folder)

    def _forget_runs(self, store: Path, used: Container[Path]) -> None:
        """Drop the data about those runs of a store that are no longer shown."""
        for folder in [path.parent for path in self.manifests if path.parent.parent == store]:
            if folder not in used:
                del self.manifests[folder / MANIFEST]
                self.loaded.discard(folder)

    def _manifest(self, place: StoredRun) -> Manifest:
        """Return the manifest of a run. Raises ``NoSuchRun``."""
        path = place.folder / MANIFEST
        try:
            changed = path.stat().st_mtime_ns
        except OSError as error:
            raise NoSuchRun(f"{path} cannot be read: {error.strerror or error}") from error
        known = self.manifests.get(path)
        if known is None or known[0] != changed:
            known = self.manifests[path] = (changed, place.manifest())
        return known[1]


def _alike(executions: Iterable[EditedExecution]) -> Iterator[list[EditedExecution]]:
    """Yield groups of executions that have the same scenario, so that they differ only in repetition and seed."""
    groups: dict[tuple[object, ...], list[EditedExecution]] = {}
    for one in executions:
        if one.spec is not None:
            execution = None if one.spec.execution is None else one.spec.execution.iri
            events = tuple(sorted(one.stored.events.items()))
            groups.setdefault((one.spec.variant, one.spec.variation, execution, events), []).append(one)
    for alike in groups.values():
        for start in range(0, len(alike), STEP):
            yield alike[start : start + STEP]


def _trace(place: StoredRun, index: int, seed: int = 0) -> StoredTrace:
    return StoredTrace(index, str(trace_file(place.folder, index)), seed)


def _keep_worst(clauses: dict[str, Judgement], iri: str, found: Judgement) -> None:
    """Add a verdict. A clause that is repeated within the scenario keeps its worst verdict."""
    known = clauses.get(iri)
    if known is None or found.rank < known.rank:
        clauses[iri] = found


def main() -> None:
    """Answer messages until the input ends."""
    # Users' code is never executed while editing.
    os.environ[NO_USER_CODE] = "1"
    stdout = sys.stdout.buffer
    # Output of libraries must not get between the frames.
    sys.stdout = sys.stderr
    collect_rarely()
    inbox: Inbox[Edited] = Inbox(sys.stdin.buffer)
    with tempfile.TemporaryDirectory(prefix="robbdd-") as folder:
        worker = Worker(inbox, Path(folder))
        try:
            while (edited := inbox.take()) is not None:
                for answer in worker.answers(edited):
                    stdout.write(frame(answer))
                    stdout.flush()
                collect_recent()
        finally:
            if worker.judge is not None:
                worker.judge.end()
