"""Then clauses that held before the behaviour began."""

from __future__ import annotations

from dataclasses import replace

import pytest

from monitor.traces import heights, still, trace_of
from robbdd_tools.catalog.api import Region
from robbdd_tools.judging.margin_ranges import margin_ranges
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.judging.scenario_clauses import judged_clause
from robbdd_tools.monitor.trace import EventStamp, Trace
from robbdd_tools.protocol.specs import ClauseSpec
from world.worlds import EVENTS, PANDA, scenario

REGIONS = {"ws": (("bin", Region((0.0, 0.0, 0.0), (0.1, 0.1, 0.1))),)}
STAMPS = (
    EventStamp("t:pick-start", 0.1, 1),
    EventStamp("t:place-end", 0.2, 1),
    EventStamp("t:pick-start", 0.3, 2),
    EventStamp("t:place-end", 0.4, 2),
)
INSIDE = '"ball" is located at "ws"'


def a_trace(ball: list[float]) -> Trace:
    return replace(trace_of({"bin": still(6), "ball": heights(ball)}), events=STAMPS)


def held(sentence: str, ball: list[float], role: str = "then", iterations: tuple[int, ...] = ()) -> bool | None:
    whens = tuple(
        ClauseSpec(line, "t:w", "w", "when", f'"{PANDA}" picks "ball" and places it at "ws"') for line in (1, 2)
    )
    stated = ClauseSpec(3, "t:c", "c", role, sentence, iterations=iterations)
    spec = scenario(clauses=(*whens, stated), events=EVENTS)
    assert read_clause(sentence)
    found = margin_ranges(0, judged_clause(read_clause(sentence), stated, spec), stated, spec, a_trace(ball), REGIONS)
    return None if found is None else found.held_before


@pytest.mark.parametrize(
    ("ball", "iterations", "expected"),
    [
        ([0.0, 0.0, 0.0, 0.0, 0.0, 0.0], (), True),
        ([1.0, 1.0, 0.0, 0.0, 0.0, 0.0], (), False),
        ([0.0, 0.0, 1.0, 1.0, 1.0, 1.0], (), False),
        ([1.0, 1.0, 0.0, 0.0, 0.0, 0.0], (2, 2), True),
        ([1.0, 1.0, 0.0, 0.0, 0.0, 0.0], (1, 2), False),
    ],
)
def test_what_is_so_after_a_behaviour_may_have_been_so_before(
    ball: list[float], iterations: tuple[int, ...], expected: bool
) -> None:
    assert held(f'{INSIDE} after event "t:place-end"', ball, iterations=iterations) is expected


def test_a_negation_is_judged_as_a_whole() -> None:
    sentence = f'not ( {INSIDE} after event "t:place-end" )'
    assert held(sentence, [1.0] * 6) is True
    assert held(sentence, [0.0, 0.0, 1.0, 1.0, 1.0, 1.0]) is False


@pytest.mark.parametrize(
    ("sentence", "role"),
    [
        (f'{INSIDE} from "t:pick-start" until "t:place-end"', "then"),
        (f'{INSIDE} before event "t:pick-start"', "given"),
        ('"panda" can reach "ball" after event "t:place-end"', "then"),
        ('the lamp is green after event "t:place-end"', "then"),
    ],
)
def test_nothing_is_said_of_intervals_givens_and_what_is_not_recorded(sentence: str, role: str) -> None:
    assert held(sentence, [0.0] * 6, role) is None
