"""Choose models for the elements of a scene, and find the regions of its workspaces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import chain
from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Region, RobotModel
from robbdd_tools.catalog.name_words import parts_named, spaces_of
from robbdd_tools.catalog.object_settings import can_move, object_has
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.world.cast import Cast
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.extent import carrying, centred
from robbdd_tools.world.frames import PoseError, is_rotation
from robbdd_tools.world.openings import opening_of
from robbdd_tools.world.resizing import extent_of
from robbdd_tools.world.scene_configuration import Configured, configure
from robbdd_tools.world.table_rise import rise_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Set

    from robbdd_tools.base.articulation import Opening
    from robbdd_tools.catalog.api import ObjectModel, Vector
    from robbdd_tools.catalog.executable import WorkspaceBox
    from robbdd_tools.protocol.specs import ConfigSpec, SceneSpec
    from robbdd_tools.world.staging import Staging

MAX_LISTED = 12
PEDESTAL = "pedestal"
"""Name of the table that is added to a scene without fixed objects."""


def local_name(curie: str) -> str:
    """Return the part of a CURIE after its last colon."""
    return curie.rpartition(":")[2]


def cast_scene(scene: SceneSpec, staging: Staging | None = None, *, of_log: bool = False) -> Cast:
    """Choose models for the elements of a scene, and configure them.

    Models are from the executable scene, or else from the catalog by name. In a log, an element may do without
    (``Cast.points``). Raises ``SceneError`` for any other name without a model and for an impossible configuration.
    """
    catalog = load_catalog()
    objects: dict[str, ObjectModel] = {}
    left_out: list[str] = []
    points: dict[str, str] = {}
    by_name: list[str] = []
    # Sorted: results must not depend on the order in which a model declares its objects.
    for name in sorted(scene.objects) if staging is None else staging.carriers_first(scene.objects):
        carried = tuple(local_name(workspace) for workspace, own in scene.workspaces.items() if name in own)
        model = None if staging is None else staging.object_model(name, carried)
        if model is None and (model := catalog.object_for(local_name(name), scene.sets.get(name, ()))) is not None:
            by_name.append(name)
        if model is not None:
            objects[name] = model
        elif of_log and (carried or name not in scene.unused):
            points[name] = "object"
        elif name in scene.unused:
            left_out.append(name)
        else:
            raise SceneError(_no_model("object", name, (m.prefixes for m in catalog.objects.values())))
    rise = 0.0 if staging is None else rise_of(objects, staging.pose)
    agents: dict[str, RobotModel] = {}
    for name in scene.agents:
        model = _agent_model(scene, staging, name, rise)
        # Bystanders are present only where an executable scene places them.
        if name in scene.unused and (model is None or staging is None or staging.base(name) is None):
            left_out.append(name)
            continue
        if model is None and of_log:
            points[name] = "agent"
            continue
        if model is None:
            raise SceneError(_no_model("agent", name, (m.prefixes for m in catalog.agents)))
        if isinstance(model, RobotModel):
            agents[name] = model
        else:
            objects[name] = model
    objects = {name: objects[name] for name in sorted(objects)}
    openings: dict[str, Opening | str] = {}
    if staging is not None:
        moving = dict(staging.moving_parts())
        objects = {name: model for name, model in objects.items() if name not in moving} | moving
        openings = dict(staging.openings())
    _add_moving(objects, openings)
    objects |= {name: carrying(objects[name]) for name in _bare_carriers(scene, objects)}
    if not of_log and all(can_move(model) or model.bystander for model in objects.values()):
        objects[PEDESTAL] = catalog.objects["table"]
    stated = tuple(_stated(scene, objects))
    extents = {name: extent_of(model) for name, model in objects.items()}
    found = Configured(objects, agents, openings, points)
    configure(found, ((config, _elements(scene, config.target)) for config in (*scene.config, *stated)))
    objects |= {name: centred(model) for name, model in objects.items()}
    regions = _regions(scene, objects, points.keys())
    frames = {**dict.fromkeys(points, (0.0, 0.0, 0.0)), **{name: model.frame for name, model in objects.items()}}
    regions |= _stated_regions(scene, frames, regions, () if staging is None else staging.boxes)
    regions |= _unions(scene, regions)
    return Cast(
        objects,
        agents,
        regions,
        found.ranges,
        found.seed,
        found.drops,
        found.chosen,
        found.judged,
        staging,
        tuple(left_out),
        extents,
        openings,
        points,
        tuple(by_name),
    )


def _stated(scene: SceneSpec, objects: Mapping[str, ObjectModel]) -> Iterator[ConfigSpec]:
    """Yield what properties state about objects with a model of the catalog, and what no Given clause sets."""
    own = {(name, config.name) for config in scene.config for name in _elements(scene, config.target)}
    catalog = load_catalog().objects
    for one in scene.stated:
        model = None if (one.target, one.name) in own else objects.get(one.target)
        if model is not None and model is catalog.get(model.name) and object_has(model, one.name):
            yield one


def _agent_model(scene: SceneSpec, staging: Staging | None, name: str, rise: float) -> RobotModel | ObjectModel | None:
    """Return the model of an agent: a robot's, or an object's if the agent is a bystander. Raises ``SceneError``."""
    stated = None if staging is None else staging.bystander(name) or staging.robot(name, rise)
    catalog, names = load_catalog(), (local_name(name), scene.sets.get(name, ()))
    return stated or catalog.robot_for(*names) or catalog.bystander_for(*names)


def _add_moving(objects: dict[str, ObjectModel], openings: dict[str, Opening | str]) -> None:
    """Add the moving parts of the catalog's models to ``objects``, and how they open to ``openings``."""
    for name, model in tuple(objects.items()):
        if model.moving is not None and model.moving.joint is not None:
            part, joint = f"{name}/{model.moving.name}", replace(model.moving.joint, parent=name)
            objects[part] = replace(model.moving, joint=joint)
            openings[name] = opening_of(name, {model.moving.name: (part, joint)}, None)


def _bare_carriers(scene: SceneSpec, objects: Mapping[str, ObjectModel]) -> Iterator[str]:
    """Yield the objects that carry a workspace although neither they nor their moving parts have a region."""
    for name in {one: None for own in scene.workspaces.values() for one in own if one in objects}:
        if not any(objects[one].region or objects[one].parts for one in moving_with(name, objects)):
            yield name


def moving_with(name: str, objects: Mapping[str, ObjectModel]) -> tuple[str, ...]:
    """Return an object and the moving parts that it carries, at any depth."""
    found = [name]
    for one, model in objects.items():
        # A part follows its carrier.
        if model.joint is not None and model.joint.parent in found:
            found.append(one)
    return tuple(found)


def _elements(scene: SceneSpec, target: str) -> tuple[str, ...]:
    """Return the objects that carry a workspace. Return any other target itself."""
    return carriers(scene, target) or (target,)


def _no_model(kind: str, name: str, prefixes: Iterable[tuple[str, ...]]) -> str:
    known = sorted(prefix for group in prefixes for prefix in group)
    words = f"{', '.join(known[:MAX_LISTED])}{' …' if len(known) > MAX_LISTED else ''}"
    return (
        f"there is no model for {kind} '{name}': its name, or its set's, must contain one of {words}; "
        "or give it a model in a .scenex that --scenex or an execution of a .bddx names"
    )


def _regions(
    scene: SceneSpec, objects: Mapping[str, ObjectModel], points: Set[str]
) -> dict[str, tuple[tuple[str, Region], ...]]:
    regions: dict[str, tuple[tuple[str, Region], ...]] = {}
    for workspace in (one for one, own in scene.workspaces.items() if own):
        boxes: list[tuple[str, Region]] = []
        for carrier in carriers(scene, workspace):
            model = objects.get(carrier)
            if model is None and (carrier in scene.unused or carrier in points):
                continue
            if model is None:
                raise SceneError(f"workspace '{workspace}' is carried by '{carrier}', which is not in the scene")
            boxes += _spaces(carrier, local_name(workspace), objects)
        if not points.isdisjoint(carriers(scene, workspace)):
            regions[workspace] = ()
        elif boxes:
            regions[workspace] = tuple(boxes)
    return regions


def _unions(
    scene: SceneSpec, regions: Mapping[str, tuple[tuple[str, Region], ...]]
) -> dict[str, tuple[tuple[str, Region], ...]]:
    """Return the regions of the workspaces that nothing carries: those of the workspaces inside them."""
    found: dict[str, tuple[tuple[str, Region], ...]] = {}
    for workspace in scene.contains:
        if workspace not in regions and not scene.workspaces.get(workspace):
            inner = [regions[one] for one in contents_of(scene, workspace) if one in regions]
            found |= {workspace: tuple(dict.fromkeys(chain.from_iterable(inner)))} if inner else {}
    return found


def _stated_regions(
    scene: SceneSpec,
    frames: Mapping[str, Vector],
    regions: Mapping[str, tuple[tuple[str, Region], ...]],
    stated: Iterable[WorkspaceBox],
) -> dict[str, tuple[tuple[str, Region], ...]]:
    """Return the regions of the workspaces whose boxes an executable scene states.

    ``frames`` are the origins of the objects' frames (m), from their positions. A box in a walled object, such as a
    bin, has its walls around it. Raises ``PoseError``.
    """
    found: dict[str, tuple[tuple[str, Region], ...]] = {}
    for box in stated:
        _refuse_impossible(box)
        walled = any(region.walled for _, region in regions.get(box.workspace, ()))
        for carrier in carriers(scene, box.workspace):
            if carrier in frames:
                center = tuple(one + other for one, other in zip(frames[carrier], box.offset, strict=True))
                region = Region(vector(center), vector(edge / 2 for edge in box.size), walled=walled, turn=box.turn)
                found[box.workspace] = (*found.get(box.workspace, ()), (carrier, region))
    return found


def _refuse_impossible(box: WorkspaceBox) -> None:
    """Raise ``PoseError`` for a box that is none: without it, other spaces of its workspace would count."""
    if len(box.offset) != 3 or len(box.size) != 3 or min(box.size) <= 0.0:
        lacks = "3 numbers for its centre and 3 edges greater than 0"
    elif box.turn and not is_rotation(box.turn):
        lacks = "an orientation that is a rotation"
    else:
        return
    raise PoseError(f"a box of the workspace '{local_name(box.workspace)}' needs {lacks}", origin=box.origin)


def vector(values: Iterable[float]) -> Vector:
    """Return three numbers as a vector."""
    x, y, z = values
    return x, y, z


def _spaces(carrier: str, workspace: str, objects: Mapping[str, ObjectModel]) -> list[tuple[str, Region]]:
    """Return the regions of a workspace that an object carries, each with the object in whose frame it is.

    For an object with moving parts, these are the regions whose name is contained in the workspace's name; if there are
    none, the regions without a name; if there are none, all regions.
    """
    members = moving_with(carrier, objects)
    if len(members) == 1:
        return [(carrier, region) for region in spaces_of(objects[carrier], local_name(workspace))]
    every = [(one, part) for one in members for part in objects[one].parts]
    names = parts_named([part.name for _, part in every], local_name(workspace))
    named = [(one, part) for one, part in every if part.name in names]
    plain = [(one, region) for one in members if (region := objects[one].region) is not None]
    return named or plain or every


def contents_of(scene: SceneSpec, workspace: str) -> tuple[str, ...]:
    """Return the workspaces inside a workspace, at any depth, in written order."""
    found: dict[str, None] = {}
    waiting = list(scene.contains.get(workspace, ()))
    while waiting:
        inner = waiting.pop(0)
        if inner not in found and inner != workspace:
            found[inner] = None
            waiting += scene.contains.get(inner, ())
    return tuple(found)


def carriers(scene: SceneSpec, workspace: str) -> tuple[str, ...]:
    """Return the objects that carry a workspace.

    If nothing carries it directly, return the carriers of the workspaces inside it.
    """
    return _carriers(scene, workspace, frozenset())


def _carriers(scene: SceneSpec, workspace: str, seen: frozenset[str]) -> tuple[str, ...]:
    own = scene.workspaces.get(workspace, ())
    if own or workspace in seen:
        return own
    inner = scene.contains.get(workspace, ())
    return tuple(name for part in inner for name in _carriers(scene, part, seen | {workspace}))
