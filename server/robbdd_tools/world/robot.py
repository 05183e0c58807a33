"""A robot's indices in the arrays of the physics engine."""

from __future__ import annotations

from copy import copy
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.coupled_joints import coupled_joints
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.finger_motion import finger_motion
from robbdd_tools.world.mobile_base import BaseState, base_of
from robbdd_tools.world.placement import TABLE_TOP, surface

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.composition import World
    from robbdd_tools.world.pose import Pose


class Robot:
    """One robot of a running simulation: its indices in the engine's arrays.

    ``joints`` (n,) are indices of joint positions, ``speeds`` (n,) of velocities, ``motors`` (n,) and ``gripper`` of
    controls; ``targets`` (n,) are the current target positions of the arm's servos.
    """

    def __init__(self, world: World, name: str) -> None:
        model, robot = world.model, world.cast.agents[name]
        self.name = name
        self.model = robot
        self.base: Pose = world.bases[name]
        """The pose of the arm's frame, to which tool poses refer; on a mobile base, this pose changes."""
        mobile = base_of(robot)
        self.mobile = None if mobile is None else BaseState(model, name, mobile, self.base)
        joints = [model.joint(f"{name}/{joint}") for joint in robot.joints]
        self.joints = np.array([joint.qposadr[0] for joint in joints])
        self.speeds = np.array([joint.dofadr[0] for joint in joints])
        self.coupled = coupled_joints(model, [joint.id for joint in joints])
        on_joint = np.flatnonzero(model.actuator_trntype == int(mujoco.mjtTrn.mjTRN_JOINT))
        driven = {int(model.actuator_trnid[motor, 0]): int(motor) for motor in on_joint}
        self.limited = np.array([joint.qposadr[0] for joint in joints if model.jnt_limited[joint.id]], dtype=int)
        """Indices of the positions of the arm's joints that have limits, shape (k,)."""
        self.limits: FloatArray = np.array(
            [model.jnt_range[joint.id] for joint in joints if model.jnt_limited[joint.id]]
        ).reshape(-1, 2)
        """Lower and upper limits (rad, or m for a sliding joint) of the joints ``limited``, shape (k, 2)."""
        self.motors = np.array([driven[joint.id] for joint in joints])
        self.targets = model.actuator_actadr[self.motors]
        self.gripper = int(model.actuator(f"{name}/{robot.gripper_actuator}").id)
        self.tool = int(model.site(f"{name}/{robot.tool_site}").id)
        self.pads = tuple(int(model.geom(f"{name}/{pad}").id) for pad in robot.pads)
        self.faces = tuple(
            tuple(int(model.geom(f"{name}/{pad}").id) for pad in face)
            for face in finger_motion(robot).faces or tuple((pad,) for pad in robot.pads)
        )
        gain, bias = model.actuator_gainprm[self.motors, 0], model.actuator_biasprm[self.motors, 2]
        self.lead: FloatArray = -bias / gain
        """A joint's target leads by this time (s) to compensate for the servo's damping, shape (n,)."""
        self.raised = _raised(world, name)
        """Heights of usual cells are this much (m) higher here."""
        self.travel_height = robot.travel_height + self.raised
        """Height (m, world frame) at which the tool travels."""

    def follow_base(self, data: Any) -> None:
        """Update ``base`` with the pose of a mobile base in a state of the engine."""
        if self.mobile is not None:
            self.base = self.mobile.frame_at(data.qpos[self.mobile.joints])

    def standing_in(self, data: Any) -> Robot:
        """Return the robot with its base at the pose in another state of the engine."""
        if self.mobile is None:
            return self
        found = copy(self)
        found.follow_base(data)
        return found


def _raised(world: World, name: str) -> float:
    """Return how much (m) higher the largest table is than a usual one; 0 with a configured ``travel_height``.

    In models of users, the world's origin is often on the floor.
    """
    cast = world.cast
    if not cast.tables or (name, "travel_height") in cast.chosen:
        return 0.0
    table = cast.tables[0]
    return max(0.0, round(world.poses[table].position[2] + surface(cast.objects[table]) - TABLE_TOP, 6))
