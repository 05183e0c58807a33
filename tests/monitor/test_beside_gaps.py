"""A gap in a log leaves a clause unknown only if what was observed does not decide it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from monitor.traces import still, trace_of
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.judge import judge
from robbdd_tools.monitor.time import During
from robbdd_tools.monitor.verdict import Outcome, Verdict

GAP = "cup was not observed between 0.10 s and 0.40 s"


def judged(distances: list[float], some_time: bool, log: str = "drive", words: str = "is-nearer-than") -> Verdict:
    """Judge the distance of a cup from a bin, every 0.1 s; it was not observed at 0.2 and 0.3 s."""
    places = [[distance, 0.0, 0.0] for distance in distances]
    trace = trace_of({"cup": places, "bin": still(len(places))}, {"t:a": 0.0, "t:b": (len(places) - 1) * 0.1})
    positions = trace.positions.copy()
    positions[2:4, trace.column("cup")] = np.nan
    arguments = {"one": "cup", "other": "bin", "distance": "0.5 m"}
    constraint = During("t:a", "t:b", some_time=some_time)
    return judge(
        load_catalog().predicates[words], arguments, constraint, replace(trace, positions=positions, log=log), {}
    )


@pytest.mark.parametrize(
    ("distances", "some_time", "outcome"),
    [
        ([0.1, 0.1, 9, 9, 0.1, 0.1], True, Outcome.HOLDS),
        ([0.9, 0.9, 9, 9, 0.9, 0.1], True, Outcome.HOLDS),
        ([0.9, 0.9, 9, 9, 0.9, 0.9], True, Outcome.UNKNOWN),
        ([0.1, 0.1, 9, 9, 0.1, 0.1], False, Outcome.UNKNOWN),
        ([0.1, 0.1, 9, 9, 0.1, 0.9], False, Outcome.VIOLATED),
        ([0.9, 0.1, 9, 9, 0.1, 0.1], False, Outcome.VIOLATED),
    ],
)
def test_what_was_observed_decides_where_nothing_in_the_gap_could(
    distances: list[float], some_time: bool, outcome: Outcome
) -> None:
    verdict = judged(distances, some_time)
    assert verdict.outcome is outcome
    assert verdict.reason.endswith(GAP)
    if outcome is not Outcome.UNKNOWN:
        assert verdict.robustness == pytest.approx(0.4 if some_time else -0.4)


def test_a_trace_of_a_simulation_has_no_gaps() -> None:
    assert judged([0.1] * 6, True, log="").outcome is not Outcome.UNKNOWN
