"""The picture of a graph: everything in it once, readable, with its place, the same bytes each time."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from commands.test_graph_models import robbdd
from graph.models import EVERYTHING
from graph.statements import built
from graph.test_behaviour_trees import LINKED, NESTED
from kit import EVENTS, EXAMPLES, MODEL, STORY
from robbdd_tools.graph.ask.structure import structure_of
from robbdd_tools.graph.ask.svg import LETTER, draw
from robbdd_tools.graph.write.source_map import Location

SVG = "{http://www.w3.org/2000/svg}"
TREES = EVENTS + NESTED + LINKED + STORY
MODELS = pytest.mark.parametrize("text", [MODEL, EVERYTHING, TREES], ids=["small", "everything", "trees"])


def place(location: Location) -> str:
    return f"{location.uri.rpartition('/')[2]}:{location.span.start}:{location.span.end}"


def picture(text: str) -> ElementTree.Element:
    return ElementTree.fromstring(draw(structure_of(built(text)), place))


def nodes(text: str) -> list[ElementTree.Element]:
    return [group for group in picture(text).iter(f"{SVG}g") if "data-iri" in group.attrib]


def extent(group: ElementTree.Element) -> tuple[float, float, float, float]:
    """Left, top, right and bottom of a node's outline."""
    shape = group[1]
    if shape.tag == f"{SVG}rect":
        x, y, width, height = (float(shape.attrib[name]) for name in ("x", "y", "width", "height"))
        return x, y, x + width, y + height
    points = [tuple(map(float, pair.split(","))) for pair in shape.attrib["points"].split()]
    across, down = zip(*points, strict=True)
    return min(across), min(down), max(across), max(down)


def test_every_concept_of_a_story_is_there_once() -> None:
    concepts = [group.attrib["data-concept"] for group in nodes(MODEL)]
    assert sorted(concepts) == sorted(["story", "variant", "template", "given", "when", "then", *["event"] * 4])


def test_a_clause_reads_as_it_is_written() -> None:
    texts = {"".join(f"{line} " for line in group.itertext()) for group in nodes(MODEL)}
    assert any("in-tray part is located at goal for 0.5 s after place-end" in text for text in texts)
    assert any("robot picks part and places at goal from pick-start until place-end" in text for text in texts)


def test_each_node_tells_where_it_is_written() -> None:
    for group in nodes(MODEL):
        name, start, end = group.attrib["data-source"].split(":")
        assert name == "main.bdd"
        written = MODEL[int(start) : int(end)]
        assert written
        assert group.attrib["data-source"] in (group.findtext(f"{SVG}title") or "")
        if group.attrib["data-concept"] != "when":
            assert group.attrib["data-iri"].endswith(written)


def test_a_behaviour_leads_to_its_node_of_a_tree_and_composites_to_their_parts() -> None:
    drawn = picture(TREES)
    iris = {group.attrib["data-iri"]: "".join(group.itertext()) for group in drawn.iter() if "data-iri" in group.attrib}
    links = [(path.attrib["data-from"], path.attrib["data-to"]) for path in drawn.iter() if "data-from" in path.attrib]
    names = {iri: iri.rpartition("node-handling.")[2] for iri in iris if "node-handling." in iri}
    assert list(names.values()) == ["whole", "grasp", "pick", "pick-again", "place"]
    assert "selector" in iris[next(iri for iri, name in names.items() if name == "grasp")]
    found = [(names.get(start, "behaviour"), names[end]) for start, end in links if end in names]
    assert sorted(found) == [
        ("behaviour", "pick"),
        ("grasp", "pick"),
        ("grasp", "pick-again"),
        ("whole", "grasp"),
        ("whole", "place"),
    ]


@MODELS
def test_nothing_covers_anything_else(text: str) -> None:
    boxes = [extent(group) for group in nodes(text)]
    for number, (left, top, right, bottom) in enumerate(boxes):
        for other in boxes[number + 1 :]:
            assert right <= other[0] or other[2] <= left or bottom <= other[1] or other[3] <= top


@MODELS
def test_text_stays_within_its_box(text: str) -> None:
    for group in nodes(text):
        left, top, right, bottom = extent(group)
        for line in group.iter(f"{SVG}text"):
            start, base = float(line.attrib["x"]), float(line.attrib["y"])
            wide = LETTER / 0.88 if line.attrib["class"] == "name" else LETTER
            assert left < start
            assert start + wide * len(line.text or "") <= right
            assert top < base < bottom


@MODELS
def test_the_same_text_gives_the_same_bytes_and_nothing_is_fetched(text: str) -> None:
    first = draw(structure_of(built(text)), place)
    assert draw(structure_of(built(text)), place) == first
    assert set(re.findall(r"url\(([^)]*)\)", first)) == {"#tip"}
    assert not re.search(r"href|@import|@font-face|<image|<script", first)


def test_all_colours_are_explained() -> None:
    legend = {group.findtext(f"{SVG}text") for group in picture(MODEL).iter(f"{SVG}g") if "transform" in group.attrib}
    concepts = {"User story", "Scenario variant", "Scenario template", "Given", "When", "Then", "Event", "Tree node"}
    assert legend == concepts | {"leads to", "lasts from and until"}


@pytest.mark.usefixtures("forks")
def test_the_command_line_draws_with_lines_and_columns(tmp_path: Path) -> None:
    done = robbdd("graph", EXAMPLES / "tworobots" / "heights.bdd", "--format", "svg", folder=tmp_path)
    assert done.returncode == 0
    lines = (EXAMPLES / "tworobots" / "heights.bdd").read_text(encoding="utf-8").splitlines()
    found = re.search(r'data-iri="[^"]*/goal-untouched" data-source="heights\.bdd:(\d+):(\d+)"', done.stdout)
    assert found is not None
    assert lines[int(found[1]) - 1][int(found[2]) - 1 :].startswith("goal-untouched")
    assert "goal has config height_scale = scale" in done.stdout
    assert str(tmp_path) not in done.stdout
