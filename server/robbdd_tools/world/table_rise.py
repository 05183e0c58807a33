"""How much higher the tables of a cell are than usual: arms work at the heights of tables."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from robbdd_tools.catalog.object_settings import can_move
from robbdd_tools.world.extent import carrying

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import ObjectModel
    from robbdd_tools.world.pose import Pose

TABLE_TOP = 0.10
"""Height (m) of table tops above the world's origin. The paper does not define it, as it has its own world frame."""


def rise_of(objects: Mapping[str, ObjectModel], pose_of: Callable[[str], Pose | None]) -> float:
    """Return how much (m) higher the largest table is than a usual one, 0 if it is lower or has no stated pose.

    In models of users, the world's origin is often on the floor.
    """
    tops = [_top(model, pose) for name, model in objects.items() if _is_table(model) and (pose := pose_of(name))]
    _, height = max(tops, default=(0.0, TABLE_TOP))
    return max(0.0, round(height - TABLE_TOP, 6))


def _is_table(model: ObjectModel) -> bool:
    return not can_move(model) and not model.bystander


def _top(model: ObjectModel, pose: Pose) -> tuple[float, float]:
    """Return the area (m²) of an object's surface for other objects, and its height (m, world frame)."""
    region = carrying(model).region
    if region is None:
        return 0.0, TABLE_TOP
    (x, y, high), (_, _, bottom) = region.half, region.center
    return 4 * x * y, pose.position[2] + bottom - high - model.frame[2]
