"""Show the progress of a run as work-done progress of the protocol."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from robbdd_tools.lsp.work_done import WorkDone
from robbdd_tools.monitor.verdict import Outcome

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer


class RunProgress:
    """Work-done progress of a run with a ``token``."""

    def __init__(self, server: RobbddServer, token: str) -> None:
        self._progress = WorkDone(server, token)

    async def begin(self) -> None:
        """Ask the client to show the run's progress."""
        await self._progress.begin("RobBDD run", cancellable=True)

    def report(self, ended: Mapping[Outcome, int], total: int) -> None:
        """Report how many scenarios have ended: violated ones count as failed, unknown ones as errored."""
        done = sum(ended.values())
        named = ((ended.get(Outcome.VIOLATED, 0), "failed"), (ended.get(Outcome.UNKNOWN, 0), "errored"))
        words = ", ".join((f"{done}/{total} scenarios", *(f"{count} {name}" for count, name in named if count)))
        self._progress.report(words, done, total)

    def end(self, words: str) -> None:
        """End the progress with a final message."""
        self._progress.end(words)
