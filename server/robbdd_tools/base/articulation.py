"""Joints of things that open: drawers, doors, lids, levers and buttons."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

Three = tuple[float, float, float]
Four = tuple[float, float, float, float]
CLOSED_SHARE, OPEN_SHARE = 0.02, 0.9
"""A thing is closed up to the first share of its travel and open from the second one, unless the scene states others.

A closed drawer or door lies against its stop, whose contact yields a little. An open one gives access, even before its
last stop. A door that a spring or a gripper leaves half open does not count as open.
"""


@dataclass(frozen=True, slots=True)
class PassiveJoint:
    """The joint that connects a moving part of an object to the element ``parent``.

    - ``kind``: ``slide`` (m, N) or ``hinge`` (rad, N m).
    - ``axis``, ``anchor`` (m): in the frame of the part.
    - ``position`` (m), ``rotation`` (unit quaternion, w first): the pose of the part's frame in the parent's frame, as
      in the file. In this pose, the joint position is ``zero``.
    - ``bounds``: the range of the joint; ``None`` if it is not limited.
    - ``start``: the joint position at the beginning.
    - ``friction``, ``damping``, ``stiffness``, ``rest`` (of the spring), ``armature``: as in the file.
    - ``handle``: the number of the part's shape that a gripper holds; ``None`` if it has no handle.
    """

    parent: str
    kind: Literal["slide", "hinge"]
    axis: Three
    anchor: Three
    position: Three
    rotation: Four
    zero: float = 0.0
    bounds: tuple[float, float] | None = None
    start: float = 0.0
    friction: float = 0.0
    damping: float = 0.0
    stiffness: float = 0.0
    rest: float = 0.0
    armature: float = 0.0
    handle: int | None = None


@dataclass(frozen=True, slots=True)
class Opening:
    """How a thing opens: the joint of its element ``part`` moves. All positions are in m or rad.

    ``ends`` are the fully closed and the fully open position. The thing is closed up to the position ``closed``, and
    open from the position ``open`` on.
    """

    part: str
    kind: Literal["slide", "hinge"]
    ends: tuple[float, float]
    closed: float
    open: float


@dataclass(frozen=True, eq=False)
class OpeningRecord:
    """How far a thing was open: joint positions (n,) in m or rad. ``closed`` and ``open`` are as in ``Opening``."""

    kind: str
    closed: float
    open: float
    positions: FloatArray

    @property
    def unit(self) -> str:
        """The unit of margins."""
        return "m" if self.kind == "slide" else "deg"

    def beyond_open(self) -> FloatArray:
        """Return the distance (n,) past the position ``open``, in ``unit``. It is negative before this position."""
        return self._in_unit(self.positions - self.open)

    def short_of_closed(self) -> FloatArray:
        """Return the margin (n,) by which the thing is closed, in ``unit``: negative past the position ``closed``."""
        return self._in_unit(self.closed - self.positions)

    def _in_unit(self, difference: FloatArray) -> FloatArray:
        sense = 1.0 if self.open > self.closed else -1.0
        return difference * (sense if self.kind == "slide" else degrees(sense))
