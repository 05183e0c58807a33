"""Where objects are laid out, seen from the base of the robot that works with them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from robbdd_tools.world.working_area import before_base, place_before

if TYPE_CHECKING:
    from robbdd_tools.protocol.specs import SceneSpec
    from robbdd_tools.world.cast import Cast
    from robbdd_tools.world.pose import Pose


def laid_out(
    scene: SceneSpec, cast: Cast, base: Pose, poses: Mapping[str, Pose], *, is_mobile: bool
) -> dict[str, tuple[float, float]]:
    """Return how far (m) each object to grasp is ahead of the base, and to its left, before the world settles.

    A mobile base drives to the table first.
    """
    found: dict[str, tuple[float, float]] = {}
    for name, model in cast.objects.items():
        if model.graspable:
            regions = cast.regions.get(scene.places.get(name, ""), ())
            carrier = regions[0][0] if regions else cast.tables[0]
            table, place = cast.objects[carrier], poses[carrier]
            front = place_before(base, place, table) if is_mobile and table.region is not None else base
            found[name] = before_base(front, place, table, poses[name])
    return found
