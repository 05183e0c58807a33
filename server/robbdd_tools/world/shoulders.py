"""Arms whose shoulder is beside the middle of their base, such as the arms of a torso."""

from __future__ import annotations

from typing import Any

from robbdd_tools.world.engine import mujoco

ASIDE = 0.05
"""A shoulder less than this (m) beside the middle of the base is taken to be there."""
VERTICAL = 0.9
"""An axis is vertical if its vertical part is at least this."""


def shoulder_aside(model: Any, data: Any, joint: int) -> float:
    """Return how far (m) to the left of the middle of its base an arm turns by its first joint, a vertical axis.

    0 for an arm whose first joint slides or has another axis. ``data`` has the kinematics of any posture.
    """
    aside = float(data.xanchor[joint, 1])
    turns = model.jnt_type[joint] == int(mujoco.mjtJoint.mjJNT_HINGE) and abs(float(data.xaxis[joint, 2])) > VERTICAL
    return aside if turns and abs(aside) > ASIDE else 0.0
