"""``python killed.py FOLDER``: start a run, or resume an existing one, to be killed at any instant.

Everything is as in ``robbdd run``, but the agents are threads that need no time. Each execution that they begin is a
line of the file ``begun``.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from queue import SimpleQueue
from unittest.mock import patch

from kit import write_manifest
from robbdd_tools.base.locks import acquire
from robbdd_tools.commands.execute import follow_run
from robbdd_tools.protocol.messages import RunMessage, RunStarted
from robbdd_tools.protocol.specs import Manifest
from robbdd_tools.run import scheduler
from robbdd_tools.run.recording import Recording, pending
from robbdd_tools.run.results import RunResults
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.run.store import FOLDER, LOCK, RunStore
from robbdd_tools.workbench.run import Run
from run.recorded import RECORD, execution, spec

COUNT, JOBS = 60, 3
MANIFEST = Manifest("m.bdd", 1, tuple(map(spec, range(COUNT))))
BEGUN = "begun"


class QuickAgent:
    """Behaves as ``run.launch.Agent``."""

    def __init__(
        self, folder: Path, number: int, *, log_limit: int, timeout: float, debug: int | None, pausing: bool
    ) -> None:
        del log_limit, timeout, debug, pausing
        self.pid = number
        self._begun = folder.parents[2] / BEGUN
        self._orders: SimpleQueue[int | None] = SimpleQueue()

    def execute(self, index: int) -> None:
        self._orders.put(index)

    def messages(self) -> Iterator[RunMessage]:
        yield RunStarted(COUNT, "none")
        while (index := self._orders.get()) is not None:
            with self._begun.open("a", encoding="utf-8") as file:
                file.write(f"{index}\n")
            yield from execution(index, "violated" if index % 7 == 3 else "holds")

    def terminate(self) -> None:
        self._orders.put(None)

    def wait(self, seconds: float) -> None:
        """Threads end by themselves."""

    def kill(self) -> None:
        """Threads end by themselves."""

    def finish(self) -> None:
        """A thread leaves no child process."""


def main(folder: Path) -> None:
    store, policy = RunStore(folder / FOLDER), Policy(JOBS)
    unfinished = [run for run in store.runs() if run.began and not run.status().is_whole]
    place = unfinished[0] if unfinished else store.begin()
    if place.lock is None:
        place = replace(place, lock=acquire(place.folder / LOCK, 5.0))
        assert place.lock is not None
    else:
        write_manifest(place.folder, MANIFEST)
    with closing(Recording(place, MANIFEST)) as recording:
        if unfinished:
            results = recording.resume(policy)
        else:
            results = RunResults(MANIFEST)
            recording.begin(RECORD, policy)
            place.write_record(RECORD)
        follow_run(Run(place, policy, recording, results, pending(results, stops=False)), every_clause=True)


if __name__ == "__main__":
    with patch.object(scheduler, "Agent", QuickAgent):
        main(Path(sys.argv[1]))
    os._exit(0)
