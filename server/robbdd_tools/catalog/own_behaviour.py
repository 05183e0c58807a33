"""Interface of users' own behaviours.

A ``.bddx`` names a class, ``bhv impl (ns=x) mine { py { module: my_arm, attr: Pick } }``. The class is instantiated
without arguments for each behaviour of each execution; ``reset`` passes the task, then ``step`` is called once per
control tick (16 ms of simulated time) until it returns ``True``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from robbdd_tools.catalog.api import Arguments, FloatArray


class BehaviourFailed(Exception):
    """Raise this if the agent cannot go on: its behaviour has failed, and the message gives the reason.

    Any other exception is an error in the code, and the execution's clauses are unknown.
    """


class World(Protocol):
    """The simulated world as one agent's behaviour observes and moves it; world frame, SI units."""

    @property
    def time(self) -> float:
        """Simulated time, s."""
        ...

    @property
    def joints(self) -> FloatArray:
        """Positions of the arm's joints, rad, shape (n,)."""
        ...

    @property
    def joint_velocities(self) -> FloatArray:
        """Velocities of the arm's joints, rad/s (m/s of sliding ones), shape (n,)."""
        ...

    @property
    def joint_limits(self) -> tuple[FloatArray, FloatArray]:
        """Lower and upper limits of the arm's joints, rad (m), shape (n,) each."""
        ...

    @property
    def gravity(self) -> FloatArray:
        """The acceleration of gravity (3,) m/s²."""
        ...

    @property
    def tool(self) -> tuple[FloatArray, FloatArray]:
        """Position (3,) m and rotation matrix (3, 3) of the tool."""
        ...

    def pose(self, name: str) -> tuple[FloatArray, FloatArray]:
        """Position of an object's middle (3,) m, and its rotation matrix (3, 3); raises ``KeyError`` if unknown."""
        ...

    def velocity(self, name: str) -> tuple[FloatArray, FloatArray]:
        """Velocity of an object's middle (3,) m/s, and of its rotation (3,) rad/s; raises ``KeyError`` if unknown."""
        ...

    def joints_of(self, name: str) -> FloatArray:
        """Joint positions of another agent (n,) rad, or that of a thing that opens (1,) m or rad.

        Raises ``KeyError`` for any other name.
        """
        ...

    def force(self, first: str, second: str) -> float:
        """The sum of the contact forces (N) between two objects or agents now; 0 between objects that lie still.

        Raises an error in the kinematic world, which has no forces. For objects in a gripper, ask with the agent.
        """
        ...

    @property
    def cameras(self) -> tuple[str, ...]:
        """The names of the cameras in the files of arms and scenes; those of an arm begin with its name and ``/``."""
        ...

    def picture(
        self, camera: str | tuple[FloatArray, FloatArray], size: tuple[int, int] = (320, 240)
    ) -> NDArray[np.uint8]:
        """The pixels (height, width, 3), red, green and blue, of what a camera sees now; ``size`` is (width, height).

        ``camera`` is one of ``cameras``, or a position and the point that a camera there looks at, (3,) m each, with a
        vertical field of view of 45°. The same state gives the same pixels on one machine. Raises ``KeyError`` for
        an unknown camera, ``ValueError`` for an invalid argument, and an error if nothing here can render.
        """
        ...

    def place(self, workspace: str) -> FloatArray:
        """The middle (3,) m of a workspace's bottom; raises ``KeyError`` for an unknown name."""
        ...

    def holds(self, name: str) -> bool:
        """Whether the gripper holds an object."""
        ...

    def solve(self, position: FloatArray, closing: float = 0.0, rotation: FloatArray | None = None) -> FloatArray:
        """Joint positions (n,) rad that put the tool, pointing down, at a position (3,) m.

        ``closing`` (rad) is the direction in which fingers close. With a ``rotation`` (3, 3), the tool has that one
        instead: its columns are the tool's axes in the world frame, z out of the hand and y the closing direction.
        Raises ``BehaviourFailed`` out of reach.
        """
        ...

    def command(self, joints: FloatArray, opening: float) -> None:
        """Set the servos' target joint positions (n,) rad within one tick; ``opening`` is 0 (closed) to 1 (open).

        A target that is farther away than its joint can move in a tick is approached at the joint's speed limit.
        """
        ...

    def emit(self, event: str) -> None:
        """Report that an event of the behaviour occurs now: ``pick-start``, ``pick-end`` …

        Raises ``ValueError`` for a name that no behaviour of the language has for an event.
        """
        ...


class UserBehaviour(Protocol):
    """A class that executes behaviours."""

    def reset(self, world: World, behaviour: str, arguments: Arguments) -> None:
        """Begin: ``behaviour`` is a catalog name, ``arguments`` maps ``agent``, ``object`` … to names.

        If the model gives a set as the place, ``workspace`` is a tuple of names: the behaviour chooses one.
        """
        ...

    def step(self) -> bool:
        """Command the next tick; return ``True`` when the behaviour is done."""
        ...
