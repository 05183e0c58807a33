"""Execute a study on a cluster: send parts of about 30 s of work, and collect their results in the one store."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from time import monotonic
from typing import TYPE_CHECKING

from robbdd_tools.base.writing import replace_file
from robbdd_tools.campaign.study_place import StudyProblem
from robbdd_tools.campaign.study_progress import StudyProgress, Tally, WorkerState
from robbdd_tools.campaign.study_run import StudyRun
from robbdd_tools.protocol.messages import decode
from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.run.parcels import Parcel, pack_prepared, pack_used
from robbdd_tools.run.recording import OtherSimulator
from robbdd_tools.run.tasks import grouped
from robbdd_tools.syntax.study_content import ALL, FAILURES
from robbdd_tools.workbench.deciding_versions import versions
from robbdd_tools.workbench.parts import Part, PartResult

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from robbdd_tools.campaign.cluster import Cluster
    from robbdd_tools.campaign.study_batches import Batch
    from robbdd_tools.campaign.study_file import Study
    from robbdd_tools.protocol.messages import RunMessage
    from robbdd_tools.run.run_policy import Policy
    from robbdd_tools.workbench.run import Run

WORK = 30.0
"""Wall time (s) that a part is sized for. Starting an agent takes 0.6 s of it."""
LEAST_WORK = 10.0
"""Minimum wall time (s) of a part at the end of a study. Small parts let all workers end at about the same time."""
FIRST = 4
"""Number of executions of each part that is sent before the first result."""
AHEAD = 2
"""Parts in flight for each thread of a worker: the worker executes one, and another one waits there."""


NOTHING = Parcel("", b"")


@dataclass(slots=True)
class _OpenBatch:
    """A batch that is not yet in the study's store.

    - ``run``: its run; ``None`` if all its executions are finished.
    - ``used``, ``prepared``: the files that its parts need.
    - ``tasks``: the tasks that were not sent yet; the scenarios of one task stay together.
    - ``expected``: the number of its parts in flight.
    """

    batch: Batch
    run: Run | None = None
    used: Parcel = NOTHING
    prepared: Parcel = NOTHING
    tasks: deque[tuple[int, ...]] = field(default_factory=deque[tuple[int, ...]])
    expected: int = 0

    def send(self, size: int) -> tuple[int, ...]:
        """Return about ``size`` scenarios to be sent now."""
        indices: list[int] = []
        while self.tasks and (not indices or len(indices) + len(self.tasks[0]) <= size):
            indices += self.tasks.popleft()
        self.expected += 1
        return tuple(sorted(indices))


@dataclass(slots=True)
class Pace:
    """The wall time of executions on workers, over the last parts."""

    seconds: float = 0.0
    executions: float = field(default=0.0)

    def add(self, seconds: float, executions: int) -> None:
        """Add a finished part. Each added part halves the weight of all earlier ones."""
        self.seconds = self.seconds / 2 + seconds
        self.executions = self.executions / 2 + executions

    def size(self, unsent: int, threads: int) -> int:
        """Return the number of executions of the next part."""
        if not self.executions:
            return FIRST
        each = max(self.seconds / self.executions, 1e-6)
        fair = unsent / max(1, AHEAD * threads)
        return max(1, round(min(WORK / each, max(LEAST_WORK / each, fair))))


class ClusterStudyRun(StudyRun):
    """A study that the workers of a cluster execute. Its results equal those of an execution on this machine."""

    def __init__(
        self,
        study: Study,
        folder: Path,
        policy: Policy,
        *,
        resumed: bool,
        cluster: Cluster,
        sent: Sequence[Path] = (),
    ) -> None:
        super().__init__(study, folder, policy, resumed=resumed)
        self._cluster = cluster
        self._more = sent
        self._pace = Pace()
        self._opened: deque[_OpenBatch] = deque()
        self._waiting: deque[Batch] = deque()
        self._unsent = 0

    def cancel(self, reason: str) -> None:
        """End the study. Workers end the parts in flight within seconds."""
        super().cancel(reason)
        self._cluster.cancel()

    def workers(self) -> list[WorkerState]:
        """Return how many executions each worker has."""
        return [WorkerState(one, f"{number:,} executions", None) for one, number in self._cluster.work().items()]

    def progress(self) -> Iterator[StudyProgress]:
        """Execute the open batches. Yield the progress after each part.

        Raises ``StudyProblem``, ``ClusterProblem``, ``OSError``, ``UserCodeRefused`` and ``NothingSelected``.
        """
        done = self._removed_batches()
        self._waiting = deque(batch for batch in self.batches if batch.number not in done)
        self._unsent = sum(batch.size for batch in self._waiting)
        self.tally = Tally.of(self.store)
        began, made = monotonic(), 0
        try:
            while (self._waiting or self._opened) and not self._cluster.is_cancelled and not self.ending:
                self._fill()
                if self._draining and not self._cluster.in_flight:
                    break
                for part, result in self._cluster.results():
                    self._take(part, result)
                    made += len(part.indices)
                    yield StudyProgress(self.total, self.tally, made / max(monotonic() - began, 1e-9), made)
                if not self.ending:
                    self._store_complete()
        except BaseException as error:
            self.ending = self.ending or self._reason or str(error) or "the study was interrupted"
            raise
        finally:
            is_open = bool(self._waiting or self._opened)
            self.ending = self.ending or self._reason or (self._draining if is_open else "")
            for one in self._opened:
                self._close(one)

    def _fill(self) -> None:
        """Send parts until enough are in flight."""
        while not self._draining and self._cluster.in_flight < AHEAD * self._cluster.threads:
            current = next((one for one in self._opened if one.tasks), None) or self._next_batch()
            if current is None or current.run is None:
                return
            indices = current.send(self._pace.size(self._unsent, self._cluster.threads))
            self._unsent -= len(indices)
            origin = str(current.run.folder.absolute())
            wanted = self._study.content.traces
            traces = "" if wanted is None else FAILURES if wanted.failures else ALL
            part = Part(current.batch.number, indices, origin, versions(), self._policy.timeout, traces)
            self._cluster.send(part, current.used, current.prepared)

    def _next_batch(self) -> _OpenBatch | None:
        """Prepare the next batch with open executions. Return ``None`` if there is none now."""
        while self._waiting:
            # A rule decides on all results of the earlier stages.
            if self._study.stop is not None and self._opened and self._begins_stage(self._waiting[0]):
                return None
            if self._decided(self._waiting[0]):
                self._waiting.clear()
                return None
            opened = self._open(self._waiting.popleft())
            self._opened.append(opened)
            if opened.tasks:
                return opened
        return None

    def _open(self, batch: Batch) -> _OpenBatch:
        place = self._place(batch.number)
        if self._is_finished(place):
            self._unsent -= batch.size
            results = place.read_results()
            self.tally.add_finished([] if results is None else results.scenarios)
            return _OpenBatch(batch)
        run = self._started(batch, place)
        try:
            self._check_files(batch, place)
            used, prepared = pack_used(run.manifest, run.folder, self._more), pack_prepared(run.folder)
        except BaseException:
            run.close()
            raise
        self.tally.add_finished(run.progress.scenarios)
        self._unsent -= batch.size - len(run.open_indices)
        return _OpenBatch(batch, run, used, prepared, deque(grouped(run.manifest, run.open_indices)))

    def _take(self, part: Part, result: PartResult) -> None:
        if result.refused:
            raise StudyProblem(f"the worker on {result.host} {result.refused}")
        opened = next(one for one in self._opened if one.batch.number == part.batch)
        assert opened.run is not None
        opened.expected -= 1
        for index, content in result.traces.items():
            trace = trace_file(opened.run.folder, index)
            trace.parent.mkdir(exist_ok=True)
            replace_file(trace, content)
        try:
            opened.run.receive(self._received(result.lines), result.host)
        except OtherSimulator as error:
            self.ending = str(error)
            return
        received = (opened.run.progress.scenarios[index] for index in part.indices)
        self.tally.add_finished(received)
        if result.ending:
            self.ending = f"on {result.host}, {result.ending}"
            return
        self._pace.add(result.seconds, len(part.indices))

    def _received(self, lines: Iterable[str]) -> Iterator[RunMessage]:
        """Yield the messages of a part, and pass on its warnings."""
        for message in map(decode, lines):
            self._warn(message)
            yield message

    def _store_complete(self) -> None:
        """Close complete batches, and move them to the study's store in the order of the study."""
        for one in self._opened:
            if one.run is not None and not one.tasks and not one.expected:
                self._close(one)
        while self._opened and self._opened[0].run is None:
            one = self._opened.popleft()
            self._store(one.batch, self._place(one.batch.number))

    def _close(self, one: _OpenBatch) -> None:
        if one.run is None:
            return
        with one.run as run:
            if self.ending:
                run.cancel(self.ending)
            run.conclude(self.ending)
        one.run = None
