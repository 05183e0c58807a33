"""Types of variables as editors show them: hints, hover, completion."""

import pytest

from kit import EVENTS, MODEL, STORY, TEMPLATE, fixture
from robbdd_tools.base.document import Span
from robbdd_tools.features.completion import complete
from robbdd_tools.features.hover import hover
from robbdd_tools.features.type_hints import type_hints

CONFIG = TEMPLATE.replace("    var goal\n", "    var goal\n    var speed\n    set var goals\n    var any\n").replace(
    "        in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)",
    "        ( in-tray: holds(<robot> has config speed = <speed>, after <end>)\n"
    "          and told: holds(pred('{a}', a=<any>), after <end>)\n"
    "          and ( var y exists in <goals> ) such that { some: holds(<part> is located at <y>, after <end>) } )",
)
VALUES = STORY.replace("variation:\n", "variation:\nvar <fetch.speed>: { 0.5, 1 }\n")


def hints(text: str) -> dict[str, str]:
    case = fixture(text)
    whole = case.project.texts()[case.uri][1]
    found = type_hints(case.snapshot, case.uri, Span(0, len(whole)))
    return {whole[hint.span.start : hint.span.end]: hint.label for hint in found}


def labels(text: str) -> list[str]:
    case = fixture(text)
    return [entry.label for entry in complete(case.snapshot, case.uri, case.cursor) if entry.kind != "keyword"]


def edited(old: str, new: str, text: str = MODEL) -> str:
    assert old in text
    return text.replace(old, new, 1)


def test_phrases_tell_the_types_of_variables() -> None:
    assert hints(MODEL) == {"part": ": object", "robot": ": agent", "goal": ": workspace"}


def test_values_tell_what_phrases_leave_open() -> None:
    found = hints(EVENTS + CONFIG + VALUES)
    assert found["speed"] == ": number"
    assert found["goals"] == ": set of workspaces"
    assert found["y"] == ": workspace"
    assert "any" not in found


def test_values_of_importing_files_count_as_well() -> None:
    text = (
        f"//- main.bdd\n{EVENTS}{CONFIG}//- stories.bdd\nimport \"main.bdd\"\nns t = 'https://example.org/s/'\n{VALUES}"
    )
    assert hints(text)["speed"] == ": number"


def test_a_variable_of_several_kinds_names_them() -> None:
    values = VALUES.replace("variation:\n", "variation:\nvar <fetch.any>: { <parts.bolt>, <arms.panda> }\n")
    assert hints(EVENTS + CONFIG + values)["any"] == ": object or agent"


def test_hints_are_made_for_the_visible_part_only() -> None:
    case = fixture(MODEL)
    assert type_hints(case.snapshot, case.uri, Span(0, len(EVENTS))) == []


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (edited("var part", "var pa$0rt"), "**variable** `fetch.part`: object"),
        (edited("var <fetch.robot>", "var <fetch.ro$0bot>"), "**variable** `fetch.robot`: agent"),
        (edited("set var goals", "set var go$0als", EVENTS + CONFIG), "`fetch.goals`: set of workspaces"),
        (edited("var any", "var a$0ny", EVENTS + CONFIG), "**variable** `fetch.any`\n"),
    ],
)
def test_hover_tells_the_type_of_a_variable(text: str, words: str) -> None:
    case = fixture(text)
    found = hover(case.snapshot, case.uri, case.cursor)
    assert found is not None
    assert words in found.markdown


def test_only_values_of_the_variables_type_are_offered() -> None:
    assert labels(edited("{ <arms.panda> }", "{ <$0> }")) == ["arms.panda", "arms.ur10"]
    assert labels(edited("<places.bench_ws>, <places.tray_ws>", "<places.bench_ws>, <$0>")) == [
        "places.bench_ws",
        "places.tray_ws",
    ]


def test_a_cell_offers_values_of_its_column() -> None:
    lines = STORY[STORY.index("                var ") : STORY.index("        }\n}")]
    table = "| <fetch.part> | <fetch.robot> |\n|---|\n| <parts.bolt> | <arms.panda> |\n| <parts.nut> |\n <$0> |\n"
    assert labels(edited(lines, table)) == ["arms.panda", "arms.ur10"]
    assert "parts.bolt" in labels(edited(lines, table.replace("| <parts.nut> |\n <$0>", "| <$0>")))
    assert "arms.panda" not in labels(edited(lines, table.replace("| <parts.nut> |\n <$0>", "| <$0>")))


def test_a_constant_set_is_offered_by_its_elements() -> None:
    sets = "const set (ns=t) robots { <arms.panda> }\nconst set (ns=t) things { <parts.bolt> }\n"
    text = EVENTS + sets + TEMPLATE + STORY
    assert labels(
        edited("{ <arms.panda> }\n                var <fetch.goal>", "set <$0>\n var <fetch.goal>", text)
    ) == ["robots"]


def test_a_value_of_an_open_variable_may_be_anything() -> None:
    text = EVENTS + CONFIG + VALUES.replace("{ 0.5, 1 }", "{ <$0> }")
    assert {"arms.panda", "parts.bolt", "places.tray_ws"} <= set(labels(text))


def test_variables_that_fit_a_slot_come_first() -> None:
    start = edited("<robot> picks <part> and places at <goal>", "<robot> picks <$0")
    objects = [
        "furniture.bench",
        "furniture.tray",
        "parts.bolt",
        "parts.nut",
        *(f"washers.washer{n}" for n in range(3)),
    ]
    assert labels(start) == ["part", "robot", "goal", *objects]
    assert labels(edited("<robot> picks <$0", "<robot> picks <part> and places at <$0", start)) == [
        "goal",
        "part",
        "robot",
        "places.bench_ws",
        "places.tray_ws",
    ]
    unknown = edited("var goal\n", "var goal\n    var zone\n", start)
    assert labels(unknown) == ["part", "robot", "zone", "goal", *objects]
