"""Edits are judged in the order of their texts, and every open model is judged again after a run."""

from __future__ import annotations

import asyncio
import pickle
import threading
from collections.abc import Callable, Coroutine
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest

from robbdd_tools.lsp.framing import LENGTH, Edited
from robbdd_tools.lsp.rejudging import Rejudging

MODEL, OTHER = "file:///cell/sorting.bdd", "file:///cell/stacking.bdd"


class Server:
    """As much of the language server as re-judging needs. The first look at a store ends when it is ``ready``."""

    def __init__(self) -> None:
        self.results = [SimpleNamespace(run=1, finished=True, model=model, index=0) for model in (MODEL, OTHER)]
        self.settings = self.stores = self
        self.project = self
        self.sources = SimpleNamespace(texts=dict[str, str])
        self.text = ""
        self.looks = 0
        self.ready = threading.Event()
        self.tasks: list[asyncio.Task[None]] = []

    def rejudges(self, _: str) -> bool:
        return True

    def of(self, _: str) -> Any:
        self.looks += 1
        if self.looks == 1:
            self.ready.wait()
        return SimpleNamespace(folder=Path("runs"))

    def opened(self) -> list[str]:
        return [MODEL, OTHER]

    def texts(self) -> dict[str, tuple[int, str]]:
        return {MODEL: (1, self.text)}

    def importers(self, _: str) -> list[str]:
        return []

    async def analyse(self, work: Callable[[Any], Any], *_: object) -> Any:
        return work(self)

    def spawn(self, work: Coroutine[Any, Any, None]) -> asyncio.Task[None]:
        self.tasks.append(asyncio.create_task(work))
        return self.tasks[-1]


class Process:
    """A process that reads orders and never answers."""

    def __init__(self) -> None:
        self.returncode = None
        self.stdin = self.stdout = self
        self.orders: list[Edited] = []

    def write(self, framed: bytes) -> None:
        self.orders += pickle.loads(framed[LENGTH.size :])

    async def drain(self) -> None:
        pass

    async def readexactly(self, _: int) -> bytes:
        return await asyncio.Event().wait() and b""

    def kill(self) -> None:
        self.returncode = -9


@pytest.fixture
def process(monkeypatch: pytest.MonkeyPatch) -> Process:
    process = Process()

    async def start(*_: object) -> Process:
        return process

    monkeypatch.setattr("robbdd_tools.lsp.rejudging.start_worker", start)
    return process


async def test_an_edit_that_is_ready_later_than_the_next_one_is_not_judged(process: Process) -> None:
    server = Server()
    rejudging = Rejudging(cast("Any", server))
    for number, text in enumerate(("earlier", "later"), 1):
        server.text = text
        rejudging.edited(MODEL)
        while server.looks < number:
            await asyncio.sleep(0.005)
    await server.tasks[1]
    server.ready.set()
    await server.tasks[0]
    assert [order.texts[MODEL] for order in process.orders] == [(1, "later")]
    rejudging.stop()


async def test_after_a_run_every_open_model_is_judged_again(process: Process, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robbdd_tools.lsp.rejudging.FIRST_PAUSE", 0.0)
    server = Server()
    server.ready.set()
    rejudging = Rejudging(cast("Any", server))
    rejudging.results_changed()
    await server.tasks[0]
    assert [order.uri for order in process.orders] == [MODEL, OTHER]
    rejudging.stop()
