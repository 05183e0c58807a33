"""The expression that selects scenarios by their values."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robbdd_tools.gherkin.where import WhereError, check_where, condition, parse_where
from robbdd_tools.graph.acceptance_model import AcceptanceModel, Cell, Iri, Product, SceneModel, Template, Variant

SCENE = SceneModel((), (), (), {}, {})
MODEL = AcceptanceModel((), {}, {}, {"e": "https://x/e/", "t": "https://x/t/"})
VARIABLES = tuple(Iri(f"https://x/t/{name}") for name in ("robot", "var-speed", "goals"))
TEMPLATE = Template(Iri("https://x/t/fetch"), (), Iri("https://x/t/a"), Iri("https://x/t/b"))
VARIANT = Variant(Iri("https://x/t/v"), TEMPLATE, (), SCENE, Product(VARIABLES, ((), (), ())))
PANDA, TRAY, BENCH = (Iri(f"https://x/e/{name}") for name in ("panda", "tray", "bench-1"))
CELLS: tuple[Cell, ...] = (PANDA, 0.9, (TRAY, BENCH))


def fits(text: str, cells: tuple[Cell, ...] = CELLS) -> bool | None:
    expression = parse_where(text)
    check_where(expression, MODEL, [VARIANT])
    return condition(expression, MODEL, VARIANT)(cells)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("robot=panda", True),
        ("robot = e:panda", True),
        ("robot = 'https://x/e/panda'", True),
        ("fetch.robot=panda", True),
        ("t:robot=panda", True),
        ("robot=ur10", False),
        ("robot!=panda", False),
        ("robot =~ pan.*", True),
        ("robot=~pan", False),
        ("robot=~'(ur10|panda)'", True),
        ("speed=0.9", True),
        ("speed=0.90", True),
        ("speed<1", True),
        ("speed >= 0.9 and speed <= 0.9", True),
        ("speed>1", False),
        ("robot<1", False),
        ("goals=tray", True),
        ("goals=bench-1", True),
        ("goals!=tray", False),
        ("goals=~t.*", True),
        ("not robot=panda", False),
        ("robot=ur10 or speed=0.9", True),
        ("robot=ur10 or speed=0.9 and goals=none", False),
        ("(robot=ur10 or speed=0.9) and goals=tray", True),
        ("not (robot=ur10 or robot=kuka)", True),
        ('robot="pan\\da"', True),
    ],
)
def test_compares(text: str, expected: bool) -> None:
    assert fits(text) is expected


def test_strings_that_read_as_numbers_are_compared_as_such() -> None:
    assert fits("speed>=0.5", (PANDA, "0.9", ())) is True
    assert fits("speed>=0.5", (PANDA, "fast", ())) is False


def test_a_part_of_the_values_decides_where_the_others_cannot_matter() -> None:
    assert fits("robot=panda and speed=2", (PANDA,)) is None
    assert fits("robot=ur10 and speed=2", (PANDA,)) is False
    assert fits("robot=panda or speed=2", (PANDA,)) is True
    assert fits("not (robot=panda or speed=2)", (PANDA,)) is False


@pytest.mark.parametrize(
    ("text", "column", "words"),
    [
        ("", 1, "expected a variable instead of the end"),
        ("robot", 6, "after 'robot'"),
        ("robot=", 7, "expected a value"),
        (
            "speed=1.5 m/s",
            11,
            "or the end instead of 'm/s'; a value with spaces needs quotes, such as speed='1.5 m/s'",
        ),
        ("robot=panda 'x'", 13, "expected 'and', 'or' or the end instead of 'x'"),
        ("robot=panda and", 16, "expected a variable instead of the end"),
        ("(robot=panda", 13, "expected ')' for the '(' in column 1"),
        ("robot=panda)", 12, "instead of ')'"),
        ("arm=panda", 1, "unknown variable 'arm'; known variables: robot, speed, goals"),
        ("robot=panda and fetch.arm=x", 17, "unknown variable 'fetch.arm'"),
        ("speed<fast", 7, "'<' compares numbers and 'fast' is not one"),
        ("robot=~a[b", 9, "is not a regular expression"),
        ('robot="panda', 7, "unexpected"),
        ("!robot=panda", 1, "unexpected '!'"),
        ("(" * 1000, 101, "nested too deeply"),
        ("not " * 1000, 401, "nested too deeply"),
    ],
)
def test_what_is_wrong_is_said_with_its_column(text: str, column: int, words: str) -> None:
    with pytest.raises(WhereError) as caught:
        fits(text)
    assert words in str(caught.value)
    assert caught.value.column == column


@given(st.text(st.sampled_from("robt=~!<>()'\"\\ andor[*0. "), max_size=30))
def test_no_text_fails_otherwise(text: str) -> None:
    try:
        parse_where(text)
    except WhereError as error:
        column = error.column
    else:
        column = 1
    assert 1 <= column <= len(text) + 1
