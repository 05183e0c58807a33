"""Models and places of a scenario's elements in an executable scene."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace
from math import atan2
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.base.articulation import Opening
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.frames import Frames
from robbdd_tools.world.gripper_faces import refuse_smooth_faces
from robbdd_tools.world.mobile_base import base_of, lowest_point
from robbdd_tools.world.model_files import FromFile, MovingPart, load, object_from, usable
from robbdd_tools.world.openings import opening_of
from robbdd_tools.world.owners import SCENERY, is_scenery, scenery_name, shape_name
from robbdd_tools.world.pose import Pose
from robbdd_tools.world.robot_files import FLOOR, prepared_robot, robot_from
from robbdd_tools.world.tilted_base import far_from_tables, tilt_of, upright_part
from robbdd_tools.world.tilted_robots import tilted

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import ObjectModel, RobotModel
    from robbdd_tools.catalog.executable import ModelSource, Origin, Realisation, SceneInstance
    from robbdd_tools.world.frames import Transform

TOUCHING, CLEARANCE = 0.01, 0.15
"""A mobile base is on the floor if its lowest part is at most this far above it (m): files may leave out wheels."""
UPRIGHT = 1e-6
PAIR = ("condim", "friction", "solref", "solreffriction", "solimp", "margin", "gap")


@dataclass(frozen=True, slots=True)
class DeclaredPair:
    """A contact between two geoms, with its parameters, as declared in model ``number`` of the whole scene."""

    number: int
    geoms: tuple[str, str]
    parameters: Mapping[str, Any]

    @staticmethod
    def of(number: int, pair: Any) -> DeclaredPair:
        """Return the pair from the engine's editable description."""
        values = ((name, getattr(pair, name)) for name in PAIR)
        kept = {name: value if isinstance(value, int | float) else list(value) for name, value in values}
        return DeclaredPair(number, (str(pair.geomname1), str(pair.geomname2)), kept)


class Staging:
    """One scene instance in one execution. ``seed`` is the seed of random draws."""

    def __init__(self, instance: SceneInstance, seed: int) -> None:
        """Raises ``SceneError`` if a model of the whole scene cannot be loaded."""
        self._elements = {one.element: one for one in instance.elements}
        self.frictions = instance.frictions
        self.boxes = instance.boxes
        self._frames = Frames(instance, seed)
        self._found: dict[str, FromFile] = {}
        self._files: dict[str, FromFile] = {}
        self._part_names: dict[tuple[str, str], str] = {}
        self._worlds = [(source, load(source)) for source in self._usable_worlds(instance)]
        # If a body is removed from its model, the engine drops its pairs.
        self._pairs = [
            DeclaredPair.of(number, pair) for number, (_, spec) in enumerate(self._worlds) for pair in spec.pairs
        ]
        self._world_of: dict[str, int] = {}

    @staticmethod
    def _usable_worlds(instance: SceneInstance) -> list[ModelSource]:
        found = usable(instance.models, "the scene")
        return [] if found is None else [source for source in instance.models if source.format != "usd"]

    @property
    def scenery(self) -> tuple[Any, ...]:
        """The models of the whole scene, without the bodies that are elements of the scene."""
        return tuple(spec for _, spec in self._worlds)

    @property
    def untouchable(self) -> tuple[str, ...]:
        """The bodies of the scenery through which everything passes: all of their shapes are visual."""
        tops = (body for spec in self.scenery for body in spec.worldbody.bodies)
        return tuple(str(body.name) for body in tops if body.name and _is_visual(body))

    @property
    def hollow(self) -> Iterator[tuple[str, float]]:
        """The objects with a hollow mesh, and how many times its volume its convex hull has."""
        return ((element, file.hollow) for element, file in self._files.items() if file.hollow)

    def carriers_first(self, elements: Iterable[str]) -> list[str]:
        """Return elements in the order of their names, with possible moving parts of others last."""
        names = {element.rpartition(":")[2]: element for element in elements}
        parts = {
            element
            for name, element in names.items()
            if self._source(element) is None and (self._hangs_on(name, names.keys()) or not self._has_body(name))
        }
        return sorted(elements, key=lambda element: (element in parts, element))

    def _has_body(self, name: str) -> bool:
        return any(spec.body(name) is not None for _, spec in self._worlds)

    def _hangs_on(self, name: str, others: AbstractSet[str]) -> bool:
        """Return whether a joint connects the body ``name`` to one of the ``others`` in a model of the whole scene."""
        for _, spec in self._worlds:
            body, jointed = spec.body(name), False
            while body is not None and body.name != "world":
                jointed = jointed or any(joint.type != mujoco.mjtJoint.mjJNT_FREE for joint in body.joints)
                body = body.parent
                if jointed and body is not None and body.name in others:
                    return True
        return False

    def object_model(self, element: str, carried: Sequence[str]) -> ObjectModel | None:
        """Return the model of an object, ``None`` if not defined; raises ``SceneError``.

        ``carried`` are the names of the workspaces that it carries. An element without a model is the moving part of
        the same name of an object that was requested before, or else the body of the same name in a model of the whole
        scene.
        """
        chosen = self._source(element)
        if chosen is None:
            return self._part(element) or self._from_world(element, carried)
        if chosen.kind == "catalog":
            found = load_catalog().objects.get(chosen.name)
            if found is None:
                raise SceneError(f"the catalog has no object '{chosen.name}'", origin=chosen.origin)
            if chosen.opening is not None:
                text = f"how the catalog's '{chosen.name}' opens cannot be stated: only files have joints of their own"
                raise SceneError(text, origin=chosen.origin)
            return found
        name = next((name for _, name in chosen.bodies), "")
        # A pose in a file of its own is meaningless in the scene.
        self._files[element] = object_from(load(chosen), chosen, name, carried)
        return self._files[element].model

    def moving_parts(self) -> Iterator[tuple[str, ObjectModel]]:
        """Yield the moving parts of the requested objects, each after the part that carries it."""
        for element, file in self._files.items():
            for part in file.parts:
                yield self._part_name(element, part), self._hung(element, file, part)

    def openings(self) -> Iterator[tuple[str, Opening | str]]:
        """Yield how each requested object opens, or why this is not known. Raises ``SceneError``."""
        for element, file in self._files.items():
            joints = {
                part.joint: (self._part_name(element, part), joint)
                for part in file.parts
                if (joint := part.model.joint) is not None
            }
            if file.model.joint is not None:
                joints[file.joint] = (element, file.model.joint)
            source, whole = self._source(element), None
            if joints or (source is not None and source.opening is not None):
                whole = opening_of(element, joints, source)
                yield element, whole
            for part in file.parts:
                name, joint = self._part_name(element, part), part.model.joint
                if isinstance(whole, Opening) and whole.part == name:
                    # What the scene instance states about the joint concerns its part, too.
                    yield name, whole
                elif joint is not None:
                    yield name, opening_of(name, {part.joint: (name, joint)}, None)

    def _part(self, element: str) -> ObjectModel | None:
        """Return the moving part that an element without a model stands for, ``None`` if there is none."""
        name = element.rpartition(":")[2]
        found = [(owner, one) for owner, file in self._files.items() for one in file.parts if one.body == name]
        if not found:
            return None
        owner, part = found[0]
        if len(found) > 1:
            both = " and of ".join(f"'{one}'" for one, _ in found)
            raise SceneError(
                f"'{element}' has no model, and is a moving part of {both}: rename one in a copy of the file"
            )
        self._part_names[owner, name] = element
        return self._hung(owner, self._files[owner], part)

    def _part_name(self, element: str, part: MovingPart) -> str:
        return self._part_names.get((element, part.body), f"{element}/{part.body}")

    def _hung(self, element: str, file: FromFile, part: MovingPart) -> ObjectModel:
        """Return the model of a part whose joint names the element that carries the part."""
        joint = part.model.joint
        assert joint is not None, "a moving part has a joint"
        carrier = next((one for one in file.parts if one.body == joint.parent), None)
        parent = element if carrier is None else self._part_name(element, carrier)
        return replace(part.model, joint=replace(joint, parent=parent))

    def bystander(self, element: str) -> ObjectModel | None:
        """Return the model of an agent that executes nothing, ``None`` for any other agent."""
        chosen = self._source(element)
        return load_catalog().bystanders.get(chosen.name) if chosen is not None and chosen.kind == "catalog" else None

    def robot(self, element: str, rise: float = 0.0) -> RobotModel | None:
        """Return the model of an agent, ``None`` if not defined; raises ``SceneError``.

        The tables are higher than usual by ``rise`` (m).
        """
        chosen = self._source(element)
        if chosen is None:
            return None
        placed = self.pose(element)
        tilt = None if placed is None else tilt_of(placed, rise)
        if chosen.kind == "catalog":
            found = load_catalog().robots.get(chosen.name)
            if found is None:
                raise SceneError(f"the catalog has no robot '{chosen.name}'", origin=chosen.origin)
            if chosen.arm is not None:
                text = f"'{chosen.name}' of the catalog has its own tool, gripper, home and speeds"
                raise SceneError(f"{text}: remove yours, or name a file", origin=chosen.origin)
            turned = tilted(found, tilt, chosen)
            _refuse_above_floor(turned, placed, chosen)
            return turned
        found = robot_from(chosen, element, tilt or (None if placed is None else far_from_tables(placed, rise)))
        if not any(element in (friction.first, friction.second) for friction in self.frictions):
            refuse_smooth_faces(prepared_robot(found.mjcf), found, chosen.gripper or chosen)
        _refuse_above_floor(found, placed, chosen)
        return found

    def pose(self, element: str, attempt: int = 0) -> Pose | None:
        """Return the place of an element, ``None`` if not defined; raises ``SceneError``.

        The element's own random draws are repeated for each ``attempt``.
        """
        chosen = self._source(element)
        if chosen is None:
            found = self._found.get(element)
            return None if found is None else _pose((found.position, found.rotation))
        bodies = [body for body, _ in chosen.bodies]
        bodies += [body for tree, _ in chosen.trees if (body := self._frames.first_body(tree)) is not None]
        transform = self._frames.pose(bodies[0], element, attempt) if bodies else None
        return None if transform is None else _pose(transform)

    def base(self, element: str) -> Pose | None:
        """Return the upright pose of an agent's base; the robot's tilt is relative to it. Raises ``SceneError``."""
        pose = self.pose(element)
        return None if pose is None else upright_part(pose)[0]

    def origin(self, element: str) -> Origin | None:
        """Return the source position at which the scene defines an element or a model of the whole scene.

        It is ``None`` for anything else.
        """
        if is_scenery(element):
            return self._worlds[int(element[len(SCENERY) :])][0].origin
        said = self._elements.get(element)
        return None if said is None else said.origin

    def pairs_of_elements(self) -> Iterator[tuple[str, str, DeclaredPair]]:
        """Yield the pairs that the models of the whole scene declare for elements, with their geoms in the world."""
        for pair in self._pairs:
            first, second = (self._geom(pair.number, geom) for geom in pair.geoms)
            if not (is_scenery(first[0]) and is_scenery(second[0])):
                yield shape_name(*first), shape_name(*second), pair

    def _geom(self, number: int, geom: str) -> tuple[str, str | int]:
        """Return the element and the shape's number of a model's geom, or else the scenery's and the geom's name."""
        for element, found in self._found.items():
            if self._world_of[element] != number:
                continue
            if geom in found.geoms:
                return element, found.geoms.index(geom)
            for part in found.parts:
                if geom in part.geoms:
                    return self._part_name(element, part), part.geoms.index(geom)
        return scenery_name(number), geom

    def _source(self, element: str) -> ModelSource | None:
        said: Realisation | None = self._elements.get(element)
        return None if said is None else usable(said.models, element)

    def _from_world(self, element: str, carried: Sequence[str]) -> ObjectModel | None:
        name = element.rpartition(":")[2]
        if element in self._found:
            return self._found[element].model
        for number, (source, spec) in enumerate(self._worlds):
            if spec.body(name) is not None:
                self._found[element] = self._files[element] = object_from(spec, source, name, carried)
                self._world_of[element] = number
                spec.delete(spec.body(name))
                return self._found[element].model
        return None


def _is_visual(body: Any) -> bool:
    shapes = body.find_all("geom")
    return bool(shapes) and not any(shape.contype or shape.conaffinity for shape in shapes)


def _pose(transform: Transform) -> Pose:
    position, turn = transform
    w, x, y, z = (float(part) for part in turn)
    place = (float(position[0]), float(position[1]), float(position[2]))
    if np.hypot(x, y) < UPRIGHT:
        return Pose(place, 2 * atan2(z, w))
    return Pose(place, atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)), (w, x, y, z))


def _refuse_above_floor(robot: RobotModel, placed: Pose | None, source: ModelSource) -> None:
    """Refuse a mobile base that is above the floor: it would drive through the air. Raises ``SceneError``."""
    if placed is None or robot.mount[2] != FLOOR or base_of(robot) is None:
        return
    gap = placed.position[2] + lowest_point(robot) - FLOOR
    if gap > (TOUCHING if source.kind == "catalog" else CLEARANCE):
        where = f"its lowest part is {gap:.2f} m above the floor, which is at z = {FLOOR:g} m"
        raise SceneError(f"'{robot.name}' drives on the floor: {where}", origin=source.origin)
