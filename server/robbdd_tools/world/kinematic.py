"""A world without physics: arms, and objects in their grippers, move as commanded; everything else stays in place."""

from __future__ import annotations

from dataclasses import dataclass
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.catalog.api import GripperKind, ShapeKind
from robbdd_tools.world.engine import TICK, mujoco
from robbdd_tools.world.errors import SceneError, SimulationError
from robbdd_tools.world.extent import half_of, outline_of
from robbdd_tools.world.finger_motion import finger_motion
from robbdd_tools.world.momentary import velocity_between
from robbdd_tools.world.owners import geom_owners, joint_of_part
from robbdd_tools.world.region_frames import along_edges
from robbdd_tools.world.simulation import Simulation

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robbdd_tools.catalog.api import FloatArray, Shape
    from robbdd_tools.world.composition import World
    from robbdd_tools.world.momentary import Velocity
    from robbdd_tools.world.robot import Robot

NEAR = 0.005
"""A closing gripper takes an object that is at most this far (m) from the tool's centre point."""
LOWEST, INWARDS = 0.005, 0.9
"""Points less than this (m) above an object's lowest point are its feet; this factor moves them towards its middle."""
DOWN = np.array([0.0, 0.0, -1.0])
ABOVE = 1e-3
"""The search for the surface below starts this far (m) above an object's lowest point: contacts penetrate a little."""


@dataclass(frozen=True, slots=True)
class _Held:
    """An object that moves with a gripper: its position (3,) m and its rotation (3, 3) in the frame of the tool."""

    name: str
    position: FloatArray
    rotation: FloatArray


class KinematicSimulation(Simulation):
    """A world in which things move as commanded, for checking models: geometry and events, but no forces.

    A gripper takes the object at its tool as soon as it closes, and holds it until it opens. Then the object is lowered
    onto what is below it. A part with a joint follows the tool along its joint, with the objects in it. Nothing is hit,
    pushed, tilted or lost.
    """

    def __init__(self, world: World) -> None:
        """Raises ``SceneError`` if the scene needs physics."""
        # The constructor of the base class commands the home positions.
        self._goals: dict[str, FloatArray] = {}
        self._controls: dict[str, float] = {}
        self._bases: dict[str, FloatArray] = {}
        super().__init__(world)
        if self.belts:
            raise SceneError("a conveyor needs physics: the kinematic world does not move what lies on it")
        if world.cast.drops:
            raise SceneError("'drop_height' needs physics: nothing rolls or tilts in the kinematic world")
        self._before = dict(self._controls)
        parts = [name for name, model in world.cast.objects.items() if model.joint is not None]
        self._movable = [*self._free, *parts]
        agents = set(self.robots)
        self._is_arm = [owner in agents for owner in geom_owners(self.model, self.robots)]
        self._taken: dict[str, _Held] = {}
        self._inside: dict[str, tuple[_Held, ...]] = {}
        for robot in self.robots.values():
            # Nothing lags, so targets need no lead.
            robot.lead = np.zeros_like(robot.lead)
            if robot.mobile is not None:
                robot.mobile.lead = 0.0

    @property
    def has_physics(self) -> bool:
        """Whether forces and contacts move things."""
        return False

    def settle(self) -> None:
        """Lower loose objects onto what is below them, the lowest first, then start the clock."""
        mujoco.mj_kinematics(self.model, self.data)
        for name in sorted(self._free, key=lambda name: float(self.pose(name)[0][2])):
            self._lower(name)
        self.restart()

    def command(self, robot: Robot, joints: FloatArray, opening: float) -> None:
        """Set the joint positions (rad, shape (n,)) after the next tick, and the gripper's control value."""
        self._goals[robot.name] = np.array(joints, dtype=float)
        self._controls[robot.name] = opening

    def drive(self, robot: Robot, pose: FloatArray) -> None:
        """Set the pose of a mobile base after the next tick."""
        assert robot.mobile is not None, "only mobile bases drive"
        self._bases[robot.name] = robot.mobile.positions_at(pose)

    def velocity(self, name: str) -> Velocity:
        """Return the velocity of an object's position (m/s) and rotation (rad/s) since the previous sample."""
        states = self.recorder.states
        after = self.pose(name)
        if len(states) < 2:
            return np.zeros(3), np.zeros(3)
        self.scratch.qpos[:] = states[-2]
        mujoco.mj_kinematics(self.model, self.scratch)
        body = self.scratch.body(name)
        return velocity_between((body.xpos.copy(), body.xmat.reshape(3, 3).copy()), after, TICK)

    def joint_velocities(self, robot: Robot) -> FloatArray:
        """Return the velocities of an arm's joints (rad/s, shape (n,)) since the previous sample."""
        states = self.recorder.states
        if len(states) < 2:
            return np.zeros(len(robot.joints))
        return (states[-1, robot.joints] - states[-2, robot.joints]) / TICK

    def contact_force(self, first: str, second: str) -> float:
        """Raise ``SimulationError``: this world has no forces."""
        raise SimulationError(f"the kinematic world has no forces, so none between {first} and {second}")

    def targets(self, robot: Robot) -> FloatArray:
        """Return the joint positions (rad, shape (n,)) to which the arm moves."""
        return self._goals[robot.name].copy()

    def _step(self) -> None:
        began = perf_counter()
        for name, robot in self.robots.items():
            self.data.qpos[robot.joints] = self._goals[name]
            robot.coupled.place(self.data.qpos)
            if robot.mobile is not None and name in self._bases:
                self.data.qpos[robot.mobile.joints] = self._bases[name]
            self._move_fingers(robot)
        mujoco.mj_kinematics(self.model, self.data)
        for name, robot in self.robots.items():
            closing = self._closing(robot)
            held = self._taken.get(name)
            if held is not None and closing < 0.0:
                self._release(name, held)
            elif held is not None:
                self._carry(robot, held)
            elif closing > 0.0 or self._sucks(robot):
                self._take(robot)
            self._before[name] = self._controls[name]
        self.stepping += perf_counter() - began

    def _sense(self) -> None:
        """Record which object each gripper holds."""
        for agent, grip in self._grips.held.items():
            grip[:] = 0.0
            if agent in self._taken:
                grip[self._column[self._taken[agent].name]] = 1.0

    def _closing(self, robot: Robot) -> float:
        """Return how far the gripper closed (positive) or opened (negative) in this tick, in units of its control."""
        model = robot.model
        change = self._controls[robot.name] - self._before[robot.name]
        return change if model.gripper_closed > model.gripper_open else -change

    def _sucks(self, robot: Robot) -> bool:
        """Return whether a vacuum is on, which grips any object that the cup touches."""
        is_on = self._controls[robot.name] == robot.model.gripper_closed
        return robot.model.gripper is GripperKind.SUCTION and is_on

    def _move_fingers(self, robot: Robot) -> None:
        """Move sliding fingers of the catalog to their commanded positions; their joints carry the pads."""
        if finger_motion(robot.model).open_joints:
            return
        for pad in robot.pads:
            body = self.model.body(int(self.model.geom_bodyid[pad]))
            for joint in range(body.jntadr[0], body.jntadr[0] + body.jntnum[0]):
                low, high = self.model.jnt_range[joint]
                self.data.qpos[self.model.jnt_qposadr[joint]] = min(high, max(low, self._controls[robot.name]))

    def _take(self, robot: Robot) -> None:
        """Take the object that contains the tool's centre point, if there is one."""
        place, turn = self.tool(robot)
        for name in self._movable:
            if any(held.name == name for held in self._taken.values()):
                continue
            position, rotation = self.pose(name)
            local = rotation.T @ (place - position)
            if any(_is_in(shape, local) for shape in self.world.cast.objects[name].shapes):
                relative = turn.T @ (position - place), turn.T @ rotation
                self._taken[robot.name] = _Held(name, *relative)
                self._inside[name] = tuple(self._contents(name))
                return

    def _contents(self, name: str) -> Iterator[_Held]:
        """Yield the loose objects in the workspace of a part with a joint, with poses in the frame of the part."""
        model = self.world.cast.objects[name]
        if model.joint is None or model.region is None:
            return
        place, turn = along_edges(self.pose(name), model.region)
        for other in (other for other in self._free if self.world.cast.objects[other].graspable):
            position, rotation = self.pose(other)
            local = turn.T @ (position - place)
            if (np.abs(local - model.region.center) <= model.region.half).all():
                yield _Held(other, local, turn.T @ rotation)

    def _carry(self, robot: Robot, held: _Held) -> None:
        place, turn = self.tool(robot)
        if self.world.cast.objects[held.name].joint is None:
            self._put(held.name, place + turn @ held.position, turn @ held.rotation)
        else:
            self._slide(held.name, place + turn @ held.position)
        mujoco.mj_kinematics(self.model, self.data)
        here, rotation = self.pose(held.name)
        for other in self._inside[held.name]:
            self._put(other.name, here + rotation @ other.position, rotation @ other.rotation)

    def _slide(self, name: str, wanted: FloatArray) -> None:
        """Move the joint of a part so that the part is as near as possible to a position (3,) m."""
        joint = self.model.joint(joint_of_part(name)).id
        address = int(self.model.jnt_qposadr[joint])
        axis, anchor = self.data.xaxis[joint], self.data.xanchor[joint]
        here, _ = self.pose(name)
        if self.model.jnt_type[joint] == int(mujoco.mjtJoint.mjJNT_SLIDE):
            way = float(axis @ (wanted - here))
        else:
            one, other = (np.cross(axis, point - anchor) for point in (here, wanted))
            way = float(np.arctan2(axis @ np.cross(one, other), one @ other))
        low, high = self.model.jnt_range[joint] if self.model.jnt_limited[joint] else (-np.inf, np.inf)
        self.data.qpos[address] = min(high, max(low, float(self.data.qpos[address]) + way))

    def _release(self, agent: str, held: _Held) -> None:
        del self._taken[agent], self._inside[held.name]
        if self.world.cast.objects[held.name].joint is None:
            self._lower(held.name)

    def _lower(self, name: str) -> None:
        """Lower an object straight onto the highest surface below it."""
        position, rotation = self.pose(name)
        points = [
            (position + rotation @ np.array(point), radius)
            for point, radius in outline_of(self.world.cast.objects[name])
        ]
        lowest = min(float(point[2]) - radius for point, radius in points)
        feet = [point for point, radius in points if float(point[2]) - radius < lowest + LOWEST]
        starts = [np.array([*(position + INWARDS * (foot - position))[:2], lowest + ABOVE]) for foot in feet]
        fall = min(self._height(name, start) for start in starts) - ABOVE
        self._put(name, position - [0.0, 0.0, fall], rotation)
        mujoco.mj_kinematics(self.model, self.data)

    def _height(self, name: str, start: FloatArray) -> float:
        """Return the distance (m) from a point down to the first surface, ignoring the object ``name`` and the arms."""
        own, geom = int(self.model.body(name).id), np.full(1, -1, dtype=np.int32)
        distance, here = 0.0, start.copy()
        while True:
            found = mujoco.mj_ray(self.model, self.data, here, DOWN, None, 1, own, geom)
            if found < 0.0:
                return distance
            distance += found
            if not self._is_arm[int(geom[0])]:
                return distance
            here = start - [0.0, 0.0, distance + NEAR]
            distance += NEAR

    def _put(self, name: str, position: FloatArray, rotation: FloatArray) -> None:
        address = int(self.model.jnt_qposadr[self.model.body(name).jntadr[0]])
        self.data.qpos[address : address + 3] = position
        mujoco.mju_mat2Quat(self.data.qpos[address + 3 : address + 7], rotation.ravel())


def _is_in(shape: Shape, point: FloatArray) -> bool:
    """Return whether a point (3,) m, in the frame of the object, is in a shape or near it."""
    offset = np.abs(point - shape.position)
    if shape.kind is ShapeKind.SPHERE:
        return float(np.linalg.norm(offset)) <= shape.size[0] + NEAR
    if shape.kind is ShapeKind.CYLINDER:
        return float(np.hypot(*offset[:2])) <= shape.size[0] + NEAR and offset[2] <= shape.size[1] + NEAR
    return bool((offset <= np.array(half_of(shape)) + NEAR).all())
