"""How much higher the tables of a cell are than usual: arms work at the heights of tables."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from robbdd_tools.catalog.object_settings import can_move

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import ObjectModel
    from robbdd_tools.world.pose import Pose

TABLE_TOP = 0.10
"""Height (m) of table tops above the world's origin. The paper does not define it, as it has its own world frame."""


def rise_of(objects: Mapping[str, ObjectModel], pose_of: Callable[[str], Pose | None]) -> float:
    """Return how much (m) higher the largest table is than a usual one, 0 if it is lower or has no stated pose.

    In models of users, the world's origin is often on the floor.
    """
    fixed = {name: model for name, model in objects.items() if not can_move(model) and not model.bystander}
    tops = [
        (region.half[0] * region.half[1], pose.position[2] + region.center[2] - region.half[2] - model.frame[2])
        for name, model in fixed.items()
        if (region := model.region) is not None and (pose := pose_of(name)) is not None
    ]
    _, height = max(tops, default=(0.0, TABLE_TOP))
    return max(0.0, round(height - TABLE_TOP, 6))
