"""A literal of a template becomes a variable with its value in each scenario; the sentences stay the same."""

from __future__ import annotations

import pytest

from gherkin_kit import steps
from kit import MODEL, SCENE, STORY, fixture
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.document import Span
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.refactor_literals import literal_as_variable

GIVEN = "on-bench: holds(<part> is located at <goal>, before <pick-start>)"
LITERALS = f"""(
            {GIVEN}
            and fast: holds(<robot> has config ee_speed = 0.9, before <pick-start>)
            and near: holds(<robot> is nearer than 0.5 m to <part>, within 2.5 seconds before <pick-start>)
            and text: holds(pred("{{r}} waves {{hand}}", r=<robot>, hand="left"), before <pick-start>)
            and free: holds(<part> is-put near <goal> by 3 cm, before <pick-start>)
        )"""
PREDICATE = "Predicate (ns=t) <a> is-put near <b> by <gap>: ( <a> is nearer than <gap> to <b> )\n"
TABLE = """                | <fetch.part> | <fetch.robot> | <fetch.goal> |
                |---|---|---|
                | <parts.nut> | <arms.ur10> | <places.tray_ws> |
"""
VARIANT = STORY[STORY.index("        Scenario ") : STORY.rindex("}")]
SECOND = VARIANT[: VARIANT.index("                var")].replace("bench-to-tray", "tabled") + TABLE + "        }\n"
TEXT = MODEL.replace(GIVEN, LITERALS).replace("Scenario Template", f"{PREDICATE}Scenario Template").rpartition("}")[0]
WHOLE = f"{TEXT}{SECOND}}}\n"


def turned(text: str, literal: str) -> tuple[str, str] | None:
    """The title of the refactoring of a literal, and the text after it."""
    case = fixture(f"//- main.bdd\n{text}\n//- lab.scene\n{SCENE}")
    start = text.index(literal)
    fix = literal_as_variable(case.snapshot, case.uri, Span(start, start))
    if fix is None:
        return None
    for edit in sorted(fix.edits, key=lambda edit: edit.span, reverse=True):
        text = text[: edit.span.start] + edit.text + text[edit.span.end :]
    return fix.title, text


@pytest.mark.parametrize(
    ("literal", "name"),
    [("0.9", "ee_speed"), ("0.5 m", "distance"), ("2.5", "duration"), ('"left"', "hand"), ("3 cm", "by")],
)
def test_a_literal_becomes_a_variable(literal: str, name: str) -> None:
    found = turned(WHOLE, literal)
    assert found is not None
    title, text = found
    assert title == f"Turn {literal} into the variable '{name}'"
    assert f"    var goal\n    var {name}\n" in text
    assert f"                var <fetch.{name}>: {{ {literal} }}\n" in text
    assert f"| <fetch.goal> | <fetch.{name}> |\n" in text
    assert f"| <places.tray_ws> | {literal} |\n" in text
    case = fixture(f"//- main.bdd\n{text}\n//- lab.scene\n{SCENE}")
    errors = [one for one in fast_diagnostics(case.snapshot, case.uri) if one.severity is Severity.ERROR]
    assert errors == []
    for number in (0, 4):
        assert steps(text, number) == steps(WHOLE, number)


def test_the_name_is_one_that_no_template_has() -> None:
    taken = WHOLE.replace("    var goal\n", "    var goal\n    var distance\n").replace(
        "robot> is nearer", "robot> is  nearer"
    )
    found = turned(taken, "0.5 m")
    assert found is not None
    assert "var distance-2\n" in found[1]


@pytest.mark.parametrize(
    "text",
    [
        # A table with rows of several widths, a story with a syntax error, and a broken template.
        WHOLE.replace("| <parts.nut> |", "| <parts.nut> | 3 |"),
        WHOLE.replace("scene: <bench_scene>", "scene <bench_scene>"),
        WHOLE.replace("task: <task>", "task <task>"),
    ],
)
def test_nothing_is_offered_if_a_scenario_would_lack_the_value(text: str) -> None:
    assert turned(text, "0.9") is None


def test_nothing_is_offered_beside_literals() -> None:
    assert turned(WHOLE, "Scenario Template") is None
    assert turned(WHOLE, "on-bench") is None
    assert turned(WHOLE, "As A") is None
