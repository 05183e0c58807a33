"""Faults of a scene instance that every run would have: models that cannot be used, and given poses that overlap.

Nothing is sampled or stepped, and users' code is not executed. Elements that depend on these are left out.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.catalog.standard_places import without_place
from robbdd_tools.world.cast import Cast
from robbdd_tools.world.composition import World, compile_world
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.extent import centred
from robbdd_tools.world.frames import PoseError
from robbdd_tools.world.model_files import usable
from robbdd_tools.world.overlaps import refuse_overlaps
from robbdd_tools.world.simulation import Simulation
from robbdd_tools.world.staging import Staging
from robbdd_tools.world.table_rise import rise_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import ObjectModel, RobotModel
    from robbdd_tools.catalog.executable import ModelSource, Realisation, SceneInstance
    from robbdd_tools.world.pose import Pose

SEEDS = (1, 2)
"""Two seeds: a pose that differs between them is sampled."""


@dataclass(slots=True)
class Placed:
    """The elements of a scene instance with a model and a given pose."""

    objects: dict[str, ObjectModel] = field(default_factory=dict[str, "ObjectModel"])
    agents: dict[str, RobotModel] = field(default_factory=dict[str, "RobotModel"])
    poses: dict[str, Pose] = field(default_factory=dict[str, "Pose"])


def fixed_faults(instance: SceneInstance) -> Iterator[SceneError]:
    """Yield the faults of the models of a scene instance, of its poses, and the overlaps between given poses."""
    instance = without_code(instance)
    try:
        staging, other = (Staging(instance, seed) for seed in SEEDS)
    except SceneError as error:
        yield error
        return
    placed = Placed()
    for one in things_first(instance):
        try:
            place(one, staging, placed, other)
        except SceneError as error:
            yield error
    try:
        refuse_overlaps(simulated(staging, placed), also_fixed=True)
    except SceneError as error:
        yield error


def things_first(instance: SceneInstance) -> list[Realisation]:
    """Return the elements of a scene instance with agents last: their homes depend on the heights of tables."""
    return sorted(instance.elements, key=lambda one: one.is_agent)


def without_code(instance: SceneInstance) -> SceneInstance:
    """Return the instance without the models that users' code creates or that other findings already report."""
    elements = (one for one in instance.elements if _is_known(usable_model(one.models, one.element)))
    models = tuple(model for model in instance.models if model.kind != "python")
    return replace(instance, models=models, elements=tuple(elements))


def usable_model(models: tuple[ModelSource, ...], element: str) -> ModelSource | None:
    """Return the model of an element that a run uses; ``None`` if there is none."""
    try:
        return usable(models, element)
    except SceneError:
        return None


def _is_known(model: ModelSource | None) -> bool:
    if model is None or model.kind == "python":
        return False
    catalog = load_catalog()
    return model.kind != "catalog" or model.name in (catalog.objects.keys() | catalog.robots.keys())


def place(one: Realisation, staging: Staging, placed: Placed, other: Staging | None = None) -> None:
    """Add an element to the placed ones if it has a model and a pose. Raises ``SceneError``.

    If ``other`` is the same instance with another seed, an element with a sampled pose is left out.
    """
    name = one.element
    if one.is_agent and staging.bystander(name) is None:
        robot, base = staging.robot(name, rise_of(placed.objects, placed.poses.get)), staging.base(name)
        if robot is not None and base is not None and (other is None or base == other.base(name)):
            placed.agents[name], placed.poses[name] = robot, base
        return
    model = staging.bystander(name) or staging.object_model(name, ())
    pose = staging.pose(name)
    for _ in staging.openings():
        pass  # Raises the faults of openings.
    if model is not None and pose is None and not model.free and not model.places:
        raise PoseError(without_place(name, model), origin=one.origin)
    if model is not None and pose is not None and (other is None or pose == other.pose(name)):
        placed.objects[name], placed.poses[name] = centred(model), pose


def simulated(staging: Staging, placed: Placed) -> Simulation:
    """Return a world of the placed elements that has not been stepped. Raises ``SceneError`` if it does not compile."""
    objects = dict(placed.objects)
    for name, model in staging.moving_parts():
        if model.joint is not None and model.joint.parent in objects:
            objects[name] = centred(model)
    cast = Cast(objects, placed.agents, {}, {}, None, staging=staging)
    poses = {name: pose for name in placed.objects if (pose := cast.pose(name)) is not None}
    bases = {name: placed.poses[name] for name in placed.agents}
    return Simulation(World(compile_world(cast, bases, poses), cast, bases, poses, SEEDS[0], 0))
