"""Which joint of a log is which joint of an arm's model."""

from __future__ import annotations

import numpy as np
import pytest

from robbdd_tools.judging.joint_names import JointsProblem, joints_of, stated_joints, topic_of
from robbdd_tools.logs.joint_tracks import JointTrack

ARM = ("pan", "lift", "wrist_1")
STATE = JointTrack(np.zeros(1), np.zeros(1), np.zeros(1))


@pytest.mark.parametrize(
    ("logged", "expected"),
    [
        (("wrist_1", "lift", "pan", "finger"), ("pan", "lift", "wrist_1")),
        (("pan_joint", "lift_joint", "wrist_1_joint"), ("pan_joint", "lift_joint", "wrist_1_joint")),
        (("a_pan_q", "a_lift_q", "a_wrist_1_q", "pan_q"), ("a_pan_q", "a_lift_q", "a_wrist_1_q")),
        (("Pan", "LIFT", "wrist1"), ("Pan", "LIFT", "wrist1")),
        # The plain names win over those of a second arm with a prefix.
        (("pan", "lift", "wrist_1", "b_pan", "b_lift", "b_wrist_1"), ("pan", "lift", "wrist_1")),
        # Of two arms with a prefix, one has the name of the agent.
        (("left_pan", "left_lift", "left_wrist_1", "r_pan", "r_lift", "r_wrist_1"), ("left_pan", "left_lift")),
    ],
)
def test_joints_have_one_prefix_and_one_suffix(logged: tuple[str, ...], expected: tuple[str, ...]) -> None:
    found = joints_of("cell:left", ARM, logged, {})
    assert tuple(found[joint] for joint in ARM)[: len(expected)] == expected


@pytest.mark.parametrize(
    ("logged", "given", "words"),
    [
        (("pan", "lift"), {}, "the log has no joint 'wrist_1' of cell:left; it has: lift, pan; name it with --joint"),
        (("pan", "lift", "wrist1x"), {}, "the log has no joint 'pan', 'lift', 'wrist_1' of cell:left"),
        (("r_pan", "r_lift", "r_wrist_1", "s_pan", "s_lift", "s_wrist_1"), {}, "several joints fit 'pan' of cell:left"),
        (("pan", "lift", "wrist_1"), {"pan": "pam"}, "the log has no joint 'pam' for 'pan' of cell:left; nearest: pan"),
    ],
)
def test_joints_that_do_not_fit_are_named(logged: tuple[str, ...], given: dict[str, str], words: str) -> None:
    with pytest.raises(JointsProblem) as caught:
        joints_of("cell:left", ARM, logged, given)
    assert words in str(caught.value)


def test_stated_joints_complete_the_others() -> None:
    given = stated_joints("cell:left", ARM, {"left/pan": "q0", "lift": "q1", "right/wrist_1": "q9"})
    assert given == {"pan": "q0", "lift": "q1"}
    assert joints_of("cell:left", ARM, ("q0", "q1", "wrist_1_joint"), given)["wrist_1"] == "wrist_1_joint"


@pytest.mark.parametrize(
    ("topics", "stated", "expected"),
    [
        (("/joint_states", "/left/states", "/right/joint_states"), {}, "/left/states"),
        (("/joint_states", "/commands"), {}, "/joint_states"),
        (("/commands",), {}, "/commands"),
        (("/a/joint_states", "/b/joint_states"), {"cell:left": "b/joint_states"}, "/b/joint_states"),
        (("/a/joint_states", "/b/joint_states"), {}, "several topics have the joints of cell:left"),
        (("/a/joint_states",), {"cell:left": "/c"}, "the log has no joint states on '/c' for cell:left"),
    ],
)
def test_the_topic_of_an_arm_is_its_own_or_the_usual_one(
    topics: tuple[str, ...], stated: dict[str, str], expected: str
) -> None:
    logged = {topic: {"pan_joint": STATE} for topic in topics}
    if expected.startswith("/"):
        assert topic_of("cell:left", ARM, logged, stated, {}) == expected
        return
    with pytest.raises(JointsProblem, match=expected):
        topic_of("cell:left", ARM, logged, stated, {})


def test_a_topic_without_a_joint_of_the_arm_is_not_its_topic() -> None:
    with pytest.raises(JointsProblem, match="the log has no joint of cell:left; it has: wheel; name each with --joint"):
        topic_of("cell:left", ARM, {"/joint_states": {"wheel": STATE}}, {}, {})
    assert topic_of("cell:left", ARM, {"/q": {"actual_q_0": STATE}}, {}, {"pan": "actual_q_0"}) == "/q"
