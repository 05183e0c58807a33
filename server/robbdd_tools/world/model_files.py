"""Find and read the model files that an executable scene names, and convert them for a simulated world."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.interpreter import started_in
from robbdd_tools.base.model_includes import unusable
from robbdd_tools.base.model_paths import package_share
from robbdd_tools.catalog.api import ObjectModel, Region, Shape
from robbdd_tools.user_code.calls import UserCodeError, call_user_code, definition_of, load_attribute, refused
from robbdd_tools.world.constraints import refuse_constraints
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.extent import bounds_of, own_space, with_walls
from robbdd_tools.world.model_meshes import hollow_meshes, read_model, refuse_filled
from robbdd_tools.world.moving_parts import (
    handle_of,
    is_free,
    joint_bodies,
    joint_name,
    joint_of,
    name_of_body,
    rigid_root,
)
from robbdd_tools.world.solids import inertia_in, shape_in
from robbdd_tools.world.urdf_files import speeds
from robbdd_tools.world.workspace_sites import spaces_of_sites, workspace_sites

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.catalog.executable import ModelSource

LIGHTEST = 1e-3
"""Smallest mass (kg) of a loose object, as in a configuration: lighter ones cannot be gripped and put down reliably."""


def usable(models: Sequence[ModelSource], element: str) -> ModelSource | None:
    """Return a model of an element that can be simulated, ``None`` without any; raises ``SceneError`` for USD."""
    found = next((model for model in models if model.format != "usd"), None)
    if found is None and models:
        message = f"'{element}' has a USD model only, which this simulator cannot load: name an MJCF or URDF model too"
        raise SceneError(message, origin=models[0].origin)
    return found


def load(source: ModelSource) -> Any:
    """Return the engine's editable description of a model; raises ``SceneError``."""
    if source.kind == "python":
        return _from_code(source)
    path = path_of(source)
    if not path.exists():
        raise SceneError(f"there is no model file {path}", origin=source.origin)
    problem = unusable(path)
    if problem is not None:
        raise SceneError(f"the model file {path} cannot be used: {problem.reason}", origin=source.origin)
    try:
        spec = _read(str(path)).copy()
    except (ValueError, OSError) as error:
        words = " ".join(str(error).split())  # the engine's messages have several lines
        raise SceneError(f"the model file {path} cannot be read: {words}", origin=source.origin) from error
    # Links fixed to others keep their names: the tool or a body of the scene may refer to them.
    spec.compiler.fusestatic = False
    _refuse_reversed(spec, source)
    return spec


def _refuse_reversed(spec: Any, source: ModelSource) -> None:
    """Refuse limits whose ends are reversed, which the engine takes for none. Raises ``SceneError``."""
    for joint in spec.joints:
        low, high = (float(end) for end in joint.range)
        is_off = joint.limited == mujoco.mjtLimited.mjLIMITED_FALSE and source.format != "urdf"
        if low > high and not is_off:
            text = f"the joint '{joint.name}' in {source.name} has the limits {low:g} to {high:g}: swap them"
            raise SceneError(text, origin=source.origin)


@cache
def _read(path: str) -> Any:
    return read_model(Path(path))


def _read_made(path: Path) -> Any:
    problem = unusable(path)
    if problem is not None:
        raise ValueError(problem.reason)
    return _read(str(path))


def velocity_limits(source: ModelSource, spec: Any, joints: Sequence[str], default: float) -> tuple[float, ...]:
    """Return the speed limits (rad/s, m/s) of joints, or ``default`` for a joint without a limit.

    They are those of a URDF file, or the ``ctrlrange`` of velocity servos in ``spec``, the description of the file.
    """
    stated = speeds(path_of(source)) if source.kind in ("file", "ros") else {}
    servos = _servo_speeds(spec)
    return tuple(stated.get(joint) or servos.get(joint) or default for joint in joints)


def _servo_speeds(spec: Any) -> dict[str, float]:
    """Return the largest speed (rad/s, m/s), in both directions, that a velocity servo of a joint can be given."""
    found: dict[str, float] = {}
    for one in spec.actuators:
        is_servo = one.biastype == mujoco.mjtBias.mjBIAS_AFFINE and one.biasprm[1] == 0.0 and one.gainprm[0] > 0.0
        low, high = (float(bound) for bound in one.ctrlrange)
        if one.trntype == mujoco.mjtTrn.mjTRN_JOINT and is_servo and one.biasprm[2] < 0.0 and low < 0.0 < high:
            found[str(one.target)] = min(-low, high) / abs(float(one.gear[0]) or 1.0)
    return found


def path_of(source: ModelSource) -> Path:
    """Return the path of a model file; raises ``SceneError`` if its ROS package is not found."""
    path = Path(source.name).expanduser()
    if source.kind == "ros":
        share, reason = package_share(source.package)
        if share is None:
            raise SceneError(f"the ROS package '{source.package}' cannot be found: {reason}", origin=source.origin)
        return share / path
    return (started_in() if source.origin is None else Path(source.origin.file).parent) / path


def _from_code(source: ModelSource) -> Any:
    """Call the code, which returns MJCF text, the path of a file, or the engine's own description."""
    model = "" if source.origin is None else source.origin.file
    try:
        make = load_attribute(source.name, model)
        made = call_user_code(source.name, make)
        try:
            if isinstance(made, str) and made.lstrip().startswith("<"):
                return mujoco.MjSpec.from_string(made)
            return _read_made(Path(made)) if isinstance(made, str | Path) else made.copy()
        except (ValueError, AttributeError) as error:
            raise refused(source.name, f"{source.name} created no model: {error}", definition_of(make)) from error
    except UserCodeError as error:
        raise SceneError(str(error), replace(error.fault, origin=source.iri), source.origin) from error


SLACK = 1e-6
"""Files round: a mass may be below the smallest one by this share."""


@dataclass(frozen=True, slots=True)
class MovingPart:
    """A moving part of an object from a file: the names of its body, of its joint and of its shapes in the file."""

    body: str
    joint: str
    model: ObjectModel
    geoms: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class FromFile:
    """An object from its file; ``position`` (m) and ``rotation`` (quaternion) are its pose in the file.

    ``geoms`` are the names of the model's shapes in the file, in their order. ``parts`` are its moving parts, each
    after the part that carries it. ``body`` and ``joint`` are the names of the object's body and of its joint, if any,
    in the file. ``hollow`` says how many times the volume of a hollow mesh its convex hull has; it is 0 without one.
    """

    model: ObjectModel
    position: FloatArray
    rotation: FloatArray
    geoms: tuple[str, ...]
    body: str
    joint: str
    parts: tuple[MovingPart, ...]
    hollow: float


def object_from(spec: Any, source: ModelSource, body_name: str, carried: Sequence[str]) -> FromFile:
    """Return an object from a body of a file, by default the first; raises ``SceneError``.

    It consists of the collision shapes of the body and of everything fixed to it, with their friction and colours, and
    its mass is distributed as in the file. A mesh is its convex hull. It can move if the file gives it a free joint or,
    in URDF, a mass. If it carries workspaces, ``carried`` are their names, or is fixed, its workspaces are box sites,
    else its inside or the space above it. Bodies with joints are moving parts; their workspaces are box sites.
    """
    model = compiled(spec, source)
    body = _body(model, source, body_name)
    data: Any = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    moving = tuple(joint_bodies(model, body))
    own = [one for one in range(model.nbody) if rigid_root(model, one, body) is not None]
    refuse_constraints(model, own, source)
    hollow = max(hollow_meshes(model, own).values(), default=0.0)
    sites = workspace_sites(model, own, carried)
    refuse_filled(model, data, sites, own, source)
    spaces = spaces_of_sites(model, data, sites, (body, *moving), body)
    parts = tuple(_part(model, data, one, body, source, spaces) for one in moving)
    main = _Rigid(model, data, body, body, source)
    low, _ = bounds_of(main.shapes)
    free = is_free(model, body) if source.format != "urdf" else float(model.body_mass[body]) > 0
    jointed = not free and bool(int(model.body_jntnum[body]))
    if free:
        _refuse_light(main.mass, source)
    own = next((region for region in spaces.get(body, ()) if not region.name and (carried or not free)), None)
    # A fixed thing with several workspaces is a table, too, for what has no place of its own.
    if own is None and (carried or not free) and not jointed and not (spaces and (moving or free)):
        own = own_space(main.shapes)
    chosen = ObjectModel(
        name=source.iri,
        prefixes=(),
        shapes=main.shapes,
        mass=max(main.mass, LIGHTEST),
        friction=main.friction,
        free=free,
        graspable=free and not carried and not parts,
        rest_height=-float(low[2]),
        color=main.color,
        doc=f"from {source.name}",
        region=None if own is None else with_walls(own, main.shapes),
        parts=spaces.get(body, ()) if any(region.name for region in spaces.get(body, ())) else (),
        joint=replace(joint_of(model, data, body, 0, source), handle=main.handle) if jointed else None,
        inertia=main.inertia if free or jointed else None,
    )
    name, joint = name_of_body(model, body), joint_name(model, body) if jointed else ""
    return FromFile(chosen, data.xpos[body].copy(), data.xquat[body].copy(), main.names, name, joint, parts, hollow)


def _refuse_light(mass: float, source: ModelSource) -> None:
    """Raise ``SceneError`` for a loose object that would have to be simulated with another mass than its file's."""
    if mass < LIGHTEST * (1 - SLACK):
        least = f"at least {1000 * LIGHTEST:g} g can be simulated: state the mass of its shapes in kg"
        raise SceneError(f"the object in {source.name} weighs {1000 * mass:.3g} g; {least}", origin=source.origin)


class _Rigid:
    """The collision shapes of a body and of everything fixed to it, in the frame of the body, and their mass (kg)."""

    def __init__(self, model: Any, data: Any, body: int, root: int, source: ModelSource) -> None:
        """Raises ``SceneError`` if it has no collision shape."""
        own = [index for index in range(model.nbody) if rigid_root(model, index, root) == body]
        self.geoms = [
            g
            for g in range(model.ngeom)
            if model.geom_bodyid[g] in own and model.geom_contype[g] | model.geom_conaffinity[g]
        ]
        if not self.geoms:
            raise SceneError(f"the body '{model.body(body).name}' has no collision shape", origin=source.origin)
        self.friction = float(model.geom_friction[self.geoms[0], 0])
        self.color = _color(model.geom_rgba[self.geoms[0]])
        self.shapes = tuple(self._looking(model, geom, shape_in(model, data, geom, body)) for geom in self.geoms)
        self.inertia = inertia_in(model, data, own, body, self.shapes)
        self.names = tuple(str(model.geom(geom).name) for geom in self.geoms)
        bodies = [str(model.body(int(model.geom_bodyid[geom])).name) for geom in self.geoms]
        # Skip the name of the moving body itself: it is no name of a shape.
        bodies = [
            name if number != body else "" for name, number in zip(bodies, model.geom_bodyid[self.geoms], strict=True)
        ]
        self.handle = handle_of(f"{one} {other}" for one, other in zip(self.names, bodies, strict=True))
        self.mass = float(sum(model.body_mass[index] for index in own))

    def _looking(self, model: Any, geom: int, shape: Shape) -> Shape:
        """Return a shape with its own friction and colour if they differ from the first shape's."""
        friction, painted = float(model.geom_friction[geom, 0]), _color(model.geom_rgba[geom])
        return replace(
            shape,
            friction=None if friction == self.friction else friction,
            color=None if painted == self.color else painted,
        )


def _part(
    model: Any, data: Any, body: int, root: int, source: ModelSource, sites: Mapping[int, tuple[Region, ...]]
) -> MovingPart:
    rigid = _Rigid(model, data, body, root, source)
    parent = rigid_root(model, int(model.body_parentid[body]), root)
    assert parent is not None, "a moving part is below its object"
    regions = sites.get(body, ())
    made = ObjectModel(
        name=source.iri,
        prefixes=(),
        shapes=rigid.shapes,
        mass=max(rigid.mass, LIGHTEST),
        friction=rigid.friction,
        free=False,
        graspable=False,
        rest_height=0.0,
        color=rigid.color,
        doc=f"a moving part from {source.name}",
        region=next((region for region in regions if not region.name), None),
        parts=tuple(region for region in regions if region.name),
        joint=replace(joint_of(model, data, body, parent, source), handle=rigid.handle),
        inertia=rigid.inertia,
    )
    return MovingPart(name_of_body(model, body), joint_name(model, body), made, rigid.names)


def compiled(spec: Any, source: ModelSource) -> Any:
    """Return the compiled model of a description, which is not modified; raises ``SceneError``."""
    try:
        return spec.copy().compile()
    except ValueError as error:
        words = " ".join(str(error).split())
        raise SceneError(f"the model {source.name} does not compile: {words}", origin=source.origin) from error


def _body(model: Any, source: ModelSource, name: str) -> int:
    names = [str(model.body(index).name) for index in range(1, model.nbody)]
    if not names:
        raise SceneError(f"the model {source.name} has no body", origin=source.origin)
    if name and name not in names:
        raise SceneError(f"{source.name} has no body '{name}'; it has {', '.join(names)}", origin=source.origin)
    return names.index(name) + 1 if name else 1


def _color(numbers: Any) -> tuple[float, float, float, float]:
    red, green, blue, opacity = (float(number) for number in numbers)
    return (red, green, blue, opacity)
