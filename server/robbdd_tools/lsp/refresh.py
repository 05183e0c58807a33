"""Ask the client to refresh diagnostics, tokens, hints and lenses after other files or results have changed."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import TYPE_CHECKING

from lsprotocol import types

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer

GATHERING = 0.03
"""Refreshes that are requested within this time (s) are combined."""
SETTLING = 0.3
"""Other files are refreshed within this time (s) after an edit."""
DIAGNOSTICS, COLOURS, HINTS, LENSES = "diagnostics", "semantic_tokens", "inlay_hint", "code_lens"


def is_refreshed(capabilities: types.ClientCapabilities, what: str) -> bool:
    """Return whether a client supports refresh requests of a kind."""
    abilities = getattr(capabilities.workspace, what, None)
    return bool(abilities is not None and abilities.refresh_support)


class Refreshes:
    """Sends one refresh of each kind, however often it is requested.

    Kinds that the client does not support are skipped.
    """

    def __init__(self, server: RobbddServer) -> None:
        self._server = server
        self._wanted: dict[str, None] = {}
        self._sending: asyncio.TimerHandle | None = None

    def want(self, *what: str, after: float = GATHERING) -> None:
        """Request refreshes of the given kinds. They are sent within ``after`` seconds."""
        self._wanted |= dict.fromkeys(what)
        loop = asyncio.get_running_loop()
        if self._sending is not None:
            after = min(after, self._sending.when() - loop.time())
            self._sending.cancel()
        self._sending = loop.call_later(after, self._send)

    def _send(self) -> None:
        wanted, self._wanted, self._sending = self._wanted, {}, None
        ask: dict[str, Callable[[None], object]] = {
            DIAGNOSTICS: self._server.workspace_diagnostic_refresh,
            COLOURS: self._server.workspace_semantic_tokens_refresh,
            HINTS: self._server.workspace_inlay_hint_refresh,
            LENSES: self._server.workspace_code_lens_refresh,
        }
        for what in wanted:
            if is_refreshed(self._server.client_capabilities, what):
                ask[what](None)
