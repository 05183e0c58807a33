"""Find how an agent can approach an object: grasp poses, joint positions, and remaining clearance."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import groupby
from math import cos, nan, pi, remainder, sin
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.arm_kinematics import Unreachable, arm_of
from robbdd_tools.world.clearance import Clearance
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import BehaviourError
from robbdd_tools.world.finger_motion import finger_motion
from robbdd_tools.world.grasp import Grasp
from robbdd_tools.world.gripper import gripper_of
from robbdd_tools.world.motion import ToolPose, frame_of, tool_pose, yaw_of
from robbdd_tools.world.travel_clearance import is_roofed

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.arm_kinematics import Arm
    from robbdd_tools.world.placement import Pose
    from robbdd_tools.world.robot import Robot
    from robbdd_tools.world.simulation import Simulation

NONE = -pi
"""Reach margin (rad) without a collision-free grasp within the joint limits."""
HIGH, LIFT = 0.25, 0.10
"""A support above ``HIGH`` (m, world frame), 0.15 m above usual tables, is near or above the travelling height.

There, objects are approached and left ``LIFT`` (m) above the grasp.
"""
JAW_ROOM = 0.003
"""Room (m) between an object and the jaw that does not move; the other one pushes the object through it."""
LOWEST, STEP = 0.04, 0.02
"""A small arm travels at least this high (m) above a pose; its travelling height is lowered in steps (m)."""
SAME = 1e-4
"""A sample reuses the previous reach margin if the state has changed by less than this (m, rad)."""


@dataclass(frozen=True, slots=True)
class Approach:
    """A grasp with the tool poses above it and at it, and the joint positions (rad) at it.

    ``depth`` is how deep (m) the arm penetrates anything else, and ``touched`` is the element penetrated most.
    """

    grasp: Grasp
    above: ToolPose
    at: ToolPose
    joints: FloatArray
    depth: float
    touched: str


@dataclass(slots=True)
class Obstruction:
    """Why an arm reaches none of several poses: the pose that it misses least, and the elements that it would touch."""

    nearest: Unreachable | None = None
    touched: dict[str, None] = field(default_factory=dict[str, None])

    def note(self, missed: Unreachable) -> None:
        """Add a pose that is out of reach."""
        if self.nearest is None or missed.short < self.nearest.short:
            self.nearest = missed

    def __str__(self) -> str:
        """Return the reason as the end of a message; empty without any."""
        if self.touched:
            # An arm that reaches some of the poses is not too short.
            return f": the arm would touch {', '.join(self.touched)}"
        return "" if self.nearest is None else f": its tool stays {self.nearest}"


def at_travel(robot: Robot, pose: ToolPose) -> ToolPose:
    """Return a tool pose raised to the travelling height or, if the arm does not reach so high there, less far."""
    arm = arm_of(robot.model)
    height = robot.travel_height - robot.base.position[2]
    over = replace(pose, height=max(min(height, arm.stroke[1] - SAME), pose.height))
    # The paths of the catalog's arms are published results.
    return over if arm.is_published else _lowered(arm, over, pose.height + LOWEST)


def _lowered(arm: Arm, over: ToolPose, lowest: float) -> ToolPose:
    """Return a tool pose, lowered in steps until the arm reaches it, but not below a height (m); else unchanged.

    A pose that had to be lowered is a further step lower: at the edge of its reach, an arm cannot follow a path.
    """
    for height in np.arange(over.height, lowest, -STEP).tolist():
        lower = replace(over, height=height)
        place, turn = frame_of(lower)
        try:
            arm.solve(arm.towards(place), place, turn)
        except Unreachable:
            continue
        return lower if height == over.height else replace(over, height=max(height - STEP, lowest))
    return over


def is_high(robot: Robot, pose: ToolPose, below: float) -> bool:
    """Return whether what a tool holds, ``below`` m above its support, is on a support near the travelling height."""
    return pose.height + robot.base.position[2] - below > HIGH + robot.raised


def over_support(simulation: Simulation, robot: Robot, name: str, pose: ToolPose, below: float) -> ToolPose:
    """Return the pose above a tool pose at which an object is approached or left.

    It is at the travelling height or, over a high support without a roof, at least ``LIFT`` above the pose.
    """
    over = at_travel(robot, pose)
    if not is_high(robot, pose, below) or is_roofed(simulation, robot, name, pose):
        return over
    return replace(over, height=max(over.height, pose.height + LIFT))


def joints_at(arm: Arm, above: ToolPose, at: ToolPose) -> FloatArray:
    """Return the joint positions (rad) at a pose approached from above; raises ``Unreachable``."""
    missed: Unreachable | None = None
    for start in arm.solutions(*frame_of(above)):
        try:
            return arm.solve(start, *frame_of(at))
        except Unreachable as error:
            missed = error if missed is None or error.short < missed.short else missed
    assert missed is not None, "without a start, the search raises"
    raise missed


def either_way(arm: Arm, pose: ToolPose) -> tuple[ToolPose, ...]:
    """Return a tool pose and, unless results of the arm are published, the same pose with its fingers interchanged."""
    if arm.is_published:
        return (pose,)
    return pose, replace(pose, turn=pose.turn - pi if pose.turn > 0.0 else pose.turn + pi)


def approaches(
    simulation: Simulation, robot: Robot, name: str, data: Any = None, missed: Obstruction | None = None
) -> Iterator[Approach]:
    """Yield every grasp of an object within the joint limits, in the current state or in the state of ``data``.

    ``missed`` records how far other grasps are out of reach. Raises ``BehaviourError`` if the scene has no such object
    or the gripper is too small for it.
    """
    objects = simulation.world.cast.objects
    if name not in objects:
        raise BehaviourError(f"there is no {name} in the scene")
    position, rotation = simulation.seen(name)
    if data is not None:
        # A recorded state is the truth, whatever the robot perceives.
        position, rotation = data.body(name).xpos.copy(), data.body(name).xmat.reshape(3, 3).copy()
    data = simulation.data if data is None else data
    grasps = gripper_of(robot.model).grasps(name, objects[name], position, rotation)

    def over(at: ToolPose, grasp: Grasp) -> ToolPose:
        return over_support(simulation, robot, name, at, grasp.below)

    for part, of_part in groupby(grasps, key=lambda grasp: grasp.part):
        yield from approaches_by(robot, of_part, Clearance(simulation, robot, name, data, part), missed, over)


def approaches_by(
    robot: Robot,
    grasps: Iterable[Grasp],
    clearance: Clearance,
    missed: Obstruction | None = None,
    over: Callable[[ToolPose, Grasp], ToolPose] | None = None,
) -> Iterator[Approach]:
    """Yield the grasps within the joint limits; ``missed`` records how far the others are out of reach.

    ``over`` returns the pose from which a grasp is approached; by default, it is at the travelling height.
    """
    for grasp in grasps:
        lowest = _approach(robot, grasp, clearance, missed, over)
        if lowest is None:
            continue
        others = (_approach(robot, one, clearance, missed, over) for one in grasp.higher() if lowest.depth > 0.0)
        yield next((one for one in others if one is not None and one.depth == 0.0), lowest)


def _approach(
    robot: Robot,
    centred: Grasp,
    clearance: Clearance,
    missed: Obstruction | None,
    over: Callable[[ToolPose, Grasp], ToolPose] | None,
) -> Approach | None:
    """Return how the arm approaches a grasp with either finger on either side, or ``None`` if it is out of reach."""
    arm, one_sided = arm_of(robot.model), finger_motion(robot.model).one_sided
    grasp = centred
    for at in either_way(arm, tool_pose(robot.base, grasp.position, grasp.closing)):
        if one_sided:
            at, grasp = _beside_fixed_jaw(robot.base, at, centred)
        above = at_travel(robot, at) if over is None else over(at, grasp)
        try:
            joints = joints_at(arm, above, at)
        except Unreachable as error:
            if missed is not None:
                missed.note(error)
            continue
        hit = clearance.hit(joints)
        return Approach(grasp, above, at, joints, hit.depth, hit.owner)
    return None


def _beside_fixed_jaw(base: Pose, pose: ToolPose, grasp: Grasp) -> tuple[ToolPose, Grasp]:
    """Return a tool pose and its grasp with the jaw that does not move beside the object, not in its middle."""
    yaw = yaw_of(base, pose)
    towards_object = np.array([sin(yaw), -cos(yaw), 0.0])
    position = grasp.position - (grasp.width / 2 + JAW_ROOM) * towards_object
    moved = tool_pose(base, position, grasp.closing)
    moved = replace(moved, turn=moved.turn + pi * round(remainder(yaw - yaw_of(base, moved), 2 * pi) / pi))
    x, y = np.array(grasp.aside) + grasp.width / 2 * towards_object[:2]
    return moved, replace(grasp, position=position, aside=(float(x), float(y)))


class ReachSampler:
    """Measure on demand, from recorded states, how well agents could reach objects."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._margins: dict[tuple[str, str], dict[int, float]] = {}

    @cached_property
    def _data(self) -> Any:
        return mujoco.MjData(self._simulation.model)

    def sample(self, agent: str, name: str, rows: range) -> None:
        """Measure at these samples of the trace; raises ``KeyError`` for an unknown agent."""
        robot = self._simulation.robots[agent]
        known = self._margins.setdefault((agent, name), {})
        states = self._simulation.recorder.states
        # The arm's own position does not matter: the margin is about possible positions.
        others = np.ones(states.shape[1], dtype=bool)
        others[robot.joints] = False
        last: tuple[FloatArray, float] | None = None
        for row in rows:
            if row in known:
                continue
            state = states[row]
            if last is None or np.abs(state[others] - last[0]).max(initial=0.0) > SAME:
                last = (state[others], self._margin(robot, name, state))
            known[row] = last[1]

    def record(self, size: int) -> Mapping[tuple[str, str], FloatArray]:
        """Return the measured margins as arrays over the first ``size`` samples, NaN where not measured."""
        found: dict[tuple[str, str], FloatArray] = {}
        for pair, margins in self._margins.items():
            values = np.full(size, nan)
            values[list(margins)] = list(margins.values())
            found[pair] = values
        return found

    def _margin(self, robot: Robot, name: str, state: FloatArray) -> float:
        self._data.qpos[:] = state
        mujoco.mj_kinematics(self._simulation.model, self._data)
        arm, robot = arm_of(robot.model), robot.standing_in(self._data)
        try:
            clear = [a.joints for a in approaches(self._simulation, robot, name, self._data) if a.depth == 0.0]
        except BehaviourError:
            return NONE
        rooms = [float(np.minimum(joints - arm.lower, arm.upper - joints).min()) for joints in clear]
        return max(rooms, default=NONE)
