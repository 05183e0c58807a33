"""A horizon may be a variable of the scenario; a value that is not a duration leaves the clause unjudged."""

from __future__ import annotations

from math import inf, nan

import pytest

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.gherkin.scenario_outline import outline
from robbdd_tools.gherkin.steps import StepWriter
from robbdd_tools.graph.acceptance_model import (
    AcceptanceModel,
    Clause,
    Exists,
    Fluent,
    Iri,
    Product,
    TextClause,
    TextFluent,
    Value,
)
from robbdd_tools.monitor.time import After, Before, TimeConstraint
from robbdd_tools.protocol import clauses as stated

NAME, THING, PLACE, LIMIT, LIMITS = (Iri(f"x:{name}") for name in ("name", "thing", "place", "limit", "limits"))
MODEL = AcceptanceModel((), {}, {LIMITS: (2, 3)}, {"x": "x:"})
WRITER = StepWriter(MODEL, load_catalog())
AT = '"x:thing" is located at "x:place"'


def located(time: TimeConstraint) -> Clause:
    return Fluent(NAME, "then", "located-at", {"object": THING, "workspace": PLACE}, time, (), LIMIT)


def statement(clause: Clause, value: Value) -> tuple[stated.Statement, str]:
    (step,) = WRITER.steps((clause,), {LIMIT: value})
    return step.statement, step.text


@pytest.mark.parametrize(
    ("clause", "time", "sentence"),
    [
        (located(After("x:e")), After("x:e", 8.0), f'{AT} for 8 seconds after event "x:e"'),
        (
            located(Before("x:e", some_time=True)),
            Before("x:e", 8.0, some_time=True),
            f'{AT} at some time within 8 seconds before event "x:e"',
        ),
        (
            TextFluent(NAME, "then", "it glows", {}, After("x:e"), (), LIMIT),
            After("x:e", 8.0),
            'it glows for 8 seconds after event "x:e"',
        ),
        (
            TextClause(NAME, "then", "it glows", Before("x:e"), LIMIT),
            Before("x:e", 8.0),
            'it glows for 8 seconds before event "x:e"',
        ),
    ],
)
def test_the_value_of_the_variable_is_the_horizon(clause: Clause, time: TimeConstraint, sentence: str) -> None:
    found, text = statement(clause, 8)
    assert isinstance(found, stated.Fluent | stated.Text)
    assert (found.time, text) == (time, sentence)


@pytest.mark.parametrize("value", ["8", "8 s", -1, nan, inf, (1, 2), Iri("x:thing")])
def test_a_value_that_is_no_duration_leaves_a_text_that_nothing_judges(value: Value) -> None:
    found, text = statement(located(After("x:e")), value)
    assert isinstance(found, stated.Text)
    assert found.time is None
    assert text.startswith(f"{AT} for ")


def test_a_missing_value_leaves_a_text_that_nothing_judges() -> None:
    (step,) = WRITER.steps((located(After("x:e", some_time=True)),), {})
    assert isinstance(step.statement, stated.Text)
    assert step.statement.time is None


def test_a_choice_of_horizons_is_written_out_as_alternatives() -> None:
    (step,) = WRITER.steps((Exists(NAME, "then", LIMIT, LIMITS, (located(After("x:e")),)),), {})
    alternatives = " or ".join(f'{AT} for {seconds} seconds after event "x:e"' for seconds in (2, 3))
    assert step.text == f"( {alternatives} )"


def test_a_horizon_that_varies_is_no_column_of_an_outline() -> None:
    variation = Product((LIMIT,), ((1, 2),))
    assert outline(WRITER, (located(After("x:e")),), variation, ()) is None
