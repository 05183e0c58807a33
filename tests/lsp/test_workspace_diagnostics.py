"""The survey of files that are not open, with a process whose answers the test gives."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from io import BytesIO
from pathlib import Path
from typing import Any, cast

import pytest
from lsprotocol import types

from robbdd_tools.base.files import path_to_uri
from robbdd_tools.graph.shapes.project_shapes import EditorShapes
from robbdd_tools.lsp import workspace_diagnostics as survey
from robbdd_tools.lsp.convert import Converter
from robbdd_tools.lsp.framing import Answer, Request
from robbdd_tools.lsp.server import RobbddServer
from robbdd_tools.lsp.worker import Inbox, Worker
from robbdd_tools.lsp.workspace_diagnostics import WorkspaceDiagnostics
from robbdd_tools.names.project import Project
from robbdd_tools.workbench.model import load_all

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

    def answer(self, request: Request, together: tuple[str, ...] = ()) -> None:
        assert self._deliver is not None
        found = together or (request.uri,)
        self._deliver(Answer(request.revision, request.uri, (), "", found, frozenset(found)))


def _cycle(folder: Path, *names: str) -> tuple[str, ...]:
    """Write files that import each other in a circle. Return their URIs."""
    for name, imported in zip(names, (*names[1:], names[0]), strict=True):
        text = f'import "{imported}.bdd"\nns {name} = "https://example.org/{name}/"\nEvent (ns={name}) e-{name}\n'
        (folder / f"{name}.bdd").write_text(text, encoding="utf-8")
    return tuple(path_to_uri(folder / f"{name}.bdd") for name in names)


class _Server:
    """What a survey asks of its server; it is its own workspace, and nobody's code is in it."""

    pulls = True
    convert = Converter()
    project = Project()

    def __init__(self, folder: Path) -> None:
        self.workspace = self.user_errors = self.sources = self
        self.folders = [path_to_uri(folder)]
        self._tasks: list[asyncio.Task[None]] = []

    def elsewhere(self) -> dict[str, list[types.Diagnostic]]:
        return {}

    def learn(self, _: object) -> None: ...

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


async def test_files_that_import_each_other_are_looked_at_together_and_once(tmp_path: Path, process: _Process) -> None:
    cycle = _cycle(tmp_path, "a", "b", "c")
    (tmp_path / "d.bdd").write_text("", encoding="utf-8")
    surveyed = WorkspaceDiagnostics(cast(RobbddServer, _Server(tmp_path)))
    surveyed.schedule()
    asked = [await process.next(), await process.next()]
    assert {request.uri for request in asked} == {cycle[0], path_to_uri(tmp_path / "d.bdd")}
    for request in asked:
        process.answer(request, cycle if request.uri in cycle else ())
    await _settled(surveyed)
    assert process.asked.empty()
    assert set(surveyed.findings()) == {*cycle, path_to_uri(tmp_path / "d.bdd")}


async def test_a_file_that_changes_while_those_that_it_imports_are_looked_at_is_looked_at_again(
    tmp_path: Path, process: _Process
) -> None:
    cycle = _cycle(tmp_path, "a", "b", "c")
    surveyed = WorkspaceDiagnostics(cast(RobbddServer, _Server(tmp_path)))
    surveyed.schedule()
    first = await process.next()
    surveyed.schedule([cycle[1]])
    await surveyed.wait_for_news()
    process.answer(first, cycle)
    again = await process.next()
    process.answer(again, cycle)
    await _settled(surveyed)
    assert process.asked.empty()


async def test_import_lines_that_are_no_imports_hide_no_file(tmp_path: Path, process: _Process) -> None:
    for name, text in (("a", 'import "b.bdd"\n'), ("b", '// import "a.bdd"\n')):
        (tmp_path / f"{name}.bdd").write_text(text, encoding="utf-8")
    surveyed = WorkspaceDiagnostics(cast(RobbddServer, _Server(tmp_path)))
    surveyed.schedule()
    first = await process.next()
    process.answer(first)
    second = await process.next()
    process.answer(second)
    await _settled(surveyed)
    assert {first.uri, second.uri} == set(surveyed.findings())


def test_the_process_answers_for_all_files_of_a_cycle(tmp_path: Path) -> None:
    cycle = _cycle(tmp_path, "a", "b", "c")
    worker = Worker(Inbox(BytesIO()))
    answer = worker.answer(Request(1, cycle[0], {}, EditorShapes(), surveyed=True, importers=cycle))
    assert answer is not None
    assert answer.together == cycle
    alone = {(found.place.uri, found.code, found.message) for found in load_all([tmp_path]).diagnostics}
    assert {(found.uri, found.code, found.message) for found in answer.diagnostics} == alone
    assert {found.uri for found in answer.diagnostics if found.code == "cyclic-import"} == set(cycle)


async def _settled(surveyed: WorkspaceDiagnostics) -> None:
    async with asyncio.timeout(PATIENCE):
        while not surveyed.is_settled:
            await surveyed.wait_for_news()
