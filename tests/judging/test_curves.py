"""Curves of clauses, on traces made by hand; shapes of a world."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from judging.test_decisions import EVENTS, REGIONS, a_trace
from monitor.traces import still, trace_of
from robbdd_tools.catalog.api import Arguments, Evidence
from robbdd_tools.judging.decisions import decide
from robbdd_tools.judging.margin_curves import behaviour_curves, curves, write_curves
from robbdd_tools.judging.parsed_sentences import read_clause, read_step
from robbdd_tools.monitor.trace import EventStamp
from robbdd_tools.protocol.clauses import BehaviourCall, Fluent
from robbdd_tools.world.drawn_shapes import thinned


def least(sentence: str) -> list[tuple[float, bool]]:
    return [(min(one.margins), one.negated) for one in curves(read_clause(sentence), a_trace(), REGIONS)]


def test_a_set_counts_as_its_verdict_does() -> None:
    assert least('"[\'ball\', \'cube\']" is located at "left" after event "t:e"') == [(pytest.approx(-0.9), False)]
    assert least('"ball" is located at "any of [\'right\', \'left\']" after event "t:e"') == [
        (pytest.approx(0.08), False)
    ]


def test_elements_that_hold_at_different_times_have_the_curve_of_the_one_that_decides() -> None:
    away = (1.0, 0.0, 0.02)
    ball = [(0.0, 0.0, 0.02), *still(4, away)]
    cube = [*still(4, away), (0.0, 0.0, 0.01)]
    bins = {"bin1": still(5, (0.0, 0.0, 0.0)), "bin2": still(5, (1.0, 0.0, 0.0))}
    trace = trace_of({**bins, "ball": ball, "cube": cube}, {"t:e": 0.0})
    sentence = read_clause(
        '"[\'ball\', \'cube\']" is located at "left" at some time within 0.4 seconds after event "t:e"'
    )
    verdict = decide(sentence, trace, REGIONS, EVENTS.keys())
    assert verdict.robustness is not None
    assert verdict.robustness > 0
    (found,) = curves(sentence, trace, REGIONS)
    assert max(found.margins) == pytest.approx(verdict.robustness)
    assert min(found.margins) < 0


def test_where_a_condition_does_not_apply_the_curve_has_no_points() -> None:
    conditional = '"ball" is located at "right" whenever "cube" is located at "left" after event "t:e"'
    assert [one.times for one in curves(read_clause(conditional), a_trace(), REGIONS)] == [()]
    applies = '"ball" is located at "right" whenever "cube" is located at "right" after event "t:e"'
    assert least(applies) == [(pytest.approx(-0.9), False)]


def test_each_fluent_of_a_group_has_its_own_curve() -> None:
    both = 'not ( "ball" is located at "left" after event "t:e" and "ball" is held by "arm" after event "t:e" )'
    assert least(both) == [(pytest.approx(0.08), True), (1.0, True)]


@pytest.mark.parametrize(
    "sentence",
    [
        "the lamp is green",
        '"ball" is located at "any of []" after event "t:e"',
        '"ball" is located at "nowhere" after event "t:e"',
    ],
)
def test_what_cannot_be_judged_has_no_points(sentence: str) -> None:
    assert all(one.times == () for one in curves(read_clause(sentence), a_trace(), REGIONS))


def test_a_behaviour_lasts_from_its_first_event_to_its_last(tmp_path: Path) -> None:
    call = read_step("when", '"arm" picks "ball"')
    assert isinstance(call, BehaviourCall)
    assert behaviour_curves(call, a_trace(), {"t:x": "pick-start"}) == ()
    (found,) = behaviour_curves(call, a_trace(), EVENTS)
    assert (found.start, found.end) == (0.2, 0.2)
    write_curves(tmp_path / "margins" / "000000.json", ("t:v", 1), {7: (found,)}, a_trace())
    document = json.loads((tmp_path / "margins" / "000000.json").read_text(encoding="utf-8"))
    assert document == {
        "scenario": ["t:v", 1],
        "duration": pytest.approx(0.4),
        "remark": "",
        "events": [{"name": "t:e", "time": 0.2}],
        "clauses": {
            "7": [
                {
                    "start": 0.2,
                    "end": 0.2,
                    "reason": "",
                    "unit": "",
                    "negated": False,
                    "some_time": False,
                    "times": [],
                    "margins": [],
                }
            ]
        },
    }


PICK = 'picks "ball" and places it at "left"'
STAMPS = (
    EventStamp("t:late", 0.9, 2),
    EventStamp("t:e", 0.1, 1),
    EventStamp("t:later", 0.3, 1),
    EventStamp("t:e", 0.5, 2),
    EventStamp("t:x", 0.0),
)


def lasting(emitters: dict[str, str], node: str = "", iteration: int = 0) -> list[tuple[float | None, float | None]]:
    call = read_step("when", f'"arm" {PICK}')
    assert isinstance(call, BehaviourCall)
    trace = replace(a_trace(), events=STAMPS)
    return [(one.start, one.end) for one in behaviour_curves(call, trace, emitters, node, iteration)]


def test_a_behaviour_of_a_loop_lasts_as_long_as_its_iteration() -> None:
    emitters = {"t:e": "pick-start", "t:later": "place-end", "t:late": "place-end", "t:x": "scenario-start"}
    assert lasting(emitters) == [(0.1, 0.9)]
    assert lasting(emitters, iteration=1) == [(0.1, 0.3)]
    assert lasting(emitters, iteration=2) == [(0.5, 0.9)]
    assert lasting(emitters, iteration=3) == []


def test_a_behaviour_of_a_tree_lasts_from_the_start_of_its_node_to_its_end() -> None:
    emitters = {"t:e": "pick-start", "t:x": "t:node start", "t:later": "t:node end", "t:late": "t:other end"}
    assert lasting(emitters, "t:node") == [(0.0, 0.3)]


def test_events_are_written_in_the_order_of_their_times(tmp_path: Path) -> None:
    trace = replace(a_trace(), events=STAMPS, remark="gripper lost cube — at 0.10 s")
    path = tmp_path / "margins" / "000000.json"
    for _ in range(2):
        write_curves(path, ("t:v", 1), {}, trace)
    text = path.read_text(encoding="utf-8")
    assert [event["name"] for event in json.loads(text)["events"]] == ["t:x", "t:e", "t:later", "t:e", "t:late"]
    assert "gripper lost cube — at 0.10 s" in text
    assert text.endswith("}\n")


def test_a_unit_that_depends_on_the_trace_is_that_of_its_verdict() -> None:
    def unit(evidence: Evidence, arguments: Arguments) -> str:
        return f"{len(evidence.times)} {arguments['object']}"

    def no_unit(*_: object) -> str:
        raise KeyError("ball")

    for unit_for, expected in ((unit, "1 ball"), (no_unit, "m"), (None, "m")):
        clause = read_clause('"ball" is located at "left" after event "t:e"')
        assert isinstance(clause, Fluent)
        own = replace(clause, predicate=replace(clause.predicate, unit_for=unit_for))
        (found,) = curves(own, a_trace(), REGIONS)
        assert (found.unit, found.start, found.end) == (expected, 0.2, 0.2)


def unit_in_radians(*_: object) -> str:
    return "rad"


def test_an_empty_set_has_no_points_and_the_unit_of_its_predicate() -> None:
    clause = read_clause('"ball" is located at "any of []" after event "t:e"')
    assert isinstance(clause, Fluent)
    own = replace(clause, predicate=replace(clause.predicate, unit_for=unit_in_radians))
    (found,) = curves(own, a_trace(), REGIONS)
    assert (found.unit, found.times) == ("m", ())


def test_without_an_evaluator_there_are_no_points() -> None:
    clause = read_clause('"ball" is located at "left" after event "t:e"')
    assert isinstance(clause, Fluent)
    (found,) = curves(replace(clause, predicate=replace(clause.predicate, evaluate=None)), a_trace(), REGIONS, True)
    assert (found.times, found.negated) == ((), True)


def test_a_fine_mesh_is_thinned_out_within_its_bounds() -> None:
    steps = np.linspace(0, np.pi, 60)
    around, up = np.meshgrid(2 * steps, steps, indexing="ij")
    ball = np.stack([np.cos(around) * np.sin(up), np.sin(around) * np.sin(up), np.cos(up)], axis=-1).reshape(-1, 3)
    corner = (np.arange(59)[:, None] * 60 + np.arange(59)).reshape(-1)
    halves = [[corner, corner + 60, corner + 1], [corner + 60, corner + 61, corner + 1]]
    faces = np.concatenate([np.stack(half, axis=1) for half in halves])
    vertices, found = thinned(ball, faces, 12)
    assert 50 < len(found) < len(faces) / 3
    assert found.max() < len(vertices)
    assert np.abs(vertices).max() <= 1.0
    assert np.linalg.norm(vertices, axis=1).min() > 0.85
