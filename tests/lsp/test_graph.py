"""The picture of a model's graph, as requested by a client."""

from __future__ import annotations

from typing import Any

from kit import schema_errors
from lsp_kit import CLIENTS, Editor, plain


async def graph_of(editor: Editor, **more: object) -> Any:
    return await editor.client.protocol.send_request_async("robbdd/graph", {"uri": editor.uri, **more})


def written(editor: Editor, place: Any) -> str:
    """The text of a place of one line of ASCII."""
    line = editor.text.split("\n")[int(place.range.start.line)]
    return line[int(place.range.start.character) : int(place.range.end.character)]


@CLIENTS
async def test_the_picture_follows_the_text_and_keeps_the_last_good_one(editor: Editor) -> None:
    editor.open("// 😀\n" + editor.text)
    first = await graph_of(editor)
    assert first.problem is None
    held = next(node for node in first.nodes if node.name == "in-hand")
    assert (held.concept, written(editor, held.source)) == ("then", "in-hand")
    assert f'data-iri="{held.iri}"' in first.svg
    editor.change("<thing> is held by <robot>", "<thing> is held by <rob>")
    broken = await graph_of(editor)
    assert broken.svg == first.svg
    assert "'rob'" in broken.problem
    editor.change("<thing> is held by <rob>", "<robot> can reach <thing>")
    mended = await graph_of(editor)
    assert mended.problem is None
    assert "robot can reach thing" in mended.svg


async def test_a_place_belongs_to_the_declaration_around_it_and_to_what_it_names(editor: Editor) -> None:
    editor.open()
    made = await graph_of(editor)
    event = next(node.iri for node in made.nodes if node.name == "evt-pick-end")
    texts = {written(editor, place) for place in made.places if place.iri == event}
    assert texts == {"evt-pick-end", "Event (ns=crit) evt-pick-end"}


async def test_a_large_graph_is_drawn_around_the_cursor(editor: Editor) -> None:
    editor.open()
    whole = await graph_of(editor)
    assert (whole.root, whole.shown) == (None, whole.total)
    clause = await graph_of(editor, position=plain_position(editor, "in-hand"), most=whole.total - 1)
    assert clause.root.concept in ("variant", "template")
    assert clause.shown < clause.total
    assert "in-hand" in {node.name for node in clause.nodes}
    assert {place.iri for place in clause.places} <= {node.iri for node in clause.nodes}


async def test_nothing_to_draw_is_told_apart_from_a_problem(editor: Editor) -> None:
    editor.open("Event (ns=")
    broken = await graph_of(editor)
    assert (broken.svg, broken.problem is None) == ("", False)


async def test_the_answer_is_as_documented(editor: Editor) -> None:
    editor.open()
    for more in ({}, {"most": 5}):
        assert schema_errors("graph.schema.json", plain(await graph_of(editor, **more))) == []


def plain_position(editor: Editor, text: str) -> dict[str, int]:
    place = editor.position(text)
    return {"line": place.line, "character": place.character}
