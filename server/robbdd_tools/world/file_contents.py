"""Reduce the file of an arm to the arm: name its parts, and remove what only makes sense in its author's program."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import ModelSource

LOCKED = 1e5
"""A joint with at least this damping (N s/m, N m s/rad) is locked: at its speed limit, it would need 100 kN or kN m."""
SAME = 1e-9
"""Poses (m, parts of a quaternion) count as the same up to this difference."""
LIGHT, SLENDER = 1e-3, 1e-6
"""Mass (kg) and smallest principal moment (kg m²) of moving links of a URDF file without a mass."""
_FREE = mujoco.mjtJoint.mjJNT_FREE
_changes: dict[str, tuple[str, ...]] = {}


def note_changes(key: str, changes: Iterable[str]) -> None:
    """Record what was changed in the file of the arm with this ``RobotModel.mjcf``."""
    _changes[key] = tuple(changes)


def changes_of(key: str) -> tuple[str, ...]:
    """Return what was changed in the file of an arm, as lines for a report."""
    return _changes.get(key, ())


def reduce_to_arm(spec: Any, source: ModelSource) -> list[str]:
    """Remove floors, lamps, loose objects and mocap bodies, fix locked joints, and name bodies, joints and actuators.

    Return what was changed, as lines for a report. Raises ``SceneError`` for an arm on a floating base.
    """
    name_parts(spec)
    changes = leave_out_scene(spec, source)
    for joint in spec.joints:
        if joint.type in (_FREE, mujoco.mjtJoint.mjJNT_BALL):
            kind = "a free joint" if joint.type == _FREE else "a ball joint"
            text = (
                f"{source.name} has {kind} '{joint.name}': only arms with rotating and sliding joints can be simulated"
            )
            raise SceneError(text, origin=source.origin)
    locked = [str(joint.name) for joint in spec.joints if joint.damping[0] >= LOCKED]
    if locked:
        changes.append(f"joints locked by a damping of {LOCKED:g} or more, fixed: {', '.join(locked)}")
        fix_joints(spec, source, locked)
    return changes


def name_parts(spec: Any) -> None:
    """Name the bodies, joints, actuators and tendons of a file that have no name."""
    for number, body in enumerate(spec.bodies[1:]):
        body.name = body.name or f"part{number}"
    for number, actuator in enumerate(spec.actuators):
        actuator.name = actuator.name or f"actuator{number}"
    for number, joint in enumerate(spec.joints):
        joint.name = joint.name or f"joint{number}"
    for number, tendon in enumerate(spec.tendons):
        tendon.name = tendon.name or f"tendon{number}"


def leave_out_scene(spec: Any, source: ModelSource) -> list[str]:
    """Remove floors, lamps, loose objects and mocap bodies; return what was removed, as lines for a report.

    Fixed objects stay: the arm can collide with them. Raises ``SceneError``.
    """
    for geom in list(spec.worldbody.geoms):
        if geom.type == mujoco.mjtGeom.mjGEOM_PLANE:
            spec.delete(geom)
    for lamp in list(spec.lights):
        spec.delete(lamp)
    mocaps = [body for body in spec.bodies[1:] if body.mocap and not _joints_below(body)]
    tops = list(spec.worldbody.bodies)
    loose = [body for body in tops if _is_loose(body)]
    if not any(_joints_below(body) for body in tops if not _is_loose(body)):
        loose = []
    removed = {
        "bodies that another program would move (mocap)": mocaps,
        "loose objects": loose,
    }
    gone = {str(one.name) for bodies in removed.values() for body in bodies for one in (body, *body.find_all("body"))}
    if not gone:
        return []
    changes = [
        f"{what}, left out: {', '.join(str(one.name) for one in bodies)}" for what, bodies in removed.items() if bodies
    ]
    for camera in [one for one in spec.cameras if one.targetbody in gone]:
        spec.delete(camera)
    for body in (*mocaps, *loose):
        spec.delete(body)
    _drop_dangling(spec, source)
    return changes


def put_at_origin(spec: Any, name: str) -> None:
    """Move the contents of a file so that a body of the world, to which a scene maps the base, is at the origin."""
    body = spec.body(name) if name else None
    if body is None or body.parent.name != "world":
        return
    away, back = np.zeros(3), np.zeros(4)
    place, turn = np.array(body.pos), np.array(body.quat) / np.linalg.norm(body.quat)
    mujoco.mju_negPose(away, back, place, turn)
    if np.abs(place).max() < SAME and np.abs(turn[1:]).max() < SAME:
        return
    world = spec.worldbody
    for part in (*world.bodies, *world.geoms, *world.sites):
        moved, turned = np.zeros(3), np.zeros(4)
        mujoco.mju_mulPose(moved, turned, away, back, np.array(part.pos), np.array(part.quat))
        part.pos, part.quat = moved, turned


def fix_joints(spec: Any, source: ModelSource, names: Iterable[str]) -> None:
    """Remove joints; their bodies stay where the file has them. What drives or measures them is removed, too.

    All joints of the description are rotating or sliding ones. Key frames keep the positions of the others.
    """
    unwanted = frozenset(names)
    if spec.keys:
        model = spec.copy().compile()
        kept = [number for number in range(model.njnt) if str(model.joint(number).name) not in unwanted]
        for number, key in enumerate(spec.keys):
            key.qpos, key.qvel, key.act, key.ctrl = model.key_qpos[number][kept], [], [], []
    for equality in list(spec.equalities):
        if equality.type == mujoco.mjtEq.mjEQ_JOINT and {equality.name1, equality.name2} & unwanted:
            spec.delete(equality)
    for joint in [one for one in spec.joints if one.name in unwanted]:
        spec.delete(joint)
    _drop_dangling(spec, source)


def give_mass(spec: Any, links: Iterable[str]) -> list[str]:
    """Give moving links of a URDF file without a mass a small one; return what was changed."""
    light = [name for name in links if spec.body(name) is not None and spec.body(name).joints]
    for name in light:
        body = spec.body(name)
        body.mass, body.explicitinertial = LIGHT, True
        body.inertia, body.fullinertia = [SLENDER] * 3, [float("nan")] * 6
        body.ipos = [0.0, 0.0, 0.0]
    return [f"moving links without a mass, which got {1000 * LIGHT:g} g: {', '.join(light)}"] if light else []


def make_solid(spec: Any) -> list[str]:
    """Let moving links without collision shapes collide as their visual shapes; return what was changed.

    Otherwise an arm would pass through everything, and its collisions would never be noticed.
    """
    found: list[str] = []
    for body in [one for one in spec.bodies[1:] if one.joints]:
        shapes = [geom for one in _rigid_with(body) for geom in one.geoms]
        if shapes and not any(geom.contype or geom.conaffinity for geom in shapes):
            found.append(str(body.name))
            for geom in shapes:
                geom.contype = geom.conaffinity = 1
    return (
        [f"links without collision shapes, which collide as their visual shapes: {', '.join(found)}"] if found else []
    )


def touch_at_surfaces(spec: Any) -> list[str]:
    """Let shapes exert forces only where they touch; return what was changed.

    With a margin, an arm would push things that are some way off.
    """
    away = [one for one in (*spec.geoms, *spec.pairs) if one.margin or one.gap]
    for one in away:
        one.margin = one.gap = 0.0
    return [f"margins of {len(away)} contacts, removed: they would act at a distance"] if away else []


def _rigid_with(body: Any) -> Iterator[Any]:
    """Yield a body and the bodies that are fixed to it, except those that carry it."""
    yield body
    for child in body.bodies:
        if not child.joints:
            yield from _rigid_with(child)


def _drop_dangling(spec: Any, source: ModelSource) -> None:
    try:
        drop_dangling(spec)
    except ValueError as error:
        words = " ".join(str(error).split())
        raise SceneError(f"the model {source.name} does not compile: {words}", origin=source.origin) from error


def drop_dangling(spec: Any) -> None:
    """Remove the actuators and tendons of removed parts; the engine leaves them out only when it compiles.

    Raises ``ValueError`` if the description does not compile.
    """
    model = spec.copy().compile()
    for kind, parts in _dangling(model).items():
        for one in [one for one in getattr(spec, kind) if one.name not in parts]:
            spec.delete(one)


def _dangling(model: Any) -> Mapping[str, frozenset[str]]:
    """Return the names of the actuators and tendons that a compiled model has."""
    return MappingProxyType(
        {
            "actuators": frozenset(str(model.actuator(number).name) for number in range(model.nu)),
            "tendons": frozenset(str(model.tendon(number).name) for number in range(model.ntendon)),
        }
    )


def _is_loose(body: Any) -> bool:
    """Return whether a body of the world is a loose object: it moves freely, and it carries no joints of an arm."""
    joints = _joints_below(body)
    return len(joints) == 1 and joints[0].type == _FREE and bool(body.joints)


def _joints_below(body: Any) -> list[Any]:
    return [*body.joints, *(joint for one in body.find_all("body") for joint in one.joints)]
