"""Work-done progress of the protocol."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from lsprotocol import types
from pygls.exceptions import JsonRpcException

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer


class WorkDone:
    """Work-done progress with a ``token``. Nothing is sent to a client that does not support it or refuses it."""

    def __init__(self, server: RobbddServer, token: str) -> None:
        self._progress = server.work_done_progress
        self._untyped: Any = self._progress
        """``_progress`` without a type, for calls in which pygls leaves an answer or a value untyped."""
        self._token = token
        window = server.client_capabilities.window
        self._is_supported = bool(window is not None and window.work_done_progress)
        self._is_shown = False

    async def begin(self, title: str, *, cancellable: bool = False) -> None:
        """Ask the client to show the progress, unless it already does or has refused to."""
        if not self._is_supported or self._is_shown:
            return
        try:
            await self._untyped.create_async(self._token)
        except JsonRpcException:
            self._is_supported = False
            return
        self._is_shown = True
        begin = types.WorkDoneProgressBegin(title=title, cancellable=cancellable or None, percentage=0)
        self._progress.begin(self._token, begin)

    def report(self, words: str, done: int, total: int) -> None:
        """Report how much is done."""
        if self._is_shown:
            report = types.WorkDoneProgressReport(message=words, percentage=100 * done // total)
            self._progress.report(self._token, report)

    def end(self, words: str) -> None:
        """End the progress with a final message."""
        if self._is_shown:
            self._progress.end(self._token, types.WorkDoneProgressEnd(message=words))
        # pygls keeps tokens forever.
        self._untyped.tokens.pop(self._token, None)
