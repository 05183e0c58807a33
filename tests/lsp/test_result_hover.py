"""Hover on what was judged: the last result, and for clients that show pictures the moment and the margin over time."""

from __future__ import annotations

import json
import re
import shutil
import sys
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

from kit import EXAMPLES
from lsp_kit import Editor, plain
from robbdd_tools.base.files import path_to_uri

PICTURE = re.compile(r"!\[([^]]*)\]\(data:([^;]*);base64,([^)]*)\)")
MOST = 100_000
"""Letters of a hover that VS Code reads."""
SOON = ("<thing> is located at <goal>, after <evt-place-end>", "<thing> is located at <goal>, after <evt-pick-end>")
"""An edit after which the goal is asked for before the thing can be there."""


@pytest_asyncio.fixture
async def pictured(tmp_path: Path, request: pytest.FixtureRequest) -> AsyncIterator[Editor]:
    """One scenario of the example with a clause that is violated, in a client that shows pictures, or does not."""
    shutil.copytree(EXAMPLES / "pickplace", tmp_path / "pickplace")
    client: Any = make_test_lsp_client()
    await client.start_io(sys.executable, "-m", "robbdd_tools.lsp.main", "--stdio")
    await client.initialize_session(
        types.InitializeParams(
            capabilities=client_capabilities("visual-studio-code"),
            workspace_folders=[types.WorkspaceFolder(uri=path_to_uri(tmp_path), name="test")],
            initialization_options=dict.fromkeys(("pictures", "replay"), cast(bool, getattr(request, "param", True))),
        )
    )
    editor = Editor(client, tmp_path)
    editor.open(editor.text.replace(*SOON))
    params = types.ExecuteCommandParams("robbdd.run", [{"uri": editor.uri, "variation": 1}])
    answer = await client.workspace_execute_command_async(params)
    assert answer["violated"] == 1
    yield editor
    await client.shutdown_session()


async def hover(editor: Editor, text: str) -> str:
    found = await editor.client.text_document_hover_async(types.HoverParams(**editor.at(text)))
    assert found is not None
    assert isinstance(found.contents, types.MarkupContent)
    return found.contents.value


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
    assert "part-to-bin`: 0/1 passed" in await hover(pictured, "tidy-bench {")
    pictured.change(SOON[1], SOON[0])
    assert "Last results, of the text before it was edited:" in await hover(pictured, "at-goal: holds")


@pytest.mark.physics
async def test_a_result_leads_to_its_replay(pictured: Editor) -> None:
    (link,) = re.findall(r"\[Replay\]\(command:robbdd\.showReplay\?([^)]*)\)", await hover(pictured, "at-goal: holds"))
    (target,) = json.loads(unquote(link))
    assert target.pop("clause").endswith("/at-goal")
    assert target == {"uri": pictured.uri, "run": 1, "index": 0}
    document = types.TextDocumentIdentifier(uri=pictured.uri)
    lenses = await pictured.client.text_document_code_lens_async(types.CodeLensParams(text_document=document))
    commands = {lens.command.title: lens.command for lens in lenses or () if lens.command is not None}
    (target,) = plain(commands["Replay"].arguments)
    assert target["uri"] == pictured.uri
    assert target["variant"].endswith("/part-to-bin")


@pytest.mark.physics
@pytest.mark.parametrize("pictured", [False], indirect=True)
async def test_a_client_without_pictures_gets_words(pictured: Editor) -> None:
    shown = await hover(pictured, "at-goal: holds")
    assert "✗ −" in shown
    assert "![" not in shown
    assert "command:" not in shown


@pytest.mark.physics
async def test_a_stored_run_that_is_gone_takes_its_pictures_along(pictured: Editor) -> None:
    shutil.rmtree(pictured.path.parent / ".robbdd" / "runs")
    shown = await hover(pictured, "at-goal: holds")
    assert "✗ −" in shown
    assert "![" not in shown
