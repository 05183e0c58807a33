"""Curves of clauses, on traces made by hand; shapes of a world."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from judging.test_decisions import EVENTS, REGIONS, a_trace
from robbdd_tools.judging.margin_curves import behaviour_curves, curves, write_curves
from robbdd_tools.judging.parsed_sentences import read_clause, read_step
from robbdd_tools.protocol.clauses import BehaviourCall
from robbdd_tools.world.drawn_shapes import thinned


def least(sentence: str) -> list[tuple[float, bool]]:
    return [(min(one.margins), one.negated) for one in curves(read_clause(sentence), a_trace(), REGIONS)]


def test_a_set_counts_as_its_verdict_does() -> None:
    assert least('"[\'ball\', \'cube\']" is located at "left" after event "t:e"') == [(pytest.approx(-0.9), False)]
    assert least('"ball" is located at "any of [\'right\', \'left\']" after event "t:e"') == [
        (pytest.approx(0.08), False)
    ]


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
    assert document["events"] == [{"name": "t:e", "time": 0.2}]
    assert document["clauses"]["7"][0]["start"] == 0.2


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
