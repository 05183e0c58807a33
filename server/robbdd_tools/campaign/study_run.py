"""Execute a study batch by batch. A study that ended early is resumed with the results of an uninterrupted one."""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Self

from robbdd_tools import __version__
from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import load_bytes
from robbdd_tools.base.locks import acquire, is_held
from robbdd_tools.campaign.study_batches import Batch, batches
from robbdd_tools.protocol.messages import ScenarioFinished
from robbdd_tools.run.prepare import FEATURES
from robbdd_tools.run.store import LOCK, NoSuchRun, begin_in, project_root, run_in, shown_path
from robbdd_tools.run.stored_results import FINISHED
from robbdd_tools.run.study_store import NAME, StudyStore
from robbdd_tools.workbench.resuming import resume
from robbdd_tools.workbench.run import Run

if TYPE_CHECKING:
    from robbdd_tools.campaign.stopping import Ruling
    from robbdd_tools.campaign.study_file import Study
    from robbdd_tools.run.run_policy import Policy
    from robbdd_tools.run.store import StoredRun

FOLDER = Path(".robbdd") / "studies"
BATCHES = "batches"
"""Folder of the batch that is executed."""
AGAIN = "start it again with --restart, which removes its results"


class StudyProblem(RobbddError):
    """A study cannot be executed or continued; the message gives the reason."""


@dataclass(frozen=True, slots=True)
class StudyProgress:
    """The progress of a study.

    - ``finished``, ``total``: executions.
    - ``holding``: the finished executions in which all clauses hold.
    - ``rate``: executions per s of wall time since the study was begun or resumed; 0 if unknown.
    """

    finished: int
    total: int
    holding: int
    rate: float = 0.0

    @property
    def left(self) -> float | None:
        """The estimated wall time of the open executions in s; ``None`` if unknown."""
        return (self.total - self.finished) / self.rate if self.rate else None


def study_folder(path: Path, store: Path | None = None) -> Path:
    """Return the folder of a study's results: ``.robbdd/studies/`` in its project, or ``store``."""
    root = project_root(path) / FOLDER if store is None else store
    return root / shown_path(path)


def has_results(folder: Path) -> bool:
    """Return whether a study has been begun."""
    return (folder / NAME).is_file()


def remove_results(folder: Path) -> None:
    """Remove the results of a study. Raises ``StudyProblem`` while it is executed, and ``OSError``."""
    if not folder.exists():
        return
    if is_held(folder / LOCK):
        raise StudyProblem("another process executes this study: wait for it, or end it first")
    for end in ("", "-wal", "-shm"):
        (folder / f"{NAME}{end}").unlink(missing_ok=True)
    shutil.rmtree(folder / BATCHES, ignore_errors=True)


class StudyRun:
    """A study in progress. Use it as a context manager and iterate over ``progress`` once.

    After that, ``ending`` is the reason why executions are open; it is empty for a study that is complete, or that its
    rule has stopped (``ruling``).
    """

    def __init__(self, study: Study, folder: Path, policy: Policy, *, resumed: bool) -> None:
        self._study = study
        self._folder = folder
        self._policy = replace(policy, timeout=study.timeout)
        self._run: Run | None = None
        self._reason = ""
        self.ending = ""
        self.batches = batches(study)
        folder.mkdir(parents=True, exist_ok=True)
        lock = acquire(folder / LOCK)
        if lock is None:
            raise StudyProblem("another process executes this study: `robbdd study status` shows its progress")
        self._lock = lock
        try:
            self.store = StudyStore(folder)
        except BaseException:
            lock.release()
            raise
        try:
            self._check(resumed=resumed)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Close the store. Finished executions are kept."""
        self.store.close()
        self._lock.release()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def total(self) -> int:
        """The number of executions of the whole study."""
        return sum(batch.size for batch in self.batches)

    def ruling(self) -> Ruling | None:
        """Return the decision of the study's rule from all stored executions; ``None`` for no decision or no rule."""
        finished, holding = self._stored()
        return None if self._study.stop is None else self._study.stop.ruling(holding, finished)

    def cancel(self, reason: str) -> None:
        """End the study within half a second. It may be called from any thread or signal handler."""
        self._reason = self._reason or reason
        if self._run is not None:
            self._run.cancel(reason)

    def progress(self) -> Iterator[StudyProgress]:
        """Execute the open batches. Yield the progress after each execution.

        Raises ``StudyProblem``, ``OSError``, ``UserCodeRefused`` and ``NothingSelected``.
        """
        done = self._removed_batches()
        finished, holding = self._stored()
        began, before = monotonic(), finished
        for batch in self.batches:
            if self._decided(batch):
                return
            if batch.number in done:
                continue
            for count in self._execute(batch):
                now = finished + count
                elapsed = monotonic() - began
                yield StudyProgress(now, self.total, holding, (now - before) / elapsed if elapsed > 0 else 0.0)
            if self.ending:
                return
            finished, holding = self._stored()
            yield StudyProgress(finished, self.total, holding, (finished - before) / max(monotonic() - began, 1e-9))

    def _removed_batches(self) -> frozenset[int]:
        """Return the numbers of the stored batches, and remove what is left of their folders."""
        done = self.store.batches()
        for number in done:
            shutil.rmtree(self._place(number).folder, ignore_errors=True)
        return done

    def _begins_stage(self, batch: Batch) -> bool:
        """Return whether a batch is the first one of a later stage than the first."""
        return batch.stage > 1 and self.batches[batch.number - 2].stage != batch.stage

    def _decided(self, batch: Batch) -> bool:
        """Return whether the study stops before a batch, which it does only before the first one of a stage."""
        rule = self._study.stop
        if rule is None or not self._begins_stage(batch):
            return False
        earlier = [one.number for one in self.batches if one.stage < batch.stage]
        counted = [(total, holding) for number, total, holding in self.store.outcomes() if number <= earlier[-1]]
        totals = (sum(column) for column in zip(*counted, strict=True))
        total, holding = totals if counted else (0, 0)
        return rule.ruling(holding, total) is not None

    def _execute(self, batch: Batch) -> Iterator[int]:
        """Execute a batch and store its results. Yield the number of its finished executions after each of them."""
        place = self._place(batch.number)
        if not self._is_finished(place):
            with self._started(batch, place) as run:
                self._run = run
                if self._reason:
                    run.cancel(self._reason)
                self._check_files(batch, place)
                count = sum(one.finished is not None for one in run.progress.scenarios)
                for message in run.messages():
                    if isinstance(message, ScenarioFinished):
                        count += 1
                        yield count
                self._run = None
                self.ending = run.problem or self._reason or run.ending
                if self.ending:
                    return
        self._store(batch, place)

    def _store(self, batch: Batch, place: StoredRun) -> None:
        """Move the results of a finished batch to the study's store."""
        results = place.read_results()
        if results is None or not all(one.finished is not None for one in results.scenarios):
            raise StudyProblem(f"batch {batch.number} has executions without a result")
        self._check_simulator(place)
        self.store.add(batch.number, batch.cell.words, batch.cell.levels, results)
        shutil.rmtree(place.folder, ignore_errors=True)

    def _is_finished(self, place: StoredRun) -> bool:
        """Return whether a batch was executed, but its results were not stored."""
        try:
            return place.began and place.status().state == FINISHED
        except NoSuchRun:
            return False

    def _started(self, batch: Batch, place: StoredRun) -> Run:
        if place.began:
            try:
                known = place.status().total == batch.size
            except NoSuchRun:
                known = False
            if known:
                return resume(place, lambda _: self._policy)
        shutil.rmtree(place.folder, ignore_errors=True)
        return Run.begin(batch.plan(), begin_in(place.folder, kept=False), self._policy, repeat=self._study.repeat)

    def _place(self, number: int) -> StoredRun:
        # A batch is moved to the study's store, so it is neither kept nor does it have traces.
        return run_in(self._folder / BATCHES / str(number), kept=False)

    def _stored(self) -> tuple[int, int]:
        counted = list(self.store.outcomes())
        return sum(total for _, total, _ in counted), sum(holding for _, _, holding in counted)

    def _check(self, *, resumed: bool) -> None:
        digest = self.store.fact("digest")
        if digest is None:
            if resumed:
                raise StudyProblem("the study was never begun: `robbdd study run` begins it")
            facts = {"digest": self._study.digest, "version": __version__}
            self.store.note({**facts, "name": self._study.name, "total": str(self.total)})
        elif not resumed:
            finished, _ = self._stored()
            what = f"has {finished} of {self.total} executions"
            raise StudyProblem(f"the study {what}: continue it with `robbdd study resume`, or {AGAIN}")
        elif digest != self._study.digest:
            raise StudyProblem(f"the study or one of its models was changed since it began: undo that, or {AGAIN}")
        elif self.store.fact("version") != __version__:
            version = self.store.fact("version")
            raise StudyProblem(f"RobBDD {version} began the study, and this is {__version__}: {AGAIN}")

    def _check_files(self, batch: Batch, place: StoredRun) -> None:
        """Refuse a batch that uses other versions of users' files than the earlier batches of its cell."""
        steps = sorted((place.folder / FEATURES / "steps").glob("model*_steps.py"))
        files = dict(place.record().files) | {path.name: hashlib.sha256(load_bytes(path)).hexdigest() for path in steps}
        name = f"files {batch.cell.words}"
        known = self.store.fact(name)
        if known is None:
            self.store.note({name: json.dumps(files, sort_keys=True)})
        elif json.loads(known) != files:
            before: dict[str, str] = json.loads(known)
            differing = sorted(one for one in {*before, *files} if before.get(one) != files.get(one))
            shown = ", ".join(Path(one).name for one in differing)
            raise StudyProblem(f"{shown} changed since the study began: undo that, or {AGAIN}")

    def _check_simulator(self, place: StoredRun) -> None:
        simulator, known = place.status().simulator, self.store.fact("simulator")
        if known is None:
            self.store.note({"simulator": simulator})
        elif known != simulator:
            raise StudyProblem(f"the study began with the simulator {known}, and this is {simulator}: {AGAIN}")


def open_results(folder: Path) -> StudyStore:
    """Open the results of a study. Raises ``StudyProblem`` if there are none, and ``DatabaseProblem``."""
    if not (folder / NAME).is_file():
        raise StudyProblem("the study has no results: `robbdd study run` begins it")
    return StudyStore(folder)


def open_batch(folder: Path) -> tuple[int, bool]:
    """Return the number of finished executions of the batch in progress, and whether a process executes the study."""
    stored: Iterable[Path] = (folder / BATCHES).iterdir() if (folder / BATCHES).is_dir() else ()
    finished = 0
    for path in stored:
        try:
            finished += run_in(path, kept=False).status().finished
        except NoSuchRun:
            continue
    return finished, is_held(folder / LOCK)
