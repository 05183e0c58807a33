"""Measure how far arms are from their joint limits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.robot import Robot


def joint_clearances(robots: Iterable[Robot], states: FloatArray) -> Mapping[str, FloatArray]:
    """Return for each robot how near any joint is to a limit at recorded states (n, width), shape (n,).

    The distance is a share of the joint's range, so that turning and sliding joints can be compared; it is negative
    beyond the limit. Robots without limited joints are missing.
    """
    found: dict[str, FloatArray] = {}
    for robot in robots:
        if robot.limited.size:
            lower, upper = robot.limits.T
            positions = states[:, robot.limited]
            found[robot.name] = (np.minimum(positions - lower, upper - positions) / (upper - lower)).min(axis=1)
    return found
