"""``python study_agents.py COMMAND…``: the command line with agents that are threads and need no time.

The verdicts and margins of an execution follow from its seed, so that a wrong seed shows in the results.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from queue import SimpleQueue
from unittest.mock import patch

from kit import MODEL, SCENE
from robbdd_tools.cli import main
from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.protocol.messages import ClauseJudged, RunMessage, RunStarted, ScenarioFinished, ScenarioStarted
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.run import scheduler

STUDY = """import "m.bdd"
Study fetching {
    repeat: 10
    batch: 8
    seed: 3
}
"""
"""Four scenarios, ten times each, in batches of 8 executions."""


def write_study(folder: Path, text: str = STUDY, model: str = MODEL) -> Path:
    """Write a study and its models, and return its path."""
    folder.mkdir(exist_ok=True)
    files: Mapping[str, str] = {"lab.scene": SCENE, "m.bdd": model, "x.study": text, "robbdd.toml": ""}
    for name, content in files.items():
        (folder / name).write_text(content, encoding="utf-8")
    return folder / "x.study"


def margin(spec: ScenarioSpec) -> float:
    """Return the margin of all clauses: from -0.2 m to 0.8 m."""
    return (spec.seed % 1000) / 1000 - 0.2


class QuickAgent:
    """Behaves as ``run.launch.Agent``. It notes each execution that it begins in the file ``ROBBDD_BEGUN``."""

    simulator = "none"

    def __init__(
        self, folder: Path, number: int, *, log_limit: int, timeout: float, debug: int | None, pausing: bool
    ) -> None:
        del log_limit, timeout, debug, pausing
        self.pid = number
        self._specs = read_manifest(folder).scenarios
        self._orders: SimpleQueue[int | None] = SimpleQueue()

    def execute(self, index: int) -> None:
        self._orders.put(index)

    def messages(self) -> Iterator[RunMessage]:
        yield RunStarted(len(self._specs), self.simulator)
        while (index := self._orders.get()) is not None:
            yield from self.executed(index, self._specs[index])

    def executed(self, index: int, spec: ScenarioSpec) -> Iterator[RunMessage]:
        begun = os.environ.get("ROBBDD_BEGUN")
        if begun:
            with Path(begun).open("a", encoding="utf-8") as file:
                file.write(f"{spec.seed}\n")
        found = margin(spec)
        outcome = "holds" if found > 0 else "violated"
        yield ScenarioStarted(index)
        for clause in spec.clauses:
            yield ClauseJudged(index, clause.line, outcome, found, "m", 1.0, "" if found > 0 else "it moved")
        yield ScenarioFinished(index, 1.0, 0.0, 0.0)

    def terminate(self) -> None:
        self._orders.put(None)

    def wait(self, seconds: float) -> None:
        """Threads end by themselves."""

    def kill(self) -> None:
        """Threads end by themselves."""

    def finish(self) -> None:
        """A thread leaves no child process."""


if __name__ == "__main__":
    with patch.object(scheduler, "Agent", QuickAgent):
        code = main(sys.argv[1:])
    sys.stdout.flush()
    os._exit(code)
