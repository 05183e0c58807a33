"""The interface of simulators: the functions of a simulated world that agents and controllers need."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.monitor.trace import EventStamp, Trace
    from robbdd_tools.world.cameras import Cameras
    from robbdd_tools.world.composition import World
    from robbdd_tools.world.momentary import Velocity
    from robbdd_tools.world.robot import Robot


class Simulator(Protocol):
    """A world that its constructor sets up and that advances in control ticks. Metres, radians, seconds, world frame.

    - set up: the constructor takes a ``World``; ``settle`` brings it to rest and starts the clock.
    - step: ``tick``.
    - observe: ``pose``, ``velocity``, ``tool``, ``holds``, ``joint_positions``, ``joint_velocities``, ``joint_of``,
      ``contact_force``, ``gravity``, ``cameras``, ``trace``, and ``seen`` as a robot with faults would.
    - command: ``command``, and ``drive`` for mobile bases; ``targets`` are the goals of an arm's joints.
    - snapshot: ``state`` and ``restore``; ``contents`` shows whether anything else has changed the world.
    """

    world: World
    """The compiled scene."""
    robots: dict[str, Robot]
    """The arms, by the names of their agents."""
    cameras: Cameras
    """The cameras for users' behaviours."""

    @property
    def time(self) -> float:
        """Simulated time of the last sample, s."""
        ...

    @property
    def has_physics(self) -> bool:
        """Whether forces and contacts move things. Otherwise, clauses about them are unknown."""
        ...

    def settle(self) -> None:
        """Bring the world to rest, start the clock and take the first sample. Raises ``SimulationError``."""
        ...

    def tick(self) -> None:
        """Advance by one control tick with the current commands and take a sample. Raises ``SimulationError``."""
        ...

    def pose(self, name: str) -> tuple[FloatArray, FloatArray]:
        """Return position (3,) m and rotation matrix (3, 3) of an object; raises ``KeyError``."""
        ...

    def velocity(self, name: str) -> Velocity:
        """Return the velocity of an object's position (3,) m/s and rotation (3,) rad/s; raises ``KeyError``."""
        ...

    def seen(self, name: str) -> tuple[FloatArray, FloatArray]:
        """Return the pose of an object as the robots perceive it, in the form of ``pose``."""
        ...

    def seen_place(self, carrier: str) -> tuple[FloatArray, FloatArray]:
        """Return the pose, as the robots perceive it and in the form of ``pose``, of an object that carries a goal."""
        ...

    def tool(self, robot: Robot) -> tuple[FloatArray, FloatArray]:
        """Return position (3,) m and rotation matrix (3, 3) of an arm's tool."""
        ...

    def holds(self, agent: str, name: str) -> bool:
        """Return whether the gripper of an agent holds an object."""
        ...

    def joint_positions(self, robot: Robot) -> FloatArray:
        """Return the positions of an arm's joints, rad, shape (n,)."""
        ...

    def joint_velocities(self, robot: Robot) -> FloatArray:
        """Return the velocities of an arm's joints, rad/s, shape (n,)."""
        ...

    def joint_of(self, name: str) -> float:
        """Return the position (m, rad) of the joint of a thing that opens; raises ``KeyError`` if it has none."""
        ...

    def contact_force(self, first: str, second: str) -> float:
        """Return the sum of the contact forces (N) of two elements; raises ``SimulationError`` without physics."""
        ...

    @property
    def gravity(self) -> FloatArray:
        """The acceleration of gravity, m/s², world frame, shape (3,)."""
        ...

    def targets(self, robot: Robot) -> FloatArray:
        """Return the joint positions (rad, shape (n,)) to which an arm moves."""
        ...

    def drive(self, robot: Robot, pose: FloatArray) -> None:
        """Move a mobile base to a pose (x m, y m, yaw rad) within one tick, world frame."""
        ...

    def command(self, robot: Robot, joints: FloatArray, opening: float) -> None:
        """Move an arm's joints to positions (rad, shape (n,)) within one tick, and set its gripper."""
        ...

    def trace(self, events: tuple[EventStamp, ...], finished: bool, remark: str) -> Trace:
        """Return the samples so far."""
        ...

    @property
    def state(self) -> FloatArray:
        """The positions of all joints and loose objects, shape (q,), from which a picture is drawn."""
        ...

    @property
    def contents(self) -> Mapping[str, bytes]:
        """The state and the parameters that only the simulator may change, by the simulator's names.

        If they differ before and after a call of users' code, the code has changed the world around its interface.
        """
        ...

    def restore(self, state: FloatArray) -> None:
        """Move everything to the positions of a state, at rest. The recording and the clock do not change."""
        ...
