"""Memory depends on the project, not on the number of keystrokes: temporary data is freed, and caches stay small."""

from __future__ import annotations

import asyncio
import gc
import io
import sys
import threading
import tracemalloc
import weakref
from collections.abc import Generator, Iterator
from contextlib import suppress
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import psutil
import pytest

from kit import MODEL, SCENE
from robbdd_tools.base.checkpoint import Abandoned
from robbdd_tools.base.memory import OLD, collect_recent
from robbdd_tools.features import run_verdicts as results
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.semantic_tokens import semantic_tokens
from robbdd_tools.graph.shapes.project_shapes import EditorShapes
from robbdd_tools.lsp import worker
from robbdd_tools.lsp.analysis_thread import AnalysisThread
from robbdd_tools.lsp.background import Background
from robbdd_tools.lsp.framing import Request, frame
from robbdd_tools.lsp.handlers import create_server
from robbdd_tools.lsp.requests import Requests
from robbdd_tools.names.project import Project
from robbdd_tools.run.launch import Agent, stop
from robbdd_tools.syntax.declaration import Declaration
from robbdd_tools.syntax.parse import forget_declarations


class Cycle:
    """What only a search for cycles frees, as every rdflib graph."""

    def __init__(self) -> None:
        self.me: Cycle | None = self


@pytest.fixture
def no_searches() -> Iterator[None]:
    """Python searches for no cycles by itself."""
    thresholds = gc.get_threshold()
    gc.collect()
    gc.disable()
    yield
    gc.set_threshold(*thresholds)
    gc.enable()


@pytest.mark.usefixtures("no_searches")
def test_background_work_leaves_no_graph_behind() -> None:
    background = Background()
    left = asyncio.run(background.work({}, lambda _: weakref.ref(Cycle())))
    background.stop()
    assert left() is None


@pytest.mark.usefixtures("no_searches")
def test_what_outlives_several_searches_is_freed_in_the_end() -> None:
    cycle = Cycle()
    left = weakref.ref(cycle)
    for _ in range(3):
        collect_recent()
    del cycle
    collect_recent()
    assert left() is not None
    for _ in range(OLD):
        collect_recent()
    assert left() is None


@pytest.mark.usefixtures("no_searches")
def test_a_validation_leaves_no_graph_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    left: list[weakref.ref[Cycle]] = []
    begun = threading.Event()

    def validate(*_: object) -> list[object]:
        left.append(weakref.ref(Cycle()))
        begun.set()
        return []

    uri = "file:///m/lab.scene"
    requests = (Request(1, uri, {uri: (1, SCENE)}, EditorShapes()),)
    monkeypatch.setattr(worker, "shape_diagnostics", validate)
    # The answer stays unread; the input stays open until the cycle is made, else the worker ends before it begins.
    monkeypatch.setattr(sys, "stdin", SimpleNamespace(buffer=Stream(frame(requests), begun)))
    monkeypatch.setattr(sys, "stdout", SimpleNamespace(buffer=io.BytesIO()))
    worker.main()
    assert [reference() for reference in left] == [None]


class Stream(io.BytesIO):
    """Ends when a validation has begun."""

    def __init__(self, data: bytes, begun: threading.Event) -> None:
        super().__init__(data)
        self._begun = begun

    def read(self, size: int | None = -1, /) -> bytes:
        found = super().read(size)
        if not found:
            self._begun.wait()
        return found


def test_declarations_of_the_past_live_in_the_bounded_cache_only() -> None:
    project, uri = Project(), "file:///m/main.bdd"
    project.open("file:///m/lab.scene", 1, SCENE)
    for version in range(100):
        project.open(uri, version, MODEL.replace("in-tray", f"in-tray-{version}"))
        semantic_tokens(project.snapshot(), uri)
        fast_diagnostics(project.snapshot(), uri)
    forget_declarations()
    gc.collect()
    alive = (entry for entry in gc.get_objects() if isinstance(entry, Declaration))
    assert sum("in-tray-" in declaration.text for declaration in alive) < 20


@pytest.mark.usefixtures("no_searches")
async def test_work_that_is_abandoned_or_fails_leaves_nothing_behind() -> None:
    thread = AnalysisThread()
    try:
        assert (await _after_error(thread, Abandoned))() is None
        assert (await _after_error(thread, ValueError))() is None
    finally:
        thread.stop()


async def _after_error(thread: AnalysisThread, kind: type[Exception]) -> weakref.ref[Any]:
    """Raise an error in the analysis thread; return a reference to what the work used."""
    used = Cycle()
    used.me = None
    left = weakref.ref(used)

    def work(error: type[Exception], _: object) -> None:
        raise error

    doing = partial(work, kind, used)
    del used
    with suppress(Abandoned, ValueError):
        await thread.do(doing)
    del doing
    # The thread keeps its last job until it gets another one.
    await thread.do(lambda: None)
    return left


@pytest.mark.usefixtures("no_searches")
async def test_a_request_that_is_cancelled_leaves_no_task_behind() -> None:
    requests = Requests()

    async def handler() -> None:
        await asyncio.Event().wait()

    task = asyncio.create_task(requests.with_logged_errors("robbdd/test", handler)())
    left = weakref.ref(task)
    await asyncio.sleep(0)
    task.cancel()
    with suppress(asyncio.CancelledError):
        await task
    del task
    await asyncio.sleep(0)
    assert left() is None


def private(owner: object) -> Any:
    """Return an object whose private parts a test has to use.

    pygls shows its handlers and futures in no other way, and the cache of digests has no public function for a text.
    """
    return owner


def ignore(_: object) -> None:
    """Take the answer of a handler that nobody waits for."""


async def test_a_handler_that_is_done_leaves_no_future_behind() -> None:
    server = create_server()
    done = asyncio.Event()

    async def handle(*_: object) -> None:
        done.set()

    private(server.protocol)._execute_handler("edit", handle, ignore)
    await done.wait()
    await asyncio.sleep(0)
    await asyncio.sleep(0)
    assert not private(server.protocol)._request_futures
    server.stop()


async def test_handlers_that_go_on_are_ended_by_a_shutdown() -> None:
    server = create_server()
    protocol = private(server.protocol)

    async def wait(*_: object) -> None:
        await asyncio.Event().wait()

    def edit(*_: object) -> Generator[Any, Any, None]:
        yield wait, (), {}

    for number in range(3):
        protocol._execute_handler(f"edit {number}", edit, ignore)
    # As pygls does it, step by step.
    for _ in protocol.lsp_shutdown():
        pass
    for _ in range(4):
        await asyncio.sleep(0)
    assert not protocol._request_futures


def test_digests_do_not_keep_the_texts_that_they_were_made_of() -> None:
    tracemalloc.start()
    for number in range(300):
        private(results)._digest(f"{number} " + "long " * 2000)
    used, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert used < 1_000_000


@pytest.mark.skipif(not psutil.POSIX, reason="Windows does not count file descriptors")
def test_an_agent_that_has_ended_holds_no_descriptors(tmp_path: Path) -> None:
    process = psutil.Process()
    before = process.num_fds()
    agent = Agent(tmp_path, module="robbdd_tools.cli", arguments=["--version"])
    for _ in agent.messages():
        pass
    stop([agent])
    assert process.num_fds() == before
    agent.execute(1)
