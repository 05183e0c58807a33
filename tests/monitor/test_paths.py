"""The length of a path, also of one that was observed with errors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from monitor.traces import STEP, still, trace_of
from robbdd_tools.judging.decisions import decide
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.monitor.paths import length_beyond_errors, path_length
from robbdd_tools.monitor.trace import OTHERS
from robbdd_tools.monitor.verdict import Verdict

PUSHED = '"arm" does not collide "bin" from "t:e" until "t:f"'
COUNT = 400


def noisy(points: Sequence[Sequence[float]], error: float) -> list[list[float]]:
    """Add errors to points, each of at most this length (m)."""
    random = np.random.default_rng(3)
    turns = random.normal(size=(len(points), 3))
    lengths = error * random.random((len(points), 1))
    return (np.asarray(points) + lengths * turns / np.linalg.norm(turns, axis=1)[:, None]).tolist()


def pushed_by(length: float) -> list[list[float]]:
    """Return the positions of a thing that stands, is pushed along x, and stands."""
    return [[length * min(max((row - 100) / 100, 0.0), 1.0), 0.0, 0.0] for row in range(COUNT)]


def judged(path: Sequence[Sequence[float]], uncertain: dict[str, float], log: str = "drive") -> Verdict:
    trace = trace_of(
        {"arm": still(len(path), (1.0, 1.0, 1.0)), "bin": path}, {"t:e": 0.0, "t:f": STEP * (len(path) - 1)}
    )
    return decide(read_clause(PUSHED), replace(trace, log=log, uncertain=uncertain), {}, {"t:e", "t:f"})


def test_a_path_is_the_sum_of_its_steps() -> None:
    assert path_length(np.array([[0, 0, 0], [3, 4, 0], [3, 4, 2.0]])).tolist() == [0.0, 5.0, 7.0]


def test_a_piece_counts_whole_and_a_turn_less_two_errors() -> None:
    there_and_back = np.array(
        [[0.0, 0, 0], [0.05, 0, 0], [1, 0, 0], [0.91, 0, 0], [0.79, 0, 0], [0.8, 0, 0], [3, 0, 0]]
    )
    assert length_beyond_errors(there_and_back, 0.05) == pytest.approx([0.0, 0.0, 0.9, 0.9, 1.01, 1.01, 3.22])


@pytest.mark.parametrize("error", [0.0005, 0.004])
@pytest.mark.parametrize("length", [0.0, 0.03, 0.2])
def test_errors_do_not_lengthen_a_path(length: float, error: float) -> None:
    observed = np.array(noisy(pushed_by(length), error))
    assert path_length(observed)[-1] > length + 100 * error
    measured = length_beyond_errors(observed, error)
    assert length - 4 * error <= measured[-1] <= 1.01 * length + 2 * error
    assert (np.diff(measured) >= 0.0).all()


def test_what_stands_has_no_path_however_its_errors_change() -> None:
    corners = np.array([[0.004 * (-1) ** row, 0.0, 0.0] for row in range(COUNT)])
    assert (length_beyond_errors(corners, 0.004) == 0.0).all()


def test_a_push_to_and_fro_counts_both_ways() -> None:
    there = pushed_by(0.1)
    observed = np.array(noisy([*there, *reversed(there)], 0.002))
    assert length_beyond_errors(observed, 0.002)[-1] == pytest.approx(0.2, abs=0.012)


def test_a_round_path_is_measured_along_its_curve() -> None:
    angles = np.linspace(0.0, 2.0 * np.pi, COUNT)
    circle = np.stack([0.1 * np.cos(angles), 0.1 * np.sin(angles), 0.0 * angles], axis=1).tolist()
    assert length_beyond_errors(np.array(noisy(circle, 0.002)), 0.002)[-1] == pytest.approx(0.2 * np.pi, rel=0.03)


@pytest.mark.parametrize(
    ("length", "outcome"), [(0.0, "holds"), (0.02, "holds"), (0.049, "unknown"), (0.051, "unknown"), (0.09, "violated")]
)
def test_a_push_is_judged_by_what_the_errors_leave(length: float, outcome: str) -> None:
    assert judged(noisy(pushed_by(length), 0.004), {OTHERS: 0.004}).outcome == outcome


def test_errors_that_are_not_stated_make_a_long_path_unknown() -> None:
    verdict = judged(noisy(pushed_by(0.0), 0.004), {})
    assert verdict.outcome == "unknown"
    assert "but it was never more than 7 mm from where it began: state the errors" in verdict.reason, verdict.reason
    assert "--uncertainty 'bin=3 mm'" in verdict.reason
    assert judged(noisy(pushed_by(0.2), 0.004), {}).outcome == "violated"


def test_short_errors_that_are_not_stated_count() -> None:
    assert judged(noisy(pushed_by(0.0), 0.00005), {}).outcome == "holds"


def test_a_simulated_thing_that_is_shaken_has_moved() -> None:
    shaken = [[0.01 * (row % 2), 0.0, 0.0] for row in range(int(2.0 / STEP))]
    assert judged(shaken, {}, log="").outcome == "violated"
    assert judged(shaken, {}).outcome == "unknown"
    assert judged(shaken, {OTHERS: 0.001}).outcome == "violated"
