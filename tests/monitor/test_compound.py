"""Defined predicates, against a definition of Kleene logic sample by sample that shares no code with the monitor."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isnan, nan
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from monitor.traces import STEP, still, trace_of
from robbdd_tools.catalog.api import Kind, Predicate, Slot
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.compound import compound_predicate
from robbdd_tools.monitor.judge import judge
from robbdd_tools.monitor.predicate_definitions import Combination, Definition, Operand, Passed
from robbdd_tools.monitor.time import During
from robbdd_tools.monitor.verdict import Outcome, Verdict
from robbdd_tools.protocol.plain_predicates import plain_predicate, predicate_of

SIZE = 4
VALUES = st.lists(st.sampled_from([2.0, 0.5, 0.0, -0.5, -2.0, nan]), min_size=SIZE, max_size=SIZE)
WHOLE = During("start", "end")
SOME_TIME = During("start", "end", some_time=True)


@dataclass(frozen=True)
class Fixed:
    """A predicate with given margins."""

    margins: tuple[float, ...]

    def __call__(self, _evidence: Any, _arguments: Mapping[str, Any]) -> Any:
        return np.array(self.margins)


def leaf(name: str, margins: list[float], unit: str) -> Operand:
    slot = Slot("thing", Kind.OBJECT, "")
    sentence = f'"{{thing}}" is {name}'
    predicate = Predicate(name, "", "", (slot,), sentence, unit, "", Fixed(tuple(margins)))
    return Operand(predicate, {"thing": Passed("part")})


def judged(definition: Definition, constraint: Any = WHOLE, condition: Definition | None = None) -> Verdict:
    trace = trace_of({"bolt": still(SIZE)}, {"start": 0.0, "end": (SIZE - 1) * STEP})
    predicate = compound_predicate("own", 'own "{part}"', ("part",), definition)
    other = None if condition is None else (compound_predicate("c", "c", ("part",), condition), {"part": "bolt"})
    return judge(predicate, {"part": "bolt"}, constraint, trace, {}, other)


def truth(definition: Definition, row: int) -> bool | None:
    """The strong Kleene truth at one sample."""
    if isinstance(definition, Operand):
        assert isinstance(definition.predicate.evaluate, Fixed)
        margin = definition.predicate.evaluate.margins[row]
        return None if isnan(margin) else margin >= 0
    found = [truth(one, row) for one in definition.operands]
    if definition.operator == "not":
        return None if found[0] is None else not found[0]
    decisive = definition.operator == "or"
    if decisive in found:
        return decisive
    return None if None in found else not decisive


def value(definition: Definition, row: int) -> float:
    """The margin at one sample, if all margins have one unit; ``nan`` if one of them is unknown."""
    if isinstance(definition, Operand):
        assert isinstance(definition.predicate.evaluate, Fixed)
        return definition.predicate.evaluate.margins[row]
    found = [value(one, row) for one in definition.operands]
    # The smallest of numbers of which one is nan depends on their order.
    if any(map(isnan, found)):
        return nan
    return -found[0] if definition.operator == "not" else min(found) if definition.operator == "and" else max(found)


@st.composite
def definitions(draw: st.DrawFn, units: tuple[str, ...] = ("m", "m/s", "")) -> Definition:
    one = st.builds(leaf, st.sampled_from(["red", "dry", "far"]), VALUES, st.sampled_from(units))

    def groups(inner: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
        several = st.lists(inner, min_size=2, max_size=3).map(tuple)
        joined = st.builds(Combination, st.sampled_from(["and", "or"]), several)
        return st.one_of(joined, st.builds(Combination, st.just("not"), st.tuples(inner)))

    return draw(st.recursive(one, groups, max_leaves=5))


def outcome_of(truths: list[bool | None], *, some_time: bool) -> Outcome:
    decisive, other = (Outcome.HOLDS, Outcome.VIOLATED) if some_time else (Outcome.VIOLATED, Outcome.HOLDS)
    if some_time in truths:
        return decisive
    return Outcome.UNKNOWN if None in truths else other


@given(definitions())
def test_the_time_constraint_applies_to_the_truth_at_each_sample(definition: Definition) -> None:
    truths = [truth(definition, row) for row in range(SIZE)]
    assert judged(definition).outcome is outcome_of(truths, some_time=False)
    assert judged(definition, SOME_TIME).outcome is outcome_of(truths, some_time=True)


@given(definitions(), definitions())
def test_a_definition_may_be_a_condition(definition: Definition, condition: Definition) -> None:
    found = judged(definition, WHOLE, condition)
    implied = [
        True if held is True or applies is False else False if held is False and applies else None
        for held, applies in ((truth(definition, row), truth(condition, row)) for row in range(SIZE))
    ]
    assert found.outcome is outcome_of(implied, some_time=False)


@given(definitions(("m",)))
def test_margins_of_one_unit_are_the_smallest_and_the_largest(definition: Definition) -> None:
    if any(truth(definition, row) is None or isnan(value(definition, row)) for row in range(SIZE)):
        return
    values = [value(definition, row) for row in range(SIZE)]
    for constraint, expected in ((WHOLE, min(values)), (SOME_TIME, max(values))):
        found = judged(definition, constraint)
        same = [one for one in values if truth(definition, values.index(one)) is (found.outcome is Outcome.HOLDS)]
        assert found.robustness == pytest.approx(expected if expected in same else 0.0, abs=1e-300)
        assert found.unit == "m"


@given(definitions())
def test_the_margin_is_that_of_one_predicate_at_one_sample(definition: Definition) -> None:
    found = judged(definition)
    if found.outcome is Outcome.UNKNOWN:
        return
    assert found.robustness is not None
    assert (found.robustness >= 0) is (found.outcome is Outcome.HOLDS)
    assert "decided by: bolt is " in found.reason


def test_throughout_a_or_b_is_not_throughout_one_of_them() -> None:
    one, other = leaf("red", [1, 1, -1, -1], "m"), leaf("dry", [-1, -1, 1, 1], "m")
    found = judged(Combination("or", (one, other)))
    assert (found.outcome, found.robustness) == (Outcome.HOLDS, 1.0)
    assert judged(one).outcome is judged(other).outcome is Outcome.VIOLATED


def test_at_some_time_a_and_b_needs_both_at_the_same_sample() -> None:
    one, other = leaf("red", [1, 1, -1, -1], "m"), leaf("dry", [-1, -1, 1, 1], "m")
    assert judged(Combination("and", (one, other)), SOME_TIME).outcome is Outcome.VIOLATED


def test_a_margin_of_zero_is_true_and_its_negation_false() -> None:
    zero = leaf("red", [0, 0, 0, 0], "m")
    assert judged(zero).outcome is Outcome.HOLDS
    assert judged(Combination("not", (zero,))).outcome is Outcome.VIOLATED
    assert judged(Combination("not", (Combination("not", (zero,)),))).outcome is Outcome.HOLDS


def test_the_operand_that_decides_is_named_with_its_unit_and_its_instant() -> None:
    near, slow = leaf("near", [1, 1, -2, -3], "cm"), leaf("slow", [1, -5, 1, 1], "m/s")
    found = judged(Combination("and", (slow, near)))
    assert (found.robustness, found.unit) == (-5.0, "m/s")
    assert found.at == found.worst_at
    assert found.reason == "decided by: bolt is slow"
    later = judged(Combination("and", (leaf("slow", [1, 1, 1, 1], "m/s"), near)))
    assert (later.robustness, later.unit) == (-3.0, "cm")
    assert later.reason == f"decided by: bolt is near, at {later.worst_at:.2f} s"


def test_a_margin_in_a_unit_says_more_than_one_without() -> None:
    held, near = leaf("held", [1, 1, 1, 1], ""), leaf("near", [0.3, 0.2, 0.4, 0.9], "m")
    found = judged(Combination("and", (held, near)))
    assert (found.robustness, found.unit) == (0.2, "m")


def test_lengths_in_two_units_are_compared() -> None:
    found = judged(Combination("and", (leaf("near", [5.0] * 4, "cm"), leaf("far", [0.01] * 4, "m"))))
    assert (found.robustness, found.unit) == (0.01, "m")


@given(definitions())
def test_a_predicate_is_the_same_after_the_manifest(definition: Definition) -> None:
    known = load_catalog().predicates["located-at"]

    def of_catalog(part: Definition) -> Definition:
        if isinstance(part, Combination):
            return Combination(part.operator, tuple(map(of_catalog, part.operands)))
        return Operand(known, {"object": Passed("part"), "workspace": "t:bench"})

    predicate = compound_predicate("own", 'own "{part}"', ("part",), of_catalog(definition))
    assert predicate_of(plain_predicate(predicate)) == predicate
