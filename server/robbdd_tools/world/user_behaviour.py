"""Execute a behaviour with the user's own class."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from robbdd_tools.base.articulation import Opening
from robbdd_tools.catalog.own_behaviour import BehaviourFailed, UserBehaviour
from robbdd_tools.user_code.calls import UserCodeError, call_user_code, definition_of, load_attribute, refused
from robbdd_tools.world.arm_kinematics import arm_of
from robbdd_tools.world.engine import TICK
from robbdd_tools.world.errors import BehaviourError, UserError, at
from robbdd_tools.world.intactness import changed
from robbdd_tools.world.motion import frame_of, tool_pose
from robbdd_tools.world.region_frames import along_edges

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from robbdd_tools.catalog.api import Arguments, FloatArray
    from robbdd_tools.catalog.executable import Implementation
    from robbdd_tools.world.simulator import Simulator


class AgentWorld:
    """``robbdd_tools.catalog.own_behaviour.World`` for one agent of a simulation."""

    def __init__(self, simulation: Simulator, agent: str, emit: Callable[[str], None]) -> None:
        self._simulation = simulation
        self._robot = simulation.robots[agent]
        self._arm = arm_of(self._robot.model)
        self._emit = emit

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self._simulation.time

    @property
    def seed(self) -> int:
        """The seed of the execution."""
        return self._simulation.world.seed

    @property
    def objects(self) -> tuple[str, ...]:
        """The names of all objects."""
        return tuple(self._simulation.world.cast.objects)

    @property
    def places(self) -> tuple[str, ...]:
        """The names of the workspaces that an object carries."""
        return tuple(self._simulation.world.cast.regions)

    @property
    def joints(self) -> FloatArray:
        """Positions of the arm's joints, rad."""
        return self._simulation.joint_positions(self._robot).copy()

    @property
    def joint_velocities(self) -> FloatArray:
        """Velocities of the arm's joints, rad/s."""
        return self._simulation.joint_velocities(self._robot)

    @property
    def joint_limits(self) -> tuple[FloatArray, FloatArray]:
        """Lower and upper limits of the arm's joints, rad."""
        return self._arm.lower.copy(), self._arm.upper.copy()

    @property
    def gravity(self) -> FloatArray:
        """The acceleration of gravity, m/s²."""
        return self._simulation.gravity

    @property
    def tool(self) -> tuple[FloatArray, FloatArray]:
        """Position (m) and rotation matrix of the tool."""
        return self._simulation.tool(self._robot)

    def pose(self, name: str) -> tuple[FloatArray, FloatArray]:
        """Return position (m) and rotation matrix of an object; raises ``KeyError``."""
        return self._simulation.seen(name)

    def velocity(self, name: str) -> tuple[FloatArray, FloatArray]:
        """Return the velocity of an object (m/s, rad/s); raises ``KeyError``."""
        self._known(name, self._simulation.world.cast.objects)
        return self._simulation.velocity(name)

    def joints_of(self, name: str) -> FloatArray:
        """Return the joint positions of an agent or of a thing that opens (rad, m); raises ``KeyError``."""
        if name in self._simulation.robots:
            return self._simulation.joint_positions(self._simulation.robots[name]).copy()
        opening = self._simulation.world.cast.openings.get(name)
        if not isinstance(opening, Opening):
            raise KeyError(f"'{name}' is no agent, and no thing that opens")
        return np.array([self._simulation.joint_of(opening.part)])

    def force(self, first: str, second: str) -> float:
        """Return the contact force (N) of two elements; raises ``KeyError``, or ``SimulationError`` without physics."""
        for name in (first, second):
            self._known(name, (*self._simulation.world.cast.objects, *self._simulation.robots))
        return self._simulation.contact_force(first, second)

    @staticmethod
    def _known(name: str, names: Iterable[str]) -> None:
        if name not in names:
            raise KeyError(f"there is no '{name}' in the scene; it has {', '.join(names)}")

    @property
    def cameras(self) -> tuple[str, ...]:
        """The names of the cameras."""
        return self._simulation.cameras.names

    def picture(
        self, camera: str | tuple[FloatArray, FloatArray], size: tuple[int, int] = (320, 240)
    ) -> NDArray[np.uint8]:
        """Return the pixels that a camera sees; raises ``KeyError``, ``ValueError``, or ``SimulationError``."""
        return self._simulation.cameras.take(camera, size)

    def place(self, workspace: str) -> FloatArray:
        """Return the centre (m) of a workspace's bottom; raises ``KeyError``."""
        carrier, region = self._simulation.world.cast.regions[workspace][0]
        position, rotation = along_edges(self._simulation.seen_place(carrier), region)
        bottom: FloatArray = np.array(region.center) - [0.0, 0.0, region.half[2]]
        return position + rotation @ bottom

    def holds(self, name: str) -> bool:
        """Return whether the gripper holds an object."""
        return self._simulation.holds(self._robot.name, name)

    def solve(self, position: FloatArray, closing: float = 0.0, rotation: FloatArray | None = None) -> FloatArray:
        """Return joint positions (rad) for a tool pose; raises ``BehaviourFailed``, ``ValueError``."""
        place = np.asarray(position, dtype=float)
        if place.shape != (3,) or not np.all(np.isfinite(place)):
            raise ValueError(f"position must be 3 finite numbers, not {position!r:.200}")
        if not np.isfinite(closing):
            raise ValueError(f"closing must be a finite number, not {closing!r}")
        where, down = frame_of(tool_pose(self._robot.base, place, closing))
        wanted = down if rotation is None else self._in_base(rotation)
        try:
            return next(self._arm.solutions(where, wanted))
        except BehaviourError as error:
            if rotation is not None and (found := self._from_here(where, wanted)) is not None:
                return found
            raise BehaviourFailed(
                f"{self._robot.name} cannot reach {np.round(position, 3).tolist()}: {error}"
            ) from error

    def _in_base(self, rotation: FloatArray) -> FloatArray:
        """Return the rotation of the tool in the frame of the arm's base; raises ``ValueError``."""
        turn = np.asarray(rotation, dtype=float)
        if turn.shape != (3, 3) or not np.allclose(turn.T @ turn, np.eye(3), atol=1e-3) or np.linalg.det(turn) < 0.0:
            raise ValueError(f"rotation must be a rotation matrix of shape (3, 3), not {rotation!r:.200}")
        c, s = np.cos(self._robot.base.yaw), np.sin(self._robot.base.yaw)
        return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ turn

    def _from_here(self, place: FloatArray, rotation: FloatArray) -> FloatArray | None:
        """Return a solution near the present posture: if a tool does not point down, home may be far away."""
        try:
            return self._arm.solve(self.joints, place, rotation)
        except BehaviourError:
            return None

    def command(self, joints: FloatArray, opening: float) -> None:
        """Set the targets of servos (rad) and gripper (0 closed, 1 open); raises ``ValueError`` for invalid values.

        No target moves faster than its joint's speed limit: drives of real arms do not, either.
        """
        model = self._robot.model
        targets = np.asarray(joints, dtype=float)
        if targets.shape != self.joints.shape or not np.all(np.isfinite(targets)):
            raise ValueError(f"joints must be {len(self.joints)} finite numbers, not {joints!r:.200}")
        if not np.isfinite(opening):
            raise ValueError(f"opening must be a number from 0 to 1, not {opening!r}")
        here = self._simulation.targets(self._robot)
        farthest = np.array(model.velocity_limits) * TICK
        targets = here + np.clip(targets - here, -farthest, farthest)
        share = min(1.0, max(0.0, float(opening)))
        control = model.gripper_closed + share * (model.gripper_open - model.gripper_closed)
        self._simulation.command(self._robot, targets, control)

    def emit(self, event: str) -> None:
        """Record an event of the behaviour at the current time."""
        self._emit(event)

    def watched(self, name: str, code: Callable[..., Any], *arguments: Any) -> Any:
        """Return the result of users' code; raises ``UserCodeError``, also if it changes the world but by commands."""
        before = self._simulation.contents
        answer = call_user_code(name, code, *arguments)
        around = changed(before, self._simulation.contents)
        if around:
            what = f"{name} has changed the simulation itself ({', '.join(around)})"
            raise refused(name, f"{what}: it may only move its arm, by 'command'", definition_of(code))
        return answer


def run_user_behaviour(
    implementation: Implementation, world: AgentWorld, behaviour: str, arguments: Arguments
) -> Iterator[None]:
    """Yield once per control tick until the behaviour is over.

    Raises ``BehaviourError`` if the behaviour reports failure, and ``UserError`` for any other exception in it.
    """
    name = implementation.name
    model = "" if implementation.origin is None else implementation.origin.file
    try:
        own: UserBehaviour = call_user_code(name, load_attribute(name, model))
        world.watched(name, own.reset, world, behaviour, arguments)
        while not _is_over(name, own, world):
            yield
    except UserCodeError as error:
        if isinstance(error.__cause__, BehaviourFailed):
            raise BehaviourError(f"{error.__cause__} at {world.time:.2f} s") from error
        fault = replace(error.fault, origin=implementation.iri)
        raise UserError(f"{at(implementation.origin)}{error} at {world.time:.2f} s", fault) from error


def _is_over(name: str, own: UserBehaviour, world: AgentWorld) -> bool:
    """Execute the behaviour's next tick. ``None`` means that it continues; other non-boolean answers are refused."""
    answer: Any = world.watched(name, own.step)
    if answer is None or isinstance(answer, bool | np.bool_):
        return bool(cast(Any, answer))
    message = f"{name}.step must return True or False, not {answer!r:.60}"
    raise refused(name, message, definition_of(own.step))
