"""The survey of files that are not open, with a process whose answers the test gives."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from pathlib import Path
from typing import Any, cast

import pytest

from robbdd_tools.base.files import path_to_uri
from robbdd_tools.graph.shapes.project_shapes import EditorShapes
from robbdd_tools.lsp import workspace_diagnostics as survey
from robbdd_tools.lsp.convert import Converter
from robbdd_tools.lsp.framing import Answer, Request
from robbdd_tools.lsp.server import RobbddServer
from robbdd_tools.lsp.workspace_diagnostics import WorkspaceDiagnostics
from robbdd_tools.names.project import Project

PATIENCE = 10.0


class _Process:
    """What is asked waits in ``asked`` until the test answers it."""

    def __init__(self) -> None:
        self.asked: asyncio.Queue[Request] = asyncio.Queue()
        self._deliver: Callable[[Answer], None] | None = None

    def begin(self, deliver: Callable[[Answer], None], in_passing: bool) -> _Process:
        assert in_passing
        self._deliver = deliver
        return self

    def request(self, request: Request) -> None:
        self.asked.put_nowait(request)

    async def next(self) -> Request:
        async with asyncio.timeout(PATIENCE):
            return await self.asked.get()

    def answer(self, request: Request) -> None:
        assert self._deliver is not None
        self._deliver(Answer(request.revision, request.uri, (), reached=frozenset({request.uri})))


class _Server:
    """What a survey asks of its server; it is its own workspace."""

    pulls = True
    convert = Converter()
    project = Project()

    def __init__(self, folder: Path) -> None:
        self.workspace = self
        self.folders = [path_to_uri(folder)]
        self._tasks: list[asyncio.Task[None]] = []

    def is_open(self, _: str) -> bool:
        return False

    def spawn(self, work: Coroutine[Any, Any, None]) -> None:
        self._tasks.append(asyncio.get_running_loop().create_task(work))

    async def survey_request(self, uri: str) -> Request:
        return Request(len(self._tasks), uri, {}, EditorShapes(), surveyed=True)


@pytest.fixture
def process(monkeypatch: pytest.MonkeyPatch) -> _Process:
    made = _Process()
    monkeypatch.setattr(survey, "ShapeValidator", made.begin)
    monkeypatch.setattr(survey, "PAUSE", 0.0)
    monkeypatch.setattr(survey, "GATHERING", 0.0)
    return made


async def test_a_file_that_changes_while_it_is_looked_at_is_looked_at_again(tmp_path: Path, process: _Process) -> None:
    (tmp_path / "a.bdd").write_text("", encoding="utf-8")
    surveyed = WorkspaceDiagnostics(cast(RobbddServer, _Server(tmp_path)))
    surveyed.schedule()
    first = await process.next()
    surveyed.schedule([first.uri])
    await surveyed.wait_for_news()
    assert process.asked.empty()
    process.answer(first)
    assert (await process.next()).uri == first.uri
    assert not surveyed.is_settled
