"""The preview of a model's Gherkin, as requested by a client."""

from __future__ import annotations

import asyncio
from typing import Any

from lsprotocol import types

from kit import schema_errors
from lsp_kit import CLIENTS, Editor, plain
from robbdd_tools.base.files import path_to_uri


async def preview_of(editor: Editor, **more: object) -> Any:
    return await editor.client.protocol.send_request_async("robbdd/preview", {"uri": editor.uri, **more})


@CLIENTS
async def test_the_preview_follows_the_text_and_keeps_the_last_good_one(editor: Editor) -> None:
    editor.open("// 😀\n" + editor.text)
    first = await preview_of(editor)
    assert first.problem is None
    lines = str(first.text).split("\n")
    assert lines[:3] == ["# 4 scenarios", "# wording: 2", "@story=https:;;example.org;robbdd;criteria;tidy-bench"]
    place = next(entry for entry in first.lines if "is held by" in lines[entry.line])
    written: str = editor.text.split("\n")[int(place.range.start.line)]
    assert written.strip().startswith("in-hand: holds(")
    editor.change("<thing> is held by <robot>", "<thing> is held by <rob>")
    broken = await preview_of(editor)
    assert broken.text.split("\n")[1:] == lines[1:]
    assert broken.text.startswith("# out of date: the model has an error (line ")
    assert "'rob'" in broken.problem
    editor.change("<thing> is held by <rob>", "<robot> can reach <thing>")
    mended = await preview_of(editor, most=1)
    assert mended.problem is None
    assert " can reach " in mended.text
    assert mended.text.startswith("# the first 1 of 4 scenarios\n")


async def test_a_preview_of_nothing_says_so(editor: Editor) -> None:
    editor.open("Event (ns=")
    assert (await preview_of(editor)).text.endswith("there is nothing to show yet\n")
    editor.change("Event (ns=", "ns t = 'https://example.org/t/'")
    assert (await preview_of(editor)).text == "# 0 scenarios\n"


async def test_the_answer_to_a_preview_is_as_documented(editor: Editor) -> None:
    editor.open()
    assert schema_errors("preview.schema.json", plain(await preview_of(editor))) == []


async def test_a_setting_writes_definitions_in_place_of_phrases(editor: Editor) -> None:
    definition = (
        "Predicate (ns=crit) <thing> is-in-the-hand of <robot>: ( <thing> is held by <robot> and <robot> moves safely )"
    )
    text = editor.text.replace("Scenario Template", f"{definition}\nScenario Template", 1)
    editor.open(text.replace("<thing> is held by <robot>, ", "<thing> is-in-the-hand of <robot>, "))
    assert "is-in-the-hand of" in (await preview_of(editor)).text
    settings = {"robbdd": {"gherkin": {"expandPredicates": True}}}
    editor.client.set_configuration(settings)
    editor.client.set_configuration(settings, scope_uri=path_to_uri(editor.path.parent))
    editor.client.workspace_did_change_configuration(types.DidChangeConfigurationParams(settings=settings))
    while "is-in-the-hand of" in (shown := await preview_of(editor)).text:
        await asyncio.sleep(0.05)
    assert 'Then ( "env:' in shown.text
    assert schema_errors("preview.schema.json", plain(shown)) == []
