"""Show the progress of a run as work-done progress of the protocol."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from robbdd_tools.monitor.verdict import Outcome

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer


class RunProgress:
    """Work-done progress with a ``token``. Nothing is sent to a client that does not support it or refuses it."""

    def __init__(self, server: RobbddServer, token: str) -> None:
        self._progress = server.work_done_progress
        self._token = token
        window = server.client_capabilities.window
        self._is_shown = bool(window is not None and window.work_done_progress)

    async def begin(self) -> None:
        """Ask the client to show the run's progress."""
        if not self._is_shown:
            return
        try:
            # pygls does not declare the type of the client's (empty) answer.
            await self._progress.create_async(self._token)  # pyright: ignore[reportUnknownMemberType]
        except JsonRpcException:
            self._is_shown = False
            return
        begin = types.WorkDoneProgressBegin(title="RobBDD run", cancellable=True, percentage=0)
        self._progress.begin(self._token, begin)

    def report(self, ended: Mapping[Outcome, int], total: int) -> None:
        """Report how many scenarios have ended; violated ones have failed, unknown ones have errored."""
        if self._is_shown:
            done = sum(ended.values())
            named = ((ended.get(Outcome.VIOLATED, 0), "failed"), (ended.get(Outcome.UNKNOWN, 0), "errored"))
            words = ", ".join((f"{done}/{total} scenarios", *(f"{count} {name}" for count, name in named if count)))
            self._progress.report(
                self._token, types.WorkDoneProgressReport(message=words, percentage=100 * done // total)
            )

    def end(self, words: str) -> None:
        """End the progress with a final message."""
        if self._is_shown:
            self._progress.end(self._token, types.WorkDoneProgressEnd(message=words))
        # pygls keeps tokens forever, and does not declare the type of their values.
        self._progress.tokens.pop(self._token, None)  # pyright: ignore[reportUnknownMemberType]
