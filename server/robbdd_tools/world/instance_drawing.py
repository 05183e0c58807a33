"""Draw a scene instance before anything moves: shapes and poses as plain data. Users' code is not executed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robbdd_tools.world.drawn_shapes import DIGITS, geometry
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.fixed_faults import SEEDS, Placed, place, simulated, things_first, without_code
from robbdd_tools.world.log_views import drawn_bodies
from robbdd_tools.world.overlaps import refuse_overlaps
from robbdd_tools.world.staging import Staging

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import SceneInstance

SOLID = "/solid"


def drawn_instance(instance: SceneInstance) -> tuple[dict[str, Any], list[SceneError]]:
    """Return a scene instance in the form of ``docs/schemas/scene.schema.json``, and its faults.

    Poses are sampled with the first seed. Elements without a pose, and elements with a model that users' code creates,
    are in ``missing``.
    """
    known, faults, placed, sampled = without_code(instance), list[SceneError](), Placed(), Placed()
    drawn: dict[str, Any] = {"shapes": [], "meshes": [], "workspaces": [], "bodies": [], "sampled": []}
    try:
        staging, other = (Staging(known, seed) for seed in SEEDS)
        for one in things_first(known):
            try:
                place(one, staging, sampled)
                place(one, staging, placed, other)
            except SceneError as error:
                faults.append(error)
        simulation = simulated(staging, sampled)
        drawn |= _contents(simulation.model, simulation.data)
        drawn["sampled"] = sorted(sampled.poses.keys() - placed.poses.keys())
        refuse_overlaps(simulated(staging, placed))
    except SceneError as error:
        faults.append(error)
    drawn["missing"] = sorted(one.element for one in instance.elements if one.element not in sampled.poses)
    return drawn, faults


def _contents(model: Any, data: Any) -> dict[str, Any]:
    mujoco.mj_kinematics(model, data)
    names = drawn_bodies(model)
    found = geometry(model, names, {})
    numbers = {name: number for number, name in enumerate(names.values())}
    bodies = [
        {
            "name": name.removesuffix(SOLID),
            "position": data.xpos[body].round(DIGITS).tolist(),
            "orientation": data.xquat[body].round(DIGITS).tolist(),
        }
        for body, name in names.items()
    ]
    return {**found, "shapes": [{**one, "body": numbers[one["body"]]} for one in found["shapes"]], "bodies": bodies}
