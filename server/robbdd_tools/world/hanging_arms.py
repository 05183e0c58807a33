"""Arms that hang below their base: from a ceiling by their own file, or from the beam of a gantry."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robbdd_tools.world.engine import mujoco

if TYPE_CHECKING:
    from collections.abc import Sequence

LEVEL = 1e-3
"""Rounding of heights (m) and of the vertical part of a unit axis."""


def is_hung(data: Any, joints: Sequence[int]) -> bool:
    """Return whether the second joint of an arm is below its base, whatever the posture in ``data`` is."""
    return float(data.xanchor[joints[:2][-1], 2]) < -LEVEL


def slides_sideways(model: Any, data: Any, joint: int) -> bool:
    """Return whether a joint slides horizontally, like the first one of a gantry."""
    slides = model.jnt_type[joint] == int(mujoco.mjtJoint.mjJNT_SLIDE)
    return bool(slides and abs(float(data.xaxis[joint, 2])) < LEVEL)
