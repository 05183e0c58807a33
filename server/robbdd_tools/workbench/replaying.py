"""Simulate a stored run again and compare the traces bit by bit."""

from __future__ import annotations

import json
import shutil
import tempfile
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import load_bytes
from robbdd_tools.base.interpreter import run as run_module
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.base.writing import replace_file
from robbdd_tools.protocol.manifest_file import MANIFEST
from robbdd_tools.protocol.messages import RunStarted
from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.run.prepare import FEATURES
from robbdd_tools.run.results import RunResults, finished_in
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.run.scheduler import CANCELLED, Scheduler
from robbdd_tools.run.user_code import refuse_user_code
from robbdd_tools.workbench.unchanged import model_now, refusal

if TYPE_CHECKING:
    from robbdd_tools.protocol.messages import RunMessage
    from robbdd_tools.protocol.specs import Manifest, ScenarioSpec
    from robbdd_tools.run.store import StoredRun
    from robbdd_tools.workbench.run import Run
    from robbdd_tools.workbench.stored import PastRun

COMPARE = "robbdd_tools.agent.compare_traces"


class CannotReplay(RobbddError):
    """A stored run cannot be replayed; the message gives the reason."""


@dataclass(frozen=True, slots=True)
class ReplayedTrace:
    """The comparison of an execution's trace with its replay. ``difference`` is empty if they are bit-identical."""

    index: int
    name: str
    difference: str


@dataclass(frozen=True, slots=True)
class Replayed:
    """The comparison of a replay's traces with those of its run.

    - ``without_trace``: the names of finished scenarios that could not be replayed, because the run kept no trace of
      them.
    - ``simulator``: the name and the version of the simulator of the replay.
    - ``ending``: why scenarios were left open; empty if all were simulated.
    """

    traces: tuple[ReplayedTrace, ...]
    without_trace: tuple[str, ...]
    simulator: str
    ending: str

    @property
    def is_identical(self) -> bool:
        """Whether all traces of the run are bit-identical to their replays."""
        return not self.ending and not self.without_trace and not any(trace.difference for trace in self.traces)


def replay(
    run: Run | PastRun, *names: str, jobs: int | None = None, timeout: float | None = None, force: bool = False
) -> Replayed:
    """Simulate the finished executions of a run again, and compare their traces bit by bit.

    - ``names``: the local names of the scenarios or variants to replay; without names, all are replayed.
    - ``jobs``: the number of agent processes; by default, the number of cores.
    - ``timeout``: the limit of wall time for one scenario in s; 0 for no limit.
    - ``force``: simulate with the current files, even if they have changed since the run.

    The call blocks until everything is simulated. In an asyncio program, use ``asyncio.to_thread``.

    Raises ``CannotReplay`` if the model or its files have changed or no trace was kept. Raises ``NoSuchRun`` if the run
    is damaged or was not kept. Raises ``UserCodeRefused`` and ``OSError``.
    """
    policy = Policy.of(jobs=jobs, timeout=timeout)
    with tempfile.TemporaryDirectory(prefix="robbdd-") as folder:
        replaying = Replay(run.place, Path(folder), policy, names, force=force)
        for _ in replaying.messages():
            pass
        traces = tuple(replaying.traces())
    return Replayed(traces, tuple(replaying.without_trace), replaying.simulator, replaying.ending)


class Replay:
    """The replay of a stored run. Consume ``messages`` once, then call ``traces``.

    ``folder`` is an empty folder to simulate in. ``names`` selects scenarios or variants; without names, all are
    replayed. If ``force`` is true, the current files are used even if they have changed since the run.
    """

    def __init__(
        self, place: StoredRun, folder: Path, policy: Policy, names: Collection[str] = (), *, force: bool = False
    ) -> None:
        """Prepare a replay. Raises ``CannotReplay``, ``UserCodeRefused``, ``NoSuchRun`` and ``OSError``."""
        if place.record().log:
            raise CannotReplay(f"{place.record().log} is a log: nothing of it can be simulated again")
        reason = "" if force else refusal(place, model_now(place))
        if reason:
            raise CannotReplay(reason)
        self._place = place
        self._folder = folder
        self._manifest: Manifest = place.manifest()
        refuse_user_code(self._manifest, place.folder)
        wanted = _wanted(place, self._manifest, names)
        self._indices = [index for index in wanted if trace_file(place.folder, index).is_file()]
        self.without_trace = [self._manifest.scenarios[i].name for i in wanted if i not in self._indices]
        """Names of finished scenarios whose trace was not kept."""
        if not self._indices:
            scenarios = " or ".join(names) or "any scenario"
            raise CannotReplay(f"run {place.number or place.folder} keeps no trace of {scenarios}")
        _copy(place.folder / MANIFEST, folder / MANIFEST)
        shutil.copytree(place.folder / FEATURES, folder / FEATURES, ignore=_links, copy_function=_copy)
        self.progress = RunResults(self._manifest)
        self.simulator = ""
        """Name and version of the simulator of the replay."""
        self.ending = ""
        """Why scenarios were left open; empty when all were simulated."""
        self._reason = ""
        self._scheduler = Scheduler(folder, self._manifest, policy, indices=self._indices)

    @property
    def total(self) -> int:
        """The number of executions to simulate again."""
        return len(self._indices)

    def cancel(self, reason: str = CANCELLED) -> None:
        """End the replay. This may be called from any thread."""
        self._reason = self._reason or reason
        self._scheduler.cancel()

    def messages(self) -> Iterator[RunMessage]:
        """Yield the messages of the simulation in the order of the manifest. Raises ``OSError``."""
        for message in self._scheduler.messages():
            if isinstance(message, RunStarted):
                self.simulator = message.simulator
            self.progress.apply(message)
            yield message
        self.ending = self._reason or self._scheduler.ending

    def traces(self) -> list[ReplayedTrace]:
        """Compare the traces. Raises ``CannotReplay`` if they cannot be read."""
        done = run_module(COMPARE, str(self._place.folder.absolute()), str(self._folder.absolute()))
        if done.returncode:
            raise CannotReplay(f"the traces cannot be compared: {(done.stderr.strip().splitlines() or [''])[-1]}")
        found = {entry["index"]: entry["difference"] for entry in map(json.loads, done.stdout.splitlines())}
        missing = "it could not be simulated again"
        return [
            ReplayedTrace(index, self._manifest.scenarios[index].name, found.get(index, missing))
            for index in self._indices
        ]


def _wanted(place: StoredRun, manifest: Manifest, names: Collection[str]) -> list[int]:
    finished = finished_in(place.results())
    return [
        index
        for index, spec in enumerate(manifest.scenarios)
        if index in finished and (not names or not _names(spec).isdisjoint(names))
    ]


def _names(spec: ScenarioSpec) -> set[str]:
    return {spec.name, _local(spec.name), _local(spec.variant)}


def _local(name: str) -> str:
    return name.replace("#", "/").rpartition("/")[2].rpartition(":")[2]


def _copy(source: str | Path, target: str | Path) -> None:
    replace_file(Path(target), load_bytes(Path(source), RESULT_SIZE))


def _links(folder: str, names: list[str]) -> list[str]:
    """Return the symbolic links in a folder. They are skipped, because no run folder written by RobBDD contains one."""
    return [name for name in names if (Path(folder) / name).is_symlink()]
