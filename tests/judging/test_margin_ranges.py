"""Margin ranges of the clauses in an execution."""

from __future__ import annotations

from dataclasses import replace

import pytest

from judging.test_decisions import EVENTS, REGIONS, a_trace
from monitor.traces import heights, trace_of
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.judging.decisions import ranges
from robbdd_tools.judging.margin_ranges import margin_ranges
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.judging.quantities import fluents_with_quantity
from robbdd_tools.monitor.time import After
from robbdd_tools.monitor.trace import EventStamp, Trace
from robbdd_tools.protocol.clauses import AnyOf, Fluent
from robbdd_tools.protocol.messages import MarginRanges
from robbdd_tools.protocol.specs import ClauseSpec
from world.worlds import scenario

HELD = '"ball" is held by "arm" after event "t:e"'
LEFT = '"ball" is located at "left" after event "t:e"'
STATED = ClauseSpec(7, "t:c", "c", "then", HELD)


def reported(sentence: str, trace: Trace, stated: ClauseSpec = STATED, node: str = "") -> MarginRanges | None:
    spec = replace(scenario(clauses=(stated,), events={**EVENTS, "t:tree": "t:node start"}), node=node)
    return margin_ranges(4, read_clause(sentence), stated, spec, trace, REGIONS)


def test_ranges_are_those_of_each_fluent_by_scenario_and_line() -> None:
    found = reported(f"( {HELD} and {LEFT} )", a_trace())
    assert found is not None
    assert (found.index, found.line) == (4, 7)
    assert found.ranges == ((1.0, 1.0), (pytest.approx(0.08), pytest.approx(0.08)))


def test_a_range_is_that_of_all_members_of_a_set() -> None:
    found = ranges(read_clause('"[\'ball\', \'cube\']" is located at "left" after event "t:e"'), a_trace(), REGIONS)
    assert found == ((pytest.approx(-0.9), pytest.approx(0.08)),)


def test_nothing_is_said_of_what_is_not_recorded_or_was_never_reached() -> None:
    assert reported("the lamp is green", a_trace()) is None
    assert reported('"ghost" is held by "arm" after event "t:e"', a_trace()) is None
    assert reported(HELD, replace(a_trace(), unreached="the tree failed before")) is None


def test_an_evaluator_that_fails_has_no_range() -> None:
    def fail(*_: object) -> None:
        raise ZeroDivisionError

    clause = read_clause(HELD)
    assert isinstance(clause, Fluent)
    broken = replace(clause, predicate=replace(clause.predicate, evaluate=fail))
    assert ranges(broken, a_trace(), REGIONS) == ()


def begun(ball: list[float], *behaviours: str, iterations: tuple[int, ...] = ()) -> bool | None:
    """Return the message for a ball at some heights over the left bin; pick-start at 0.1 s, place-start at 0.2 s."""
    calls = tuple(ClauseSpec(line, f"t:w{line}", f"w{line}", "when", text) for line, text in enumerate(behaviours))
    stated = replace(STATED, iterations=iterations)
    events = {"t:pick": "pick-start", "t:place": "place-start", "t:e": "place-end"}
    stamps = (EventStamp("t:pick", 0.1), EventStamp("t:place", 0.2), EventStamp("t:e", 0.3))
    still = heights([0.0] * len(ball))
    trace = replace(trace_of({"ball": heights(ball), "bin1": still, "bin2": still}), events=stamps)
    spec = scenario(clauses=(*calls, stated), events=events)
    found = margin_ranges(4, read_clause(LEFT), stated, spec, trace, REGIONS)
    return None if found is None else found.held_before


def test_a_clause_is_compared_with_the_beginning_of_its_behaviour() -> None:
    pick, place = '"arm" picks "ball"', '"arm" places "ball" at "left"'
    assert begun([9, 0, 9, 0], pick, place) is True
    assert begun([9, 9, 0, 0], pick, place) is False
    assert begun([9, 0, 9, 0], place, pick) is False
    assert begun([9, 9, 0, 0], place, pick) is True
    assert begun([9, 0, 9, 0], pick, iterations=(1,)) is True
    assert begun([9, 0, 9, 0], pick, iterations=(2,)) is None


def held_before(ball: list[float], node: str, sentence: str = LEFT, role: str = "then") -> bool | None:
    """Return the message for a ball at some heights over the left bin; node at 0.1 s, event at 0.3 s."""
    events = (EventStamp("t:tree", 0.1), EventStamp("t:e", 0.3))
    still = heights([0.0] * len(ball))
    trace = replace(trace_of({"ball": heights(ball), "bin1": still, "bin2": still}), events=events)
    found = reported(sentence, trace, replace(STATED, role=role), node)
    return None if found is None else found.held_before


def test_a_clause_of_a_tree_is_compared_with_the_beginning_of_its_node() -> None:
    assert held_before([9, 0, 0, 0], "t:node") is True
    assert held_before([0, 9, 0, 0], "t:node") is False
    assert held_before([0, 0, 0, 9], "t:node") is False
    assert held_before([0, 0, 0, 0], "t:other") is None


@pytest.mark.parametrize(
    ("sentence", "role"),
    [
        (LEFT, "given"),
        (f'( {LEFT} and "ball" is located at "left" from "t:tree" until "t:e" )', "then"),
        (f'( {LEFT} and "arm" does not drop "ball" after event "t:e" )', "then"),
        (f'( {LEFT} and "ball" has config "mass" = "1" after event "t:e" )', "then"),
    ],
)
def test_only_a_result_is_compared_with_the_beginning(sentence: str, role: str) -> None:
    assert held_before([0, 0, 0, 0], "t:node", sentence, role) is None


def test_a_scenario_without_behaviour_has_no_beginning() -> None:
    assert held_before([0, 0, 0, 0], "") is None


def test_a_quantity_is_wanted_for_every_choice_of_single_elements() -> None:
    reach = load_catalog().predicates["can-reach"]
    clause = Fluent(reach, {"agent": AnyOf(("a", "b")), "object": ("x", "y")}, After("t:e"))
    (quantity,) = reach.quantities
    assert [dict(words) for _, words in fluents_with_quantity(clause, quantity)] == [
        {"agent": "a", "object": "x"},
        {"agent": "a", "object": "y"},
        {"agent": "b", "object": "x"},
        {"agent": "b", "object": "y"},
    ]
    assert all(fluent is clause for fluent, _ in fluents_with_quantity(clause, quantity))
    assert list(fluents_with_quantity(clause, "another quantity")) == []
