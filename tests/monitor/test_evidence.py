"""What an evaluator reads of the samples of a window."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from monitor.traces import still, trace_of
from robbdd_tools.base.articulation import OpeningRecord
from robbdd_tools.monitor.judge import WindowEvidence
from robbdd_tools.monitor.time import Window
from robbdd_tools.monitor.trace import Trace

POSITIONS = {
    "arm": still(5),
    "cube": [[0.0, 1.0, 0.0], [0.1, 1.0, 0.0], [0.3, 1.0, 0.0], [0.3, 1.0, 0.2], [0.3, 0.5, 0.2]],
}
"""One sample every 0.1 s."""
OUTLINE = (((0.0, 0.0, 0.1), 0.2),)


def a_trace() -> Trace:
    trace = trace_of(POSITIONS, grips={"arm": {"cube": [0, 0, 1, 1, 0]}})
    orientations = np.arange(40.0).reshape(5, 2, 4)
    return replace(
        trace,
        orientations=orientations,
        reaches={("arm", "cube"): np.array([0.5, 0.4, 0.3, 0.2, 0.1])},
        forces={("arm", "cube"): np.array([0.0, 1.0, 2.0, 3.0, 4.0])},
        watched=("arm",),
        settings={("arm", "speed"): "slow"},
        immovable=("arm",),
        contents={"shelf": ("upper", "lower")},
        outlines={"cube": OUTLINE},
    )


def evidence(first: int = 1, last: int = 3) -> WindowEvidence:
    return WindowEvidence(a_trace(), Window(first, last), {"shelf": [], "bin": []})


def test_poses_are_those_of_the_window() -> None:
    assert evidence().times == pytest.approx([0.1, 0.2, 0.3])
    assert evidence().position("cube").tolist() == POSITIONS["cube"][1:4]
    assert evidence().orientation("cube")[:, 0].tolist() == [12.0, 20.0, 28.0]
    assert evidence().gripped("arm", "cube").tolist() == [0.0, 1.0, 1.0]
    assert evidence().reach("arm", "cube").tolist() == [0.4, 0.3, 0.2]


def test_a_velocity_is_the_mean_since_the_sample_before() -> None:
    assert evidence().velocity("cube") == pytest.approx(np.array([[1.0, 0, 0], [2.0, 0, 0], [0, 0, 2.0]]))


def test_the_first_sample_has_the_velocity_until_the_next() -> None:
    assert evidence(0, 1).velocity("cube") == pytest.approx(np.array([[1.0, 0, 0], [1.0, 0, 0]]))


def test_a_single_sample_has_no_velocity() -> None:
    found = WindowEvidence(trace_of({"cube": still(1)}), Window(0, 0), {}).velocity("cube")
    assert found.shape == (1, 3)
    assert np.isnan(found).all()


def test_two_samples_have_a_velocity() -> None:
    trace = trace_of({"cube": [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0]]})
    assert WindowEvidence(trace, Window(0, 1), {}).velocity("cube") == pytest.approx(np.array([[1.0, 0, 0]] * 2))


def test_a_pose_at_a_time_is_that_of_the_last_sample_before() -> None:
    times = np.array([-0.1, 0.0, 0.15, 0.2, 0.2 - 1e-12, 0.9])
    assert evidence().position_at("cube", times)[:, 0].tolist() == [0.0, 0.0, 0.1, 0.3, 0.3, 0.3]
    assert evidence().orientation_at("cube", times)[:, 0].tolist() == [4.0, 4.0, 12.0, 20.0, 20.0, 36.0]


def test_forces_of_a_watched_agent_are_zero_where_it_touched_nothing() -> None:
    assert evidence().force("arm", "cube").tolist() == [1.0, 2.0, 3.0]
    assert evidence().force("arm", "arm").tolist() == [0.0, 0.0, 0.0]


@pytest.mark.parametrize(("agent", "name"), [("arm", "ghost"), ("cube", "arm"), ("ghost", "ghost")])
def test_forces_that_nobody_recorded_are_not_known(agent: str, name: str) -> None:
    with pytest.raises(KeyError, match=f"contact forces of {agent} on {name}"):
        evidence().force(agent, name)


def test_what_the_trace_says_of_the_scene() -> None:
    assert (evidence().is_immovable("arm"), evidence().is_immovable("cube")) == (True, False)
    assert evidence().contents("shelf") == ("upper", "lower")
    assert evidence().contents("bin") == ()
    assert evidence().setting("arm", "speed") == "slow"
    assert evidence().outline("cube") == OUTLINE
    assert evidence().workspaces == ("shelf", "bin")


def test_a_missing_record_of_a_pair_names_both() -> None:
    with pytest.raises(KeyError, match="arm colour"):
        evidence().setting("arm", "colour")
    with pytest.raises(KeyError, match="arm ghost"):
        evidence().reach("arm", "ghost")


def test_the_arrays_of_a_trace_are_read_only() -> None:
    drawer = OpeningRecord("slide", 0.0, 0.1, np.zeros(2))
    pair = {("a", "b"): np.zeros(2)}
    own = np.zeros(2)
    trace = replace(
        trace_of({"a": [[0.0, 0.0, 0.0]] * 2}, {}),
        grips={"r": np.zeros((2, 1))},
        reaches=pair,
        forces=pair,
        impulses=pair,
        touches=pair,
        gaps=pair,
        truths={"/t": own},
        joint_clearances={"r": np.zeros(2)},
        openings={"d": drawer, "e": "two joints"},
    )
    record = trace.openings["d"]
    assert isinstance(record, OpeningRecord)
    arrays = [trace.times, trace.positions, trace.orientations, record.positions]
    for kept in ("grips", "reaches", "forces", "impulses", "touches", "gaps", "truths", "joint_clearances"):
        arrays += getattr(trace, kept).values()
    assert len(arrays) == 12
    for array in arrays:
        with pytest.raises(ValueError, match="read-only"):
            array += 1.0
    own += 1.0


def test_a_sample_by_itself_has_the_poses_of_its_bodies() -> None:
    found = a_trace().sample(2)
    assert found.time == pytest.approx(0.2)
    assert found.positions == {"arm": (0.0, 0.0, 0.0), "cube": (0.3, 1.0, 0.0)}
    assert found.orientations == {"arm": (16.0, 17.0, 18.0, 19.0), "cube": (20.0, 21.0, 22.0, 23.0)}


def test_a_trace_ends_with_its_last_sample() -> None:
    assert a_trace().end == pytest.approx(0.4)
    assert trace_of({}).end == 0.0
