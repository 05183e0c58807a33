"""The language server with faults planted in it, and with eyes: what tests of its manners start.

Words in a text plant the faults: ``planted fault`` breaks hover and preview, all else keeps working; ``planted
defect`` breaks the diagnostics; ``endless`` makes the semantic tokens of a text a work without end. Between
``test/hold`` and ``test/goOn`` no file is read that imports another.
"""

from __future__ import annotations

import asyncio
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

from robbdd_tools.base.checkpoint import Abandoned, checkpoint
from robbdd_tools.gherkin import preview
from robbdd_tools.lsp import assistance, handlers, main, server, tokens
from robbdd_tools.lsp.convert import document_of
from robbdd_tools.lsp.importers import Importers
from robbdd_tools.names.project import Snapshot

BLOCKED = 0.05
"""Processor seconds from which one callback counts as blocking the event loop."""
LOG = Path(tempfile.mkdtemp(prefix="robbdd-test-")) / "server.log"


class State:
    """Parameters of a test's request."""

    def __init__(self) -> None:
        self.begun = 0
        self.left = 0
        self.blocked: list[str] = []
        self.go_on = asyncio.Event()
        self.go_on.set()


STATE = State()


def breaking(function: Callable[..., Any], word: str) -> Callable[..., Any]:
    def broken(snapshot: Snapshot, uri: str, *more: Any, **named: Any) -> Any:
        if word in document_of(snapshot, uri).text:
            raise RuntimeError(f"{word} in {function.__name__}")
        return function(snapshot, uri, *more, **named)

    return broken


def endless(function: Callable[..., Any]) -> Callable[..., Any]:
    def never(snapshot: Snapshot, uri: str, *more: Any) -> Any:
        if "endless" not in document_of(snapshot, uri).text:
            return function(snapshot, uri, *more)
        STATE.begun += 1
        try:
            while True:
                time.sleep(0.001)
                checkpoint()
        except Abandoned:
            STATE.left += 1
            raise

    return never


def holding(load: Callable[..., Any]) -> Callable[..., Any]:
    async def held(self: Any, uris: Any) -> bool:
        await STATE.go_on.wait()
        return await load(self, uris)

    return held


def plant(module: ModuleType | type, name: str, change: Callable[..., Any], *more: str) -> None:
    """Change a function where the server has imported it."""
    setattr(module, name, change(getattr(module, name), *more))


def watch_the_loop() -> None:
    """Note each callback of the event loop that computes for too long; waiting for the processor does not count."""
    # asyncio has no public place around its callbacks.
    run = asyncio.Handle._run  # pyright: ignore[reportPrivateUsage]

    def watched(self: asyncio.Handle) -> Any:
        start = time.thread_time()
        result = run(self)
        used = time.thread_time() - start
        if used > BLOCKED and threading.current_thread() is threading.main_thread():
            STATE.blocked.append(f"{used:.3f} s in {self!r}")
        return result

    asyncio.Handle._run = watched  # pyright: ignore[reportPrivateUsage]


def start() -> int:
    plant(assistance, "hover", breaking, "planted fault")
    plant(preview, "preview", breaking, "planted fault")
    plant(server, "fast_diagnostics", breaking, "planted defect")
    plant(tokens, "coloured", endless)
    plant(Importers, "load", holding)
    watch_the_loop()
    create = handlers.create_server

    def create_with_eyes() -> Any:
        made = create()

        @made.feature("test/state")
        def state(_: Any) -> dict[str, Any]:
            blocked, STATE.blocked = STATE.blocked, []
            return {"log": str(LOG), "begun": STATE.begun, "left": STATE.left, "blocked": blocked}

        @made.feature("test/hold")
        def hold(_: Any) -> None:
            STATE.go_on.clear()

        @made.feature("test/goOn")
        def go_on(_: Any) -> None:
            STATE.go_on.set()

        @made.feature("test/block")
        def block(_: Any) -> None:
            until = time.thread_time() + 2 * BLOCKED
            while time.thread_time() < until:
                pass

        return made

    handlers.create_server = create_with_eyes
    return main.main(["--stdio", "--log-file", str(LOG)])


if __name__ == "__main__":
    sys.exit(start())
