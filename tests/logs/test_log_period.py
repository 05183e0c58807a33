"""A period of a log says what the log says in it, also between two messages around its bounds."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from logs.bags import joints, text, transform, truth, wrench, write
from robbdd_tools.logs.joint_tracks import JointTrack, positions_at
from robbdd_tools.logs.log_contents import LogContents, Track, UnreadableLog
from robbdd_tools.logs.log_period import cut
from robbdd_tools.logs.open_log import read_log
from robbdd_tools.logs.transforms import poses_at


@given(st.integers(2, 30), st.floats(0, 0.9), st.floats(0.1, 1.0), st.integers(0, 2**32 - 1))
def test_the_poses_and_joints_of_a_period_are_those_of_the_log(count: int, low: float, width: float, seed: int) -> None:
    random = np.random.default_rng(seed)
    times = np.unique(random.uniform(0, 10, count))
    end = float(times[-1])
    begin, until = low * end, min(low + width, 1.0) * end
    turns = np.tile((1.0, 0.0, 0.0, 0.0), (len(times), 1))
    track = Track("map", times, random.normal(size=(len(times), 3)), turns)
    states = JointTrack(times, random.normal(size=len(times)), np.zeros(len(times)))
    whole = LogContents({"cup": track}, (), end, joints={"/j": {"q": states}})
    if not begin < until:
        return
    found = cut(whole, begin, until)
    asked = random.uniform(begin, until, 20)
    expected, _ = poses_at("cup", "map", whole.tracks, asked, 5.0)
    places, _ = poses_at("cup", "map", found.tracks, asked - begin, 5.0)
    assert places == pytest.approx(expected, abs=1e-6, nan_ok=True)
    known = positions_at(found.joints["/j"]["q"], asked - begin, 5.0)
    assert known == pytest.approx(positions_at(states, asked, 5.0), abs=1e-6, nan_ok=True)
    assert found.end == pytest.approx(until - begin)


def test_a_period_has_the_events_in_it_and_the_truth_before_it(tmp_path: Path) -> None:
    messages = [
        transform("bench", (1, 0, 0), stamp=0.5, topic="/tf_static"),
        *(transform("cup", (tick, 0, 0), stamp=1.0 + tick) for tick in range(6)),
        *(text(f"e{tick}", 1.0 + tick) for tick in range(6)),
        truth("/seen", True, 1.5),
        truth("/seen", False, 4.5),
        joints(["q"], [0.5], 6.0),
        wrench("/ft", (0, 0, 1), 6.0),
    ]
    log = read_log(write(tmp_path / "drive", messages))
    found = cut(log, 2.0, 4.0)
    assert [(one.text, one.time) for one in found.texts] == [("e2", 0.0), ("e3", 1.0), ("e4", 2.0)]
    assert found.truths["/seen"].times.tolist()[:2] == [-1.5, 1.5]
    assert found.tracks["bench"].static
    assert found.end == 2.0
    assert cut(log, 3.0, None).end == 2.0
    with pytest.raises(UnreadableLog, match=r"the log has nothing from 9 s on: it ends at 5\.00 s"):
        cut(log, 9.0, None)
