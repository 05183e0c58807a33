"""Events that a model defines by conditions, found in traces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from monitor.traces import STEP, heights, still, trace_of
from robbdd_tools.judging.decisions import decide, is_closed, occurred
from robbdd_tools.judging.defined_events import FROM_START, with_defined_events
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.monitor.trace import OTHERS, EventStamp, Trace
from robbdd_tools.monitor.window_evidence import WindowEvidence
from robbdd_tools.protocol.clauses import DefinedEvent, Fluent

NEAR = '"a" is nearer than "50 cm" to "b"'
SLOW = '"a" moves slower than "3 m/s"'
LOW = [1.0, 0.8, 0.4, 0.4, 0.9, 0.9, 0.3, 0.3, 0.3]


def condition(words: str) -> Fluent:
    found = read_clause(f'{words} after event "t:near"')
    assert isinstance(found, Fluent)
    return found


def near(*words: str, seconds: float = 0.0) -> DefinedEvent:
    return DefinedEvent("t:near", tuple(map(condition, words or (NEAR,))), seconds)


def moving(values: list[float] = LOW, **events: float) -> Trace:
    count = len(values)
    return trace_of({"a": heights(values), "b": still(count)}, {f"t:{name}": time for name, time in events.items()})


def times(trace: Trace, *defined: DefinedEvent) -> list[float]:
    found = with_defined_events(trace, defined or (near(),), {})
    return [round(stamp.time, 3) for stamp in found.events if stamp.name == "t:near"]


def test_an_event_occurs_each_time_its_condition_becomes_true() -> None:
    assert times(moving()) == [0.2, 0.6]
    assert times(moving(), near(seconds=2 * STEP)) == [0.8]


def test_all_conditions_must_become_true() -> None:
    assert times(moving(), near(NEAR, SLOW)) == [0.3, 0.7]


def test_events_that_a_log_or_an_earlier_definition_stated_are_replaced() -> None:
    assert times(moving(near=0.05)) == [0.2, 0.6]


def test_a_condition_that_held_from_the_start_is_no_occurrence_and_the_reason_says_so() -> None:
    trace = with_defined_events(moving([0.3] * 9), (near(),), {})
    verdict = decide(read_clause(f'{NEAR} after event "t:near"'), trace, {}, {"t:near"})
    assert (verdict.outcome, verdict.reason) == ("unknown", f"event t:near never occurred: {FROM_START}")


@pytest.mark.parametrize(("row", "iteration"), [(2, 1), (6, 2)])
def test_an_occurrence_belongs_to_the_iteration_in_progress(row: int, iteration: int) -> None:
    stamps = (EventStamp("t:go", 0.1, 1), EventStamp("t:go", 0.5, 2))
    trace = with_defined_events(replace(moving(), events=stamps), (near(),), {})
    assert trace.event_time("t:near", iteration) == pytest.approx(row * STEP)
    of_tree = with_defined_events(replace(moving(), events=stamps), (near(),), {}, numbered=False)
    assert of_tree.event_time("t:near", iteration) == pytest.approx(2 * STEP)


def test_before_the_first_iteration_it_belongs_to_that() -> None:
    trace = replace(moving(), events=(EventStamp("t:go", 0.5, 1), EventStamp("t:go", 0.8, 2)))
    found = with_defined_events(trace, (near(),), {})
    assert [stamp.iteration for stamp in found.events if stamp.name == "t:near"] == [1, 1]


def log(hidden: list[int]) -> Trace:
    trace = moving(end=0.8)
    positions = trace.positions.copy()
    positions[hidden, trace.column("a")] = np.nan
    return replace(trace, positions=positions, log="drive")


def test_a_gap_in_a_log_makes_the_clause_unknown_and_never_true() -> None:
    clause = read_clause('"a" is nearer than "1 m" to "b" after event "t:near"')
    judged = decide(clause, with_defined_events(log([1]), (near(),), {}), {}, {"t:near"})
    assert judged.outcome == "unknown"
    assert judged.reason == (
        "it is not known whether event t:near occurred from 0.00 s to 0.20 s: "
        "a was not observed between 0.00 s and 0.20 s"
    )
    # After the first occurrence, a gap does not matter.
    late = with_defined_events(log([5]), (near(),), {})
    assert decide(clause, late, {}, {"t:near"}).outcome == "holds"
    every = read_clause('"a" is nearer than "1 m" to "b" after every event "t:near"')
    assert decide(every, late, {}, {"t:near"}).outcome == "unknown"


def test_an_awaited_event_that_may_have_occurred_is_unknown() -> None:
    assert occurred(with_defined_events(log([5]), (near(),), {}), "t:near", 0).at == pytest.approx(0.2)
    hidden = with_defined_events(log([1, 2, 3, 4, 5, 6, 7, 8]), (near(),), {})
    assert occurred(hidden, "t:near", 0).reason.startswith("it is not known whether event t:near occurred")


def test_a_margin_within_the_uncertainty_of_the_measurements_is_unknown() -> None:
    trace = replace(log([]), uncertain={OTHERS: 0.06})
    # 0.4 m is nearer than 0.5 m by 0.1 m, which is less than the errors of both positions.
    found = with_defined_events(trace, (near(),), {})
    assert [(doubt.since, doubt.until) for doubt in found.doubts] == [(0.1, pytest.approx(0.4))]
    assert [stamp.time for stamp in found.events if stamp.name == "t:near"] == [pytest.approx(0.6)]


def test_a_condition_about_something_that_the_trace_lacks_is_in_doubt_throughout() -> None:
    found = with_defined_events(moving(), (near('"a" is nearer than "50 cm" to "c"'),), {})
    assert [(doubt.since, doubt.until, doubt.reason) for doubt in found.doubts] == [
        (0.0, pytest.approx(0.8), "the trace has no record of 'c'")
    ]


def test_a_clause_is_open_as_long_as_its_event_may_still_occur() -> None:
    clause = read_clause(f'{NEAR} after event "t:near"')
    begun = replace(moving(LOW[:2]), finished=False)
    assert not is_closed(clause, with_defined_events(begun, (near(),), {}), {"t:near"})
    assert is_closed(clause, with_defined_events(replace(moving(LOW[:3]), finished=False), (near(),), {}), {"t:near"})


def test_where_a_workspace_is_is_asked_once_and_not_for_each_sample(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = list[str]()
    regions = WindowEvidence.regions

    def counted(self: WindowEvidence, workspace: str) -> object:
        asked.append(workspace)
        return regions(self, workspace)

    monkeypatch.setattr(WindowEvidence, "regions", counted)
    within = near('"a" is located at "t:ws"')
    found = with_defined_events(moving(), (within,), {"t:ws": ()})
    verdict = decide(read_clause(f'{NEAR} after event "t:near"'), found, {}, {"t:near"})
    assert "where t:ws is, is not known: state its box in a .scenex" in verdict.reason
    assert len(asked) < len(LOW)
