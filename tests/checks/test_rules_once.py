"""Each rule about missing or redundant parts of a model gives one finding, at its place, with the fix."""

import pytest

from checks.models import LINES, SETS, story
from kit import EVENTS, MODEL, SCENE, STORY, TEMPLATE, fixture
from robbdd_tools.features.diagnostics import all_diagnostics

TABLE = "| <fetch.part> | <fetch.robot> | <fetch.goal> |\n|---|\n| <parts.bolt> | <arms.panda> |\n"
SPARE = TEMPLATE.replace("var goal\n", "var goal\n    var spare\n")
SHELF = "//- lab.scene\n" + SCENE.replace("tray_ws }", "tray_ws, workspace shelf_ws }", 1)
OTHER = (
    "Scenario Template (ns=o) bring { duration: from <start> until <end> task: <task> var part "
    "When: event <start> occurs Behaviour (ns=o) haul { duration: from <start> until <end> <part> picks <part> } }\n"
)
MISTAKES = {
    "unused-variable": (EVENTS + SPARE + STORY.replace(LINES, LINES + "var <fetch.spare>: { 1 }\n"), "spare", "remove"),
    "unused-event": (EVENTS + "Event (ns=t) lift\n" + TEMPLATE + STORY, "lift", "use it, or remove it"),
    "unused-import": ("//- main.bdd\nimport 'm.bdd'\n" + MODEL + "//- m.bdd\n", "m.bdd", "remove this import"),
    "missing-value": (story(LINES.replace("var <fetch.robot>: { <arms.panda> }", "")), "bench-to-tray", "add a line"),
    "repeated-value": (story(LINES + "var <fetch.part>: { <parts.bolt> }\n"), "fetch.part", "remove this line"),
    "row-width": (story(TABLE), "| <parts.bolt> | <arms.panda> |", "add a value for 'fetch.goal'"),
    "selection-size": (
        story(LINES + "set var <fetch.goals>: select 3 permutations from <places>\n", SETS),
        "3",
        "or fewer",
    ),
    "empty-set": (MODEL.replace("{ <arms.panda> }", "{ }"), "{ }", "add a value"),
    "not-in-scene": ("//- main.bdd\n" + MODEL.replace("tray_ws>", "shelf_ws>") + SHELF, "places.shelf_ws", "add it"),
    "foreign-variable": (
        EVENTS.replace("ns t =", "ns o = 'https://example.org/o/'\nns t =")
        + TEMPLATE
        + OTHER
        + STORY.replace("variation:", "Then: f: holds(<bring.part> is held by <fetch.robot>, after <end>) variation:"),
        "bring.part",
        "write 'fetch.part'",
    ),
    "duplicate-iri": (
        "//- main.bdd\nimport 'm.bdd'\n" + MODEL + "//- m.bdd\nns m = 'https://example.org/t/'\nEvent (ns=m) end\n",
        "end",
        "give one of the two another name or namespace",
    ),
    "many-scenarios": (
        "//- main.bdd\n"
        + MODEL.replace("{ <arms.panda> }", "obj set <washers>").replace(
            "var <fetch.part>: obj set <parts>", "var <fetch.part>: obj set <washers>"
        )
        + "//- lab.scene\n"
        + SCENE.replace("count: 3", "count: 200"),
        "bench-to-tray",
        "80,000 scenarios (200 × 200 × 2): give fewer values",
    ),
}


@pytest.mark.parametrize("code", sorted(MISTAKES))
def test_a_rule_reports_its_mistake_once_in_its_place_with_what_to_do(code: str) -> None:
    text, place, words = MISTAKES[code]
    case = fixture(text)
    found = [entry for entry in all_diagnostics(case.snapshot, case.uri) if entry.code == code]
    assert len(found) == 1, found
    whole = case.project.texts()[found[0].uri][1]
    assert (found[0].uri, whole[found[0].span.start : found[0].span.end]) == (case.uri, place)
    assert words in found[0].message
