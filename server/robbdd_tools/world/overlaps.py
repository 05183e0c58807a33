"""Detect objects and agents that overlap in a scene's initial state.

The engine would push them apart while the world settles, so that they start elsewhere or fly off.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.owners import geom_owners
from robbdd_tools.world.robots_in_world import COLUMN

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robbdd_tools.world.composition import World
    from robbdd_tools.world.simulation import Simulation

TOLERATED = 1e-3
"""Resting contacts may be this deep (m) (docs/simulation.md)."""
MAX_NAMED = 3
"""Maximum number of overlaps that one message names."""


class Overlap(SceneError):
    """Elements overlap in the scene's initial state."""


def refuse_overlaps(simulation: Simulation, *, also_fixed: bool = False) -> None:
    """Raise ``Overlap`` with names and depths if elements overlap in a world that has not been stepped yet.

    The engine has no contacts between two fixed things. They are compared with ``also_fixed``, which takes longer.
    """
    world, data = simulation.world, simulation.data
    owners = geom_owners(world.model, world.cast.agents)
    elements = {*world.cast.objects, *world.cast.agents}
    depths: dict[tuple[str, str], float] = {}
    elements_of: dict[tuple[str, str], tuple[str, str]] = {}
    pairs: list[list[int]] = data.contact.geom.tolist()
    found = [*zip(pairs, data.contact.dist.tolist(), strict=True)]
    found += _between_fixed(world.model, data, owners, elements) if also_fixed else []
    for pair, distance in found:
        first, second = sorted(pair, key=lambda geom: (owners[geom] not in elements, owners[geom]))
        one, other = owners[first], owners[second]
        if one != other and one in elements and -distance > TOLERATED:
            names = _named(world, first, one), _named(world, second, other)
            depths[names] = max(depths.get(names, 0.0), -distance)
            elements_of[names] = one, other
    if depths:
        deepest = sorted(depths, key=lambda names: -depths[names])
        said = [f"{one} and {other} overlap by {1000 * depths[one, other]:.0f} mm" for one, other in deepest]
        more = [f"{len(said) - MAX_NAMED} more pairs overlap"] if len(said) > MAX_NAMED else []
        origins = (world.cast.origin(name) for name in elements_of[deepest[0]])
        origin = next((origin for origin in origins if origin is not None), None)
        raise Overlap(f"{'; '.join(said[:MAX_NAMED] + more)}: nothing may overlap at the start", origin=origin)


def _between_fixed(model: Any, data: Any, owners: list[str], elements: set[str]) -> Iterator[tuple[list[int], float]]:
    """Yield pairs of shapes of fixed elements that overlap, and their distance (m). Pedestals of arms are left out."""
    fixed = [
        geom
        for geom in range(model.ngeom)
        if owners[geom] in elements
        and not int(model.body_weldid[model.geom_bodyid[geom]])
        and (model.geom_contype[geom] or model.geom_conaffinity[geom])
        and not str(model.body(int(model.geom_bodyid[geom])).name).endswith(f"/{COLUMN}")
    ]
    for one, other in combinations(fixed, 2):
        apart = float(np.linalg.norm(data.geom_xpos[one] - data.geom_xpos[other]))
        if owners[one] == owners[other] or apart > model.geom_rbound[one] + model.geom_rbound[other]:
            continue
        distance = float(mujoco.mj_geomDistance(model, data, one, other, TOLERATED, None))
        if distance < -TOLERATED:
            yield [one, other], distance


def _named(world: World, geom: int, owner: str) -> str:
    """Return the name of a geom's owner, with the body that the file of an agent fixes to the room beside the arm."""
    model = world.model
    body = int(model.geom_bodyid[geom])
    top = int(model.body_rootid[body])
    agent = world.cast.agents.get(owner)
    if agent is None or any(
        int(model.body_rootid[model.jnt_bodyid[model.joint(f"{owner}/{joint}").id]]) == top for joint in agent.joints
    ):
        return f"'{owner}'"
    return f"'{str(model.body(body).name).removeprefix(f'{owner}/')}' of '{owner}'"
