"""Detect objects and agents that overlap in a scene's initial state.

The engine would push them apart while the world settles, so that they start elsewhere or fly off.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.owners import geom_owners

if TYPE_CHECKING:
    from robbdd_tools.world.simulation import Simulation

TOLERATED = 1e-3
"""Resting contacts may be this deep (m) (docs/simulation.md)."""
MAX_NAMED = 3
"""Maximum number of overlaps that one message names."""


class Overlap(SceneError):
    """Elements overlap in the scene's initial state."""


def refuse_overlaps(simulation: Simulation) -> None:
    """Raise ``Overlap`` with names and depths if elements overlap in a world that has not been stepped yet."""
    world, data = simulation.world, simulation.data
    owners = geom_owners(world.model, world.cast.agents)
    elements = {*world.cast.objects, *world.cast.agents}
    depths: dict[tuple[str, str], float] = {}
    pairs: list[list[int]] = data.contact.geom.tolist()
    for (first, second), distance in zip(pairs, data.contact.dist.tolist(), strict=True):
        one, other = sorted((owners[first], owners[second]), key=lambda owner: (owner not in elements, owner))
        if one != other and one in elements and -distance > TOLERATED:
            depths[one, other] = max(depths.get((one, other), 0.0), -distance)
    if depths:
        deepest = sorted(depths, key=lambda pair: -depths[pair])
        named = [f"'{one}' and '{other}' overlap by {1000 * depths[one, other]:.0f} mm" for one, other in deepest]
        more = [f"{len(named) - MAX_NAMED} more pairs overlap"] if len(named) > MAX_NAMED else []
        origins = (world.cast.origin(name) for name in deepest[0])
        origin = next((origin for origin in origins if origin is not None), None)
        raise Overlap(f"{'; '.join(named[:MAX_NAMED] + more)}: nothing may overlap at the start", origin=origin)
