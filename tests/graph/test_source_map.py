"""The source map maps a graph's statements to their tokens."""

import pytest

from graph.statements import built
from kit import MODEL, SCENE
from robbdd_tools.graph.write.source_map import Location

T, ENV = "https://example.org/t/", "https://example.org/env/"
TEXTS = {"main.bdd": MODEL, "lab.scene": SCENE}


def token(location: Location | None) -> str:
    assert location is not None
    return TEXTS[location.uri.rpartition("/")[2]][location.span.start : location.span.end]


@pytest.mark.parametrize(
    ("node", "text"),
    [
        (T + "fetch", "fetch"),
        (T + "fetch-scenario-given", "fetch"),
        (T + "var-part", "part"),
        (T + "on-bench", "on-bench"),
        (T + "carry", "carry"),
        (T + "when-bhv-fetch.when", "carry"),
        (T + "fetching", "fetching"),
        (T + "bench-to-tray", "bench-to-tray"),
        (ENV + "bolt", "bolt"),
        (ENV + "washer1", "washer"),
        (ENV + "tray_comp", "tray_comp"),
        (ENV + "bench_scene-scene-has-obj", "bench_scene"),
    ],
)
def test_a_node_leads_to_the_name_that_declares_it(node: str, text: str) -> None:
    if node.endswith("washer1"):
        sources = built(MODEL.replace("obj set <parts>", "obj set <washers>")).sources
    else:
        sources = built(MODEL).sources
    assert token(sources.node(node)) == text


@pytest.mark.parametrize(
    ("node", "term", "text"),
    [
        (T + "fetch", "time:before-event", "end"),
        (T + "fetch-scenario", "task:of-task", "task"),
        (T + "in-tray", "bdd:ref-object", "part"),
        (T + "in-tray", "time:after-event", "place-end"),
        (T + "in-tray", "time:horizon-seconds", "0.5"),
        (T + "when-bhv-fetch.when", "bhv:target-agent", "robot"),
        (T + "fetching", "rbw:role", '"operator"'),
        (T + "bench-to-tray", "bdd:of-template", "fetch"),
        (T + "bench-to-tray", "rbw:scene", "bench_scene"),
        (ENV + "tray_comp", "env:of-workspace", "places.tray_ws"),
    ],
)
def test_a_property_leads_to_its_token(node: str, term: str, text: str) -> None:
    assert token(built(MODEL).sources.property(node, term)) == text


def test_a_value_leads_to_every_place_where_it_is_given() -> None:
    table = "| <fetch.part> |\n|---|\n| <parts.nut> |\n| <parts.bolt> |\n| <parts.nut> |\n"
    text = MODEL[: MODEL.index("                var <fetch.part>")] + table + "}\n}\n"
    variation = T + "tv-table-fetching.bench-to-tray"
    places = built(text).sources.value(variation, T + "var-part", ENV + "nut")
    assert [text[place.span.start : place.span.end] for place in places] == ["parts.nut", "parts.nut"]
    assert built(text).sources.value(variation, T + "var-part", ENV + "tray") == ()


def test_what_is_unknown_has_no_place() -> None:
    sources = built(MODEL).sources
    assert sources.node(T + "nothing") is None
    assert sources.property(T + "fetch", "rbw:role") is None
