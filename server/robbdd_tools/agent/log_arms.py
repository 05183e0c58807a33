"""Compute tool poses and distances from joint limits of the arms whose joints a log reports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.judging.joint_names import JointsProblem, joint_words, joints_of, stated_joints, topic_of
from robbdd_tools.logs.joint_tracks import JointTrack, positions_at
from robbdd_tools.logs.log_names import NoElement, elements_of
from robbdd_tools.world.arm_kinematics import Arm, arm_of
from robbdd_tools.world.engine import mujoco

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray, RobotModel
    from robbdd_tools.logs.log_contents import LogContents
    from robbdd_tools.protocol.log_request import LogRequest
    from robbdd_tools.world.cast import Cast

IMPOSSIBLE = np.pi
"""Positions farther (rad) beyond a limit are in another unit: no arm turns half a turn past its stop."""


@dataclass(frozen=True, slots=True)
class LoggedArm:
    """An arm and the states of its joints in a log, in the order of the model's joints.

    ``names`` are the joints in the log, in the same order.
    """

    arm: Arm
    topic: str
    names: tuple[str, ...]
    tracks: tuple[JointTrack, ...]

    def positions(self, times: FloatArray, max_gap: float) -> FloatArray:
        """Return the joint positions at ``times`` (n,) s, in rad or m, shape (n, joints); NaN where unobserved."""
        limits = zip(self.tracks, self.arm.limited, self.arm.turning, strict=True)
        found = [
            positions_at(track, times, max_gap, wraps=turning and not limited) for track, limited, turning in limits
        ]
        return np.stack(found, axis=1)

    def tool(self, positions: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the tool's poses in the frame of the base: (n, 3) m, and (n, 4) quaternions, w first."""
        places, turns = np.full((len(positions), 3), np.nan), np.full((len(positions), 4), np.nan)
        turn = np.empty(4)
        for row in np.flatnonzero(np.isfinite(positions).all(axis=1)):
            places[row], rotation = self.arm.forward(positions[row])
            mujoco.mju_mat2Quat(turn, rotation.ravel())
            turns[row] = turn
        return places, turns

    def clearance(self, positions: FloatArray) -> FloatArray | None:
        """Return the smallest distance of the arm's joints from a limit, as a share of the joint's range, shape (n,).

        It is NaN where a joint was not observed. Returns ``None`` for an arm without limited joints.
        """
        limited = np.array(self.arm.limited)
        if not limited.any():
            return None
        lower, upper, known = self.arm.lower[limited], self.arm.upper[limited], positions[:, limited]
        shares = (np.minimum(known - lower, upper - known) / (upper - lower)).min(axis=1)
        return np.where(np.isnan(positions).any(axis=1), np.nan, shares)


def find_arms(cast: Cast, contents: LogContents, request: LogRequest, remarks: list[str]) -> dict[str, LoggedArm]:
    """Return the arms of a scene whose joints a log reports, by agent.

    For each arm whose joints are not known, ``remarks`` gets a sentence with the reason and the fix. Raises
    ``NoElement`` if the request names an agent or a joint that does not exist.
    """
    topics = elements_of(request.joint_topics, cast.agents)
    known = {word for name, one in cast.agents.items() for joint in one.joints for word in joint_words(name, joint)}
    for word in request.joints:
        if word not in known:
            near = get_close_matches(word, sorted(known), n=3, cutoff=0.5)
            raise NoElement(f"no agent has a joint '{word}'" + (f"; nearest: {', '.join(near)}" if near else ""))
    found: dict[str, LoggedArm] = {}
    for agent in cast.agents if contents.joints else ():
        try:
            found[agent] = _find_arm(agent, cast.agents[agent], contents, topics, request.joints)
        except JointsProblem as problem:
            remarks.append(str(problem))
    return found


def _find_arm(
    agent: str, robot: RobotModel, contents: LogContents, topics: Mapping[str, str], stated: Mapping[str, str]
) -> LoggedArm:
    given = stated_joints(agent, robot.joints, stated)
    topic = topic_of(agent, robot.joints, contents.joints, topics, given)
    logged = contents.joints[topic]
    names = joints_of(agent, robot.joints, logged, given)
    arm = arm_of(robot)
    found = LoggedArm(
        arm, topic, tuple(names[joint] for joint in robot.joints), tuple(logged[names[one]] for one in robot.joints)
    )
    if problem := _wrong_unit(found):
        raise JointsProblem(problem)
    return found


def _wrong_unit(found: LoggedArm) -> str:
    """Return the reason if positions are too far beyond the limits to be in rad; else an empty text."""
    rows = zip(found.names, found.tracks, found.arm.lower, found.arm.upper, found.arm.limited, strict=True)
    for name, track, lower, upper, limited in rows:
        beyond = max(lower - float(track.positions.min()), float(track.positions.max()) - upper)
        if limited and beyond > IMPOSSIBLE:
            return (
                f"the positions of '{name}' on '{found.topic}' are up to {beyond:.1f} beyond the limits of the arm: "
                "record them in rad (m for a sliding joint)"
            )
    return ""
