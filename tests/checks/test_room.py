"""Scenes with more agents or containers than find room, and sets where one element is needed."""

from __future__ import annotations

from checks.models import LINES, check, fixture, marked, story
from kit import MODEL, SCENE, TEMPLATE, Fixture
from robbdd_tools.features.diagnostics import fast_diagnostics

SCENE_URI = "file:///fixture/lab.scene"
FIVE = "agent panda, agent ur10, agent kinova, agent panda2, agent panda3"


def messages(case: Fixture, uri: str, code: str) -> list[tuple[str, str]]:
    text = case.snapshot.document(uri).text
    found = (one for one in fast_diagnostics(case.snapshot, uri) if one.code == code)
    return [(text[one.span.start : one.span.end], one.message) for one in found]


def bins(count: int, more: str = "") -> Fixture:
    names = ", ".join(f"object bin{number}" for number in range(count))
    scene = SCENE.replace("scene (ns=env) bench_scene {", f"obj set (ns=env) bins {{ {names} }}\n$").replace(
        "$", "scene (ns=env) bench_scene { obj set <bins>"
    )
    return fixture(f"//- main.bdd\n{MODEL}//- lab.scene\n{scene}{more}")


def test_a_bin_without_a_place_is_reported_at_its_name() -> None:
    assert messages(bins(3), SCENE_URI, "no-room") == []
    ((name, message),) = messages(bins(5), SCENE_URI, "no-room")
    assert name == "bin4"
    assert message.startswith("there is room for 4 objects of the kind 'bin' on ")


def test_a_scene_that_a_scenex_places_is_not_counted() -> None:
    scenex = """//- lab.scenex
import "lab.scene"
ns sim = 'https://example.org/sim/'
scene inst (ns=sim) lab_sim { scene: <bench_scene> }
"""
    assert messages(bins(5, scenex), SCENE_URI, "no-room") == []


def agents(line: str) -> Fixture:
    template = TEMPLATE.replace("var goal\n", "var goal\n    set var helpers\n").replace(
        "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)",
        "( var h exists in <helpers> ) such that { near: holds(<h> can reach <part>, after <place-end>) }",
    )
    scene = SCENE.replace("agent panda, agent ur10", FIVE)
    return fixture(f"//- main.bdd\n{story(LINES + line, template)}//- lab.scene\n{scene}")


def test_more_agents_than_sides_of_a_table_are_reported_at_the_scene_of_the_scenario() -> None:
    every = "<arms.panda>, <arms.ur10>, <arms.kinova>, <arms.panda2>"
    four = agents(f"                set var <fetch.helpers>: {{ {{ {every} }} }}\n")
    assert messages(four, four.uri, "no-room") == []
    five = agents(f"                set var <fetch.helpers>: {{ {{ {every}, <arms.panda3> }} }}\n")
    ((name, message),) = messages(five, five.uri, "no-room")
    assert name == "bench_scene"
    assert message.startswith("this scenario uses 5 agents, but there is room for 4")


def test_a_set_in_a_slot_of_one_element_is_reported_at_the_slot() -> None:
    template = TEMPLATE.replace("var part\n", "set var part\n")
    lines = LINES.replace("var <fetch.part>: obj set <parts>", "set var <fetch.part>: { { <parts.bolt> } }")
    check(marked(story(lines, template), "picks <«part»> and", "single-element 'pick-place' needs one object"))


def test_a_place_may_be_a_set_and_an_element_of_a_for_all_is_none() -> None:
    template = TEMPLATE.replace("var goal\n", "set var goal\n")
    lines = LINES.replace("var <fetch.goal>: ", "set var <fetch.goal>: { ").replace("_ws> }", "_ws> } }")
    check(story(lines, template))
