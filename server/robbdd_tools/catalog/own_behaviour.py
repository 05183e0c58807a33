"""What a behaviour of a user's own has to do, and what it may ask for.

A ``.bddx`` names a class, ``bhv impl (ns=x) mine { py { module: my_arm, attr: Pick } }``. The class is made without
arguments for each behaviour of each execution; ``reset`` tells it what to do, then ``step`` is called once per control
tick (16 ms of simulated time) until it returns ``True``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Arguments, FloatArray


class BehaviourFailed(Exception):
    """Raise this when the agent cannot go on: its behaviour has failed, and the message says why.

    Any other exception is an error in the code: nothing can be concluded from the execution then.
    """


class World(Protocol):
    """The simulated world as one agent's behaviour sees and moves it; the frame is the world's, units are SI."""

    @property
    def time(self) -> float:
        """Simulated time, s."""
        ...

    @property
    def joints(self) -> FloatArray:
        """Positions of the arm's joints, rad, shape (n,)."""
        ...

    @property
    def tool(self) -> tuple[FloatArray, FloatArray]:
        """Position (3,) m and rotation matrix (3, 3) of the tool."""
        ...

    def pose(self, name: str) -> tuple[FloatArray, FloatArray]:
        """Position of an object's middle (3,) m, its rotation matrix (3, 3); raises ``KeyError`` for an unknown one."""
        ...

    def place(self, workspace: str) -> FloatArray:
        """The middle (3,) m of a workspace's bottom; raises ``KeyError`` for an unknown one."""
        ...

    def holds(self, name: str) -> bool:
        """Whether the gripper holds an object."""
        ...

    def solve(self, position: FloatArray, closing: float = 0.0) -> FloatArray:
        """Joint positions (n,) rad that put the tool, pointing down, at a position (3,) m.

        ``closing`` (rad) is the direction in which fingers close. Raises ``BehaviourFailed`` out of reach.
        """
        ...

    def command(self, joints: FloatArray, opening: float) -> None:
        """Move the servos' targets to joint positions (n,) rad within one tick; ``opening`` from 0 closed to 1 open."""
        ...

    def emit(self, event: str) -> None:
        """Tell that an event of the behaviour occurs now: ``pick-start``, ``pick-end`` …"""
        ...


class UserBehaviour(Protocol):
    """A class that executes behaviours."""

    def reset(self, world: World, behaviour: str, arguments: Arguments) -> None:
        """Begin: ``behaviour`` is a catalog name, ``arguments`` maps ``agent``, ``object`` … to names.

        Where the model has a set as a place, ``workspace`` is a tuple of names: the behaviour chooses one.
        """
        ...

    def step(self) -> bool:
        """Command the next tick; return ``True`` when the behaviour is over."""
        ...
