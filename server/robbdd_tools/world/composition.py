"""Compose one simulated world of robots on pedestals, tables, bins and objects, in one model."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import cos, sin
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.base.solid_shapes import Solid, SolidKind
from robbdd_tools.catalog.api import GripperKind, ObjectModel, Shape, ShapeKind
from robbdd_tools.catalog.object_settings import can_move
from robbdd_tools.world.belts import add_belt
from robbdd_tools.world.cast import Cast
from robbdd_tools.world.engine import TIMESTEP, mujoco
from robbdd_tools.world.errors import NoRoomLeft, SceneError
from robbdd_tools.world.friction import (
    ROUGHEST,
    pair_declared,
    pair_given,
    pair_pads,
    pair_stiff,
    rank_by_friction,
    too_rough,
)
from robbdd_tools.world.grip_force import limit_grip
from robbdd_tools.world.laid_out import laid_out
from robbdd_tools.world.mobile_base import base_of
from robbdd_tools.world.owners import scenery_name, shape_name
from robbdd_tools.world.passive_joints import add_joint, pose_at_zero
from robbdd_tools.world.placement import FLOOR, TABLE_TOP, Pose, arrange, mounts
from robbdd_tools.world.robots_in_world import THINGS, add_robots, attach
from robbdd_tools.world.scene import cast_scene
from robbdd_tools.world.solids import ENGINE
from robbdd_tools.world.staging import Staging

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import SceneInstance
    from robbdd_tools.protocol.specs import SceneSpec

TORSION, ROLLING = 0.005, 0.0005
"""Torsional and rolling friction of objects, m; without rolling friction, a ball never comes to rest."""
LIP = 5e-4
"""The lip of a suction cup follows a surface up to this distance (m).

Without it, the first micrometre by which a pull lifts the rigid face would end the vacuum, at a part of its force.
"""


@dataclass(frozen=True, slots=True)
class World:
    """A compiled scene.

    - ``model``: the model of the physics engine.
    - ``bases``: the poses of the robots' bases.
    - ``poses``: the poses of the objects before they settle.
    - ``seed``: the seed of all random choices.
    - ``resampled``: the number of random places that were sampled again because they overlapped or were out of reach.
    - ``no_room``: the objects that are left out, because there is no room for them and no clause mentions them.
    - ``laid_out``: how far (m) ahead of the working robot's base, and to its left, objects on a table were laid out.
    """

    model: Any
    cast: Cast
    bases: Mapping[str, Pose]
    poses: Mapping[str, Pose]
    seed: int
    resampled: int
    laid_out: Mapping[str, tuple[float, float]] = field(default_factory=dict[str, tuple[float, float]])
    no_room: tuple[str, ...] = ()


def build_world(scene: SceneSpec, seed: int, actor: str | None = None, instance: SceneInstance | None = None) -> World:
    """Build the world of a scene.

    All random choices derive from ``seed`` or from the seed in the scene's configuration. ``actor`` is the agent for
    which objects are laid out; by default, the first agent. ``instance`` has models and places of elements. Objects
    that no clause mentions are left out if there is no room for them. Raises ``SceneError`` if an element has no model,
    a place does not exist or there is no room for another object.
    """
    try:
        return _build(scene, seed, actor, instance)
    except NoRoomLeft as error:
        if error.name not in scene.unused:
            raise
        others = tuple(name for name in scene.objects if name != error.name)
        built = build_world(replace(scene, objects=others), seed, actor, instance)
        return replace(built, no_room=(error.name, *built.no_room))


def _build(scene: SceneSpec, seed: int, actor: str | None, instance: SceneInstance | None) -> World:
    staging = None if instance is None else Staging(instance, _seed_of(scene, seed))
    cast = cast_scene(scene, staging)
    bases = mounts(cast)
    if actor is not None and actor not in bases:
        raise cast.without_robot(actor)
    base = bases[actor] if actor is not None else next(iter(bases.values()), Pose((0.0, 0.0, TABLE_TOP)))
    seed = seed if cast.seed is None else cast.seed
    name = actor if actor is not None else next(iter(bases), None)
    is_mobile = name is not None and base_of(cast.agents[name]) is not None
    arranged = arrange(scene, cast, base, np.random.default_rng(seed), is_mobile=is_mobile)
    model = compile_world(cast, bases, arranged.poses)
    places = laid_out(scene, cast, base, arranged.poses, is_mobile=is_mobile)
    return World(model, cast, bases, arranged.poses, seed, arranged.resampled, places)


def compile_objects(cast: Cast) -> Any:
    """Return a compiled model of the objects alone, all at the origin, from which they can be drawn."""
    alone = replace(cast, agents={}, staging=None)
    return compile_world(alone, {}, {name: Pose((0.0, 0.0, 0.0)) for name in cast.objects})


def _seed_of(scene: SceneSpec, seed: int) -> int:
    """Return the seed configured for the scene, if any."""
    written = next((config.value for config in scene.config if config.name == "seed"), "")
    return int(written) if written.isdecimal() else seed


def compile_world(cast: Cast, bases: Mapping[str, Pose], poses: Mapping[str, Pose]) -> Any:
    """Return the engine's compiled model of a scene. Raises ``SceneError``."""
    spec = mujoco.MjSpec()
    _set_options(spec)
    _add_room(spec)
    for number, scenery in enumerate(() if cast.staging is None else cast.staging.scenery):
        _add_scenery(spec, scenery, f"{scenery_name(number)}/", len(bases))
    for name, model in cast.objects.items():
        carrier = cast.objects.get("" if model.joint is None else model.joint.parent)
        pose = poses[name] if carrier is None or model.joint is None else pose_at_zero(model, carrier)
        _add_object(spec, name, model, pose, len(bases))
    add_robots(spec, cast.agents, bases)
    for name, robot in cast.agents.items():
        if (force := cast.chosen.get((name, "grip_force"))) is not None:
            limit_grip(spec, name, robot, force[0])
        lip = LIP if robot.gripper is GripperKind.SUCTION else 0.0
        _pull_from(spec, [f"{name}/{pad}" for pad in robot.pads], cast.chosen.get((name, "attach_distance"), (lip,))[0])
    shapes = {name: [shape_name(name, i) for i in range(len(one.shapes))] for name, one in cast.objects.items()}
    faces = {name: [f"{name}/{pad}" for pad in robot.pads] for name, robot in cast.agents.items()}
    _yield_slowly(spec, cast, shapes | faces)
    pads = [pad for own in faces.values() for pad in own]
    loose = [
        shape_name(name, i) for name, model in cast.objects.items() if can_move(model) for i in range(len(model.shapes))
    ]
    _refuse_rough(spec, cast)
    pair_pads(spec, pads, loose)
    jaws = {name for name, model in cast.objects.items() if model.joint is not None}
    jaws |= {model.joint.parent for model in cast.objects.values() if model.joint is not None and model.joint.parent}
    parts = [name for name, model in cast.objects.items() if model.graspable and name not in jaws]
    pair_stiff(
        spec, [geom for name in sorted(jaws) for geom in shapes[name]], [g for name in parts for g in shapes[name]]
    )
    if cast.staging is not None:
        pair_declared(spec, cast.staging.pairs_of_elements())
        pair_given(spec, cast.staging.frictions, shapes | faces)
    rank_by_friction(spec, pads)
    if any(equality.type == mujoco.mjtEq.mjEQ_TENDON for equality in spec.equalities):
        # The engine cannot wake bodies that tendons of equal length connect.
        spec.option.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return spec.compile()
    except ValueError as error:
        raise SceneError(f"the scene does not compile: {error}") from error


def _refuse_rough(spec: Any, cast: Cast) -> None:
    """Raise ``SceneError`` if files give a gripper and a part a friction that nothing has: it would carry anything."""
    pairs = {frozenset((one.first, one.second)) for one in (() if cast.staging is None else cast.staging.frictions)}
    for name, robot in cast.agents.items():
        for thing, model in cast.objects.items():
            if not model.graspable or frozenset((name, thing)) in pairs:
                continue
            shapes = [shape_name(thing, number) for number in range(len(model.shapes))]
            coefficient = too_rough(spec, [f"{name}/{pad}" for pad in robot.pads], shapes)
            if coefficient:
                text = f"the files of '{name}' and '{thing}' both give a friction of {coefficient:g} or more"
                stated = "State that of the pair: friction of obj <…> on agn <…>: 0.8"
                origin = cast.origin(thing) or cast.origin(name)
                raise SceneError(f"{text}; at most {ROUGHEST:g} can be simulated. {stated}", origin=origin)


def _set_options(spec: Any) -> None:
    option = spec.option
    option.timestep = TIMESTEP
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    option.solver = mujoco.mjtSolver.mjSOL_NEWTON
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    option.impratio = 10.0
    # A NaN state must be detected, not silently reset to the initial one.
    option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    option.enableflags |= int(mujoco.mjtEnableBit.mjENBL_SLEEP)


def _add_room(spec: Any) -> None:
    plane = mujoco.mjtGeom.mjGEOM_PLANE
    floor = spec.worldbody.add_geom(name="floor", type=plane, size=[0, 0, 0.05], pos=[0, 0, FLOOR])
    floor.rgba = [0.62, 0.64, 0.66, 1.0]
    spec.worldbody.add_light(name="lamp", pos=[0.4, -0.6, 2.5], dir=[0.0, 0.2, -1.0])
    spec.visual.headlight.ambient = [0.35, 0.35, 0.35]
    spec.visual.headlight.diffuse = [0.45, 0.45, 0.45]


def _add_object(spec: Any, name: str, model: ObjectModel, pose: Pose, robots: int) -> None:
    turn = list(pose.rotation) or [cos(pose.yaw / 2), 0.0, 0.0, sin(pose.yaw / 2)]
    joint = model.joint
    carrier = spec.worldbody if joint is None or not joint.parent else spec.body(joint.parent)
    body = carrier.add_body(name=name, pos=list(pose.position), quat=turn)
    if model.free:
        body.add_freejoint()
    if joint is not None:
        add_joint(spec, body, name, model)
    if model.inertia is not None:
        body.explicitinertial, body.mass = True, model.mass
        body.ipos = list(model.inertia.center)
        body.fullinertia = [model.mass * moment for moment in model.inertia.moments]
    volumes = [_volume(shape) for shape in model.shapes]
    for index, (shape, volume) in enumerate(zip(model.shapes, volumes, strict=True)):
        carrier = body if shape.surface is None else add_belt(spec, body, f"{name}/belt{index}", shape.surface)
        geom = carrier.add_geom(name=shape_name(name, index), type=_geom_type(shape.kind), size=list(shape.size))
        geom.pos = list(shape.position)
        geom.mass = model.mass * volume / sum(volumes)
        geom.friction = [model.friction if shape.friction is None else shape.friction, TORSION, ROLLING]
        geom.condim = 4 if shape.kind is ShapeKind.BOX else 6
        geom.rgba = list(shape.color or model.color)
        if shape.solid is not None:
            _use_solid(spec, geom, shape, shape.solid)
        geom.contype = THINGS
        geom.conaffinity = THINGS | sum(2 << index for index in range(robots))


def _use_solid(spec: Any, geom: Any, shape: Shape, solid: Solid) -> None:
    """Replace a shape's bounding box by the solid from the file."""
    geom.type = ENGINE[solid.kind]
    geom.condim = 4 if solid.kind in (SolidKind.BOX, SolidKind.MESH) else 6
    if solid.kind is SolidKind.MESH:
        # The object gives the mass, as a flat mesh has no volume.
        points = [coordinate for vertex in solid.vertices for coordinate in vertex]
        spec.add_mesh(name=f"{geom.name}/hull", uservert=points, inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX)
        geom.meshname = f"{geom.name}/hull"
        return
    geom.size = list(solid.size)
    geom.pos = [place + way for place, way in zip(shape.position, solid.offset, strict=True)]
    geom.quat = list(solid.rotation)


def _add_scenery(spec: Any, scenery: Any, prefix: str, robots: int) -> None:
    """Add the contents of a model of the whole scene that are not elements."""
    child = scenery.copy()
    for geom in child.geoms:
        if geom.contype or geom.conaffinity:
            geom.contype = THINGS
            geom.conaffinity = THINGS | sum(2 << index for index in range(robots))
    attach(spec, child, prefix, spec.worldbody.add_frame())


def _pull_from(spec: Any, pads: list[str], distance: float) -> None:
    """Let a vacuum pull from a distance (m): in this gap, the engine's contacts exert no force but adhesion."""
    for pad in pads if distance else ():
        spec.geom(pad).gap = distance


def _yield_slowly(spec: Any, cast: Cast, geoms: Mapping[str, list[str]]) -> None:
    """Give contacts the time constant (s) configured for an element, with critical damping."""
    for (element, name), value in cast.chosen.items():
        for geom in geoms[element] if name == "contact_time" else ():
            spec.geom(geom).solref = [value[0], 1.0]


def _geom_type(kind: ShapeKind) -> Any:
    kinds = mujoco.mjtGeom
    return {
        ShapeKind.BOX: kinds.mjGEOM_BOX,
        ShapeKind.SPHERE: kinds.mjGEOM_SPHERE,
        ShapeKind.CYLINDER: kinds.mjGEOM_CYLINDER,
    }[kind]


def _volume(shape: Shape) -> float:
    a, b, c = shape.size
    match shape.kind:
        case ShapeKind.BOX:
            return 8 * a * b * c
        case ShapeKind.SPHERE:
            return 4 / 3 * np.pi * a**3
        case ShapeKind.CYLINDER:
            return 2 * np.pi * a**2 * b
