"""Hover on a judged clause: the last result, and for clients that show pictures the moment and the margin over time."""

from __future__ import annotations

import json
import re
import shutil
from base64 import b64decode
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any, cast
from urllib.parse import unquote
from xml.etree import ElementTree

import pytest
import pytest_asyncio
from lsprotocol import types
from pytest_lsp import client_capabilities, make_test_lsp_client

from fork_kit import ROBBDD_LSP
from lsp_kit import Editor, begin_session, plain
from robbdd_tools.cli import main

PICTURE = re.compile(r"!\[([^]]*)\]\(data:([^;]*);base64,([^)]*)\)")
MOST = 100_000
"""Letters of a hover that VS Code reads."""
SOON = ("<thing> is located at <goal>, after <evt-place-end>", "<thing> is located at <goal>, after <evt-pick-end>")
"""An edit after which the goal clause is evaluated before the object can be there."""


@pytest_asyncio.fixture
async def unjudged(tmp_path: Path, request: pytest.FixtureRequest) -> AsyncIterator[Editor]:
    """The example in a client that shows pictures and replays, or does not; nothing was run."""
    client: Any = make_test_lsp_client()
    await client.start_io(*ROBBDD_LSP, "--stdio")
    able = cast(bool, getattr(request, "param", True))
    await begin_session(
        client, tmp_path, client_capabilities("visual-studio-code"), [], {"pictures": able, "replay": able}
    )
    editor = Editor(client, tmp_path)
    editor.open()
    yield editor
    await client.shutdown_session()


@pytest_asyncio.fixture
async def pictured(unjudged: Editor) -> Editor:
    """One scenario of the example with a clause that is violated."""
    unjudged.change(*SOON)
    params = types.ExecuteCommandParams("robbdd.run", [{"uri": unjudged.uri, "variation": 1}])
    answer = await unjudged.client.workspace_execute_command_async(params)
    assert plain(answer)["violated"] == 1
    return unjudged


async def hover(editor: Editor, text: str) -> str:
    found = await editor.client.text_document_hover_async(types.HoverParams(**editor.at(text)))
    assert found is not None
    assert isinstance(found.contents, types.MarkupContent)
    return found.contents.value


async def replay_lenses(editor: Editor) -> list[str]:
    """The names of the variants with a lens that leads to the replay of this file's executions."""
    document = types.TextDocumentIdentifier(uri=editor.uri)
    lenses = await editor.client.text_document_code_lens_async(types.CodeLensParams(text_document=document))
    commands = [lens.command for lens in lenses or () if lens.command is not None]
    targets = [plain(command.arguments)[0] for command in commands if command.title == "Replay"]
    assert {target["uri"] for target in targets} <= {editor.uri}
    return [target["variant"].rpartition("/")[2] for target in targets]


@pytest.mark.physics
async def test_a_violated_clause_shows_its_moment_and_its_margin_over_time(pictured: Editor) -> None:
    for place in ("at-goal: holds", "is located at <goal>, after", "part-to-bin {"):
        shown = await hover(pictured, place)
        assert "✗ −" in shown
        pictures = {name: (kind, b64decode(data)) for name, kind, data in PICTURE.findall(shown)}
        kind, drawn = pictures["margin over time"]
        assert (kind, ElementTree.fromstring(drawn).tag) == ("image/svg+xml", "{http://www.w3.org/2000/svg}svg")
        kind, moment = pictures["the moment of the violation"]
        assert (kind, moment[:4]) == ("image/png", b"\x89PNG")
        assert len(shown) < MOST
    assert [name for name, _, _ in PICTURE.findall(await hover(pictured, "in-hand: holds"))] == ["margin over time"]
    assert "part-to-bin`: ✗ 1 of 4 executed, 0 passed" in await hover(pictured, "tidy-bench {")
    pictured.change(SOON[1], SOON[0])
    assert "Last results, before the text was edited:" in await hover(pictured, "at-goal: holds")


@pytest.mark.physics
async def test_a_result_leads_to_its_replay(pictured: Editor) -> None:
    (link,) = re.findall(r"\[Replay\]\(command:robbdd\.showReplay\?([^)]*)\)", await hover(pictured, "at-goal: holds"))
    (target,) = json.loads(unquote(link))
    assert target.pop("clause").endswith("/at-goal")
    assert target == {"uri": pictured.uri, "run": 1, "index": 0}
    assert await replay_lenses(pictured) == ["part-to-bin"]


@pytest.mark.physics
async def test_a_run_of_the_command_line_is_replayed_from_a_lens_too(unjudged: Editor) -> None:
    assert await replay_lenses(unjudged) == []
    assert main(["run", str(unjudged.path), "--where", "thing = cube0"]) == 0
    assert await replay_lenses(unjudged) == ["part-to-bin"]
    shutil.rmtree(unjudged.path.parent / ".robbdd" / "runs")
    assert await replay_lenses(unjudged) == []


@pytest.mark.physics
@pytest.mark.parametrize("unjudged", [False], indirect=True)
async def test_a_client_without_pictures_gets_words(pictured: Editor) -> None:
    shown = await hover(pictured, "at-goal: holds")
    assert "✗ −" in shown
    assert "![" not in shown
    assert "command:" not in shown
    assert await replay_lenses(pictured) == []


@pytest.mark.physics
async def test_a_stored_run_that_is_gone_takes_its_pictures_along(pictured: Editor) -> None:
    shutil.rmtree(pictured.path.parent / ".robbdd" / "runs")
    shown = await hover(pictured, "at-goal: holds")
    assert "✗ −" in shown
    assert "![" not in shown
