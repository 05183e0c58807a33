"""Configurations and their values are checked while editing, as a run would."""

import pytest

from checks.models import LINES, check, fixed, found, marked, story
from kit import TEMPLATE

GIVEN = "        on-bench: holds(<part> is located at <goal>, before <pick-start>)\n"
FAST = "fast: holds(<robot> has config {} = <value>, before <pick-start>)"


def model(name: str, value: str, kind: str = "var") -> str:
    clauses = f"        ( {GIVEN.strip()} and {FAST.format(name)} )\n"
    template = TEMPLATE.replace(GIVEN, clauses).replace("var goal\n", f"var goal\n    {kind} value\n")
    return story(f"{LINES}                {kind} <fetch.value>: {value}\n", template)


@pytest.mark.parametrize(
    ("name", "value", "kind"),
    [
        ("ee_speed", "{ 0.25, 1 }", "var"),
        ("position_range", '{ "normal", "0 1 -0.5 0.5" }', "var"),
        ("position_range", "{ { 0, 1, -0.5, 0.5 } }", "set var"),
    ],
)
def test_a_value_that_a_run_accepts_is_no_finding(name: str, value: str, kind: str) -> None:
    check(model(name, value, kind))


def test_an_unknown_name_has_suggestions_of_which_one_mends_it() -> None:
    text = model("ee_sped", "{ 0.25 }")
    check(marked(text, "has config «ee_sped» =", "setting did you mean 'ee_speed'?"))
    assert fixed(text, "setting") == model("ee_speed", "{ 0.25 }")


def test_a_word_of_several_names_is_answered_with_what_each_applies_to() -> None:
    (entry,) = found(model("speed", "{ 0.25 }"), "setting")
    assert "did you mean 'ee_speed' (an agent), 'max_speed' (an agent), 'belt_speed' (a conveyor)" in entry.message
    assert [fix.title for fix in entry.fixes][:3] == [f"Change to '{name}_speed'" for name in ("ee", "max", "belt")]


def test_a_name_like_no_other_is_answered_with_all() -> None:
    (entry,) = found(model("zzz", "{ 1 }"), "setting")
    assert "the known ones are " in entry.message
    assert "ee_speed" in entry.message


@pytest.mark.parametrize(
    ("name", "value", "kind", "words"),
    [
        (
            "ee_speed",
            '{ 0.25, «"fast"» }',
            "var",
            "'ee_speed' cannot be 'fast': it must be a number from 0.01 to 3 m/s",
        ),
        ("ee_speed", "{ «100» }", "var", "a number from 0.01 to 3"),
        ("ee_speed", "{ «<arms.panda>» }", "var", "a number from"),
        ("position_range", "{ «{ 0, 1 }» }", "set var", "4 numbers"),
    ],
)
def test_a_value_that_does_not_fit_is_reported_where_it_is_written(
    name: str, value: str, kind: str, words: str
) -> None:
    plain = value.replace("«", "").replace("»", "")
    part = value[value.index("«") + 1 : value.index("»")]
    text = model(name, plain, kind)
    (entry,) = found(text, "setting")
    assert text[entry.span.start : entry.span.end] == part.strip("<>")
    assert words in entry.message
