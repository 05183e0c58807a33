"""Several agents that are the arms of one robot: agents of one model file whose bases have the same pose.

Each agent has its own arm. What carries the arms, such as a torso, belongs to none of them and is added once.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.file_contents import drop_dangling
from robbdd_tools.world.gripper_names import PREFIX
from robbdd_tools.world.mobile_base import base_of
from robbdd_tools.world.robot_specs import load_robot
from robbdd_tools.world.scene import local_name
from robbdd_tools.world.self_collision import name_bodies

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import RobotModel
    from robbdd_tools.world.pose import Pose

SAME = 1e-6
"""Bases have the same pose up to this difference (m, parts of a quaternion)."""


@dataclass(frozen=True, slots=True)
class JoinedArms:
    """The arms of one robot: for each agent, the names of the bodies of its arm, the first one first."""

    arms: Mapping[str, tuple[str, ...]]

    @property
    def name(self) -> str:
        """The name of what carries the arms: the prefix of its bodies in the world."""
        return "+".join(map(local_name, self.arms))

    def owner(self, body: str) -> str:
        """Return whose a body of the file is: its agent, or ``name``."""
        return next((agent for agent, bodies in self.arms.items() if body in bodies), self.name)

    def keep_arm(self, spec: Any, agent: str) -> None:
        """Leave one agent's arm in the description of the robot. What carries it keeps its frames only."""
        for other, bodies in self.arms.items():
            if other != agent:
                spec.delete(spec.body(bodies[0]))
        for body in spec.bodies:
            if body.name not in self.arms[agent]:
                for geom in list(body.geoms):
                    spec.delete(geom)
        drop_dangling(spec)

    def keep_carrier(self, spec: Any) -> None:
        """Leave what carries the arms in the description of the robot."""
        for bodies in self.arms.values():
            spec.delete(spec.body(bodies[0]))
        drop_dangling(spec)

    def apart(self, spec: Any, pairs: Mapping[str, list[tuple[str, str]]]) -> Iterator[tuple[str, str]]:
        """Yield the pairs of bodies in the world with different owners whose contacts are ignored.

        These are the pairs that the file excludes, and of each agent's ``pairs`` those of its arm and the carrier. The
        other arms are fixed in an agent's description: what is close to them there means nothing.
        """
        for exclude in spec.excludes:
            first, second = str(exclude.bodyname1), str(exclude.bodyname2)
            if self.owner(first) != self.owner(second):
                yield self.in_world(first), self.in_world(second)
        for agent, own in pairs.items():
            for first, second in own:
                if {self.owner(first), self.owner(second)} == {agent, self.name}:
                    yield self.in_world(first), self.in_world(second)

    def in_world(self, body: str) -> str:
        """Return the name in the world of a body of the file."""
        return f"{self.owner(body)}/{body}"


def joined_arms(agents: Mapping[str, RobotModel], bases: Mapping[str, Pose]) -> list[JoinedArms]:
    """Return the robots whose arms are several agents."""
    groups: list[list[str]] = []
    for name in agents:
        group = next((one for one in groups if all(_is_joined(agents, bases, name, other) for other in one)), None)
        if group is None:
            groups.append([name])
        else:
            group.append(name)
    return [JoinedArms({name: _bodies(agents[name]) for name in group}) for group in groups if len(group) > 1]


def _is_joined(agents: Mapping[str, RobotModel], bases: Mapping[str, Pose], one: str, other: str) -> bool:
    """Return whether two agents are different arms of one robot."""
    models, poses = (agents[one], agents[other]), (bases[one], bases[other])
    if models[0].source != models[1].source or any(base_of(model) is not None for model in models):
        return False
    places = [np.array([*pose.position, pose.yaw, *(pose.rotation or (1.0, 0.0, 0.0, 0.0))]) for pose in poses]
    if np.abs(places[0] - places[1]).max() > SAME or models[0].mjcf in ("", models[1].mjcf):
        return False
    one_arm, other_arm = ({body for body in _bodies(model) if not body.startswith(PREFIX)} for model in models)
    return one_arm.isdisjoint(other_arm)


def _bodies(robot: RobotModel) -> tuple[str, ...]:
    """Return the bodies of an arm, from the one that its first joint moves."""
    spec = load_robot(robot)
    name_bodies(spec)
    first = spec.joint(robot.joints[0]).parent
    return tuple(str(body.name) for body in (first, *first.find_all("body")))
