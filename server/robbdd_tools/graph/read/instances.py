"""Read executable scenes into plain data. Incomplete scenes are left out."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import product
from typing import TYPE_CHECKING

from robbdd_tools.catalog.executable import (
    ArmModel,
    Body,
    Friction,
    Law,
    Link,
    ModelSource,
    MountedGripper,
    OpeningModel,
    Origin,
    Realisation,
    SceneInstance,
    WorkspaceBox,
    spherical,
)
from robbdd_tools.graph.acceptance_model import Iri
from robbdd_tools.graph.rdf.records import Incomplete, Records
from robbdd_tools.graph.rdf.vocabulary import ELEMENT_TYPES

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robbdd_tools.graph.acceptance_model import Value

Places = Callable[[str], Origin | None]
"""Returns the source position of a node, or ``None`` if it is unknown."""
_LAWS = {
    "rbw:UniformRotation": "uniform-rotation",
    "rbw:UniformDistribution": "uniform",
    "rbw:NormalDistribution": "normal",
}
_POSE_TERMS = ("rbw:with-respect-to", "rbw:position-sample", "rbw:orientation-sample")
_GRIPPER = ("rbw:gripper-open", "rbw:gripper-closed", "rbw:stroke-metres")
_JOINTS = {"rbw:FixedJoint": "fixed", "rbw:RevoluteJoint": "revolute"}


def python_name(records: Records, node: str) -> str:
    """Return the name ``module:attribute`` of the Python code that a node describes. Raises ``Incomplete``."""
    module, attribute = records.text(node, "py:module-name"), records.text(node, "py:attribute-name")
    if not (module and attribute):
        raise Incomplete(f"{node} names no Python code")
    return f"{module}:{attribute}"


def number(records: Records, node: str, term: str) -> float | None:
    """Return the value of a property as a number, or ``None`` if it is missing or not a number."""
    value = records.literal(node, term)
    return value if isinstance(value, int | float) else None


class InstanceReader:
    """Reads scene instances. ``sets`` are the constant sets of the graph."""

    def __init__(self, records: Records, sets: Mapping[Iri, tuple[Value, ...]], places: Places) -> None:
        self._records = records
        self._sets = sets
        self._places = places

    def instance(self, node: Iri) -> SceneInstance:
        """Return a scene instance with the contents of its kinematic graphs."""
        records = self._records
        parts = list(self._parts(self._list(node, "rbw:graphs"), set()))
        bodies = [part for part in parts if records.is_a(part, "rbw:Body")]
        frames = [frame for body in bodies for frame in self._list(body, "rbw:frames")]
        poses = [(frame, pose) for frame in frames for pose in self._list(frame, "rbw:poses")]
        links = [self._pose(frame, pose) for frame, pose in poses]
        joints = [(part, kind) for part in parts for term, kind in _JOINTS.items() if records.is_a(part, term)]
        links += [link for part, kind in joints for link in self._joint(part, kind)]
        roots = [
            root for graph in self._list(node, "rbw:graphs") for root in records.iris(records.all(graph, "rbw:root"))
        ]
        placed = {link.frame for link in links}
        return SceneInstance(
            node,
            tuple(self._models(node)),
            tuple(self._elements(node)),
            tuple(Body(body, tuple(self._list(body, "rbw:frames")), self._places(body)) for body in bodies),
            tuple(links),
            tuple(self._laws({law for link in links for law in (link.position_law, link.rotation_law) if law})),
            next(iter([*roots, *(frame for frame in frames if frame not in placed)]), ""),
            self._places(node),
            next(iter(records.iris(records.all(node, "rbw:scene"))), ""),
            tuple(pair for part in self._list(node, "rbw:frictions") for pair in self._friction(part)),
            boxes=tuple(box for part in self._list(node, "rbw:realisations") for box in self._boxes(part)),
        )

    def _list(self, node: str, term: str) -> tuple[Iri, ...]:
        records = self._records
        try:
            return records.iris(records.list_of(node, term))
        except Incomplete:
            return ()

    def _numbers(self, node: str, term: str) -> tuple[float, ...]:
        records = self._records
        try:
            values = [records.value(entry) for entry in records.list_of(node, term)]
        except Incomplete:
            return ()
        return tuple(float(value) for value in values if isinstance(value, int | float))

    def _parts(self, owners: tuple[Iri, ...], seen: set[str]) -> Iterator[Iri]:
        """Yield the bodies and joints of some kinematic graphs and of the trees in them, in written order."""
        for owner in owners:
            if owner in seen:
                continue
            seen.add(owner)
            if self._records.all(owner, "rbw:parts"):
                yield from self._parts(self._list(owner, "rbw:parts"), seen)
            else:
                yield owner

    def _pose(self, frame: Iri, pose: Iri) -> Link:
        records = self._records
        one = {term: next(iter(records.iris(records.all(pose, term))), "") for term in _POSE_TERMS}
        return Link(
            frame,
            one["rbw:with-respect-to"],
            "pose",
            self._numbers(pose, "rbw:position"),
            self._numbers(pose, "rbw:orientation"),
            one["rbw:position-sample"],
            one["rbw:orientation-sample"],
            number(records, pose, "rbw:unit-metres") or 1.0,
            origin=self._places(pose),
        )

    def _joint(self, joint: Iri, kind: str) -> Iterator[Link]:
        records = self._records
        try:
            parent, child = records.one(joint, "rbw:parent"), records.one(joint, "rbw:child")
        except Incomplete:
            return
        axes = (records.text(joint, "rbw:parent-axis"), records.text(joint, "rbw:child-axis"))
        position = self._numbers(joint, "rbw:position")
        origin = self._places(joint)
        yield Link(child, parent, kind, position, axes=axes if all(axes) else (), origin=origin)

    def _laws(self, used: set[str]) -> Iterator[Law]:
        for node in sorted(used):
            kind = next((kind for term, kind in _LAWS.items() if self._records.is_a(node, term)), "")
            if not kind:
                continue
            mean, covariance = self._numbers(node, "rbw:mean"), self._numbers(node, "rbw:covariance")
            deviation = self._numbers(node, "rbw:standard-deviation")
            if deviation:
                covariance = spherical(deviation[0], len(mean))
            low, high = self._numbers(node, "rbw:lower"), self._numbers(node, "rbw:upper")
            yield Law(node, kind, low, high, mean, covariance, self._places(node))

    def _elements(self, node: Iri) -> Iterator[Realisation]:
        """Yield elements with their models. The entry of an element takes precedence over the entry of its set."""
        found: dict[Iri, Realisation] = {}
        for part in self._list(node, "rbw:realisations"):
            models, origin = tuple(self._models(part)), self._places(part)
            for target in self._records.iris(self._records.all(part, "rbw:realises")):
                if target not in self._sets:
                    if models:
                        found[target] = self._realisation(target, models, origin)
                    continue
                members = (entry for entry in self._sets[target] if isinstance(entry, Iri))
                if models:
                    found = {entry: self._realisation(entry, models, origin) for entry in members} | found
        yield from found.values()

    def _realisation(self, element: Iri, models: tuple[ModelSource, ...], origin: Origin | None) -> Realisation:
        return Realisation(element, models, origin, self._records.is_a(element, ELEMENT_TYPES["agent"]))

    def _models(self, owner: Iri) -> Iterator[ModelSource]:
        records = self._records
        for node in self._list(owner, "rbw:models"):
            try:
                kind, name = self._source(node)
                arm = self._arm(node)
            except Incomplete:
                continue
            bodies, trees = self._mappings(node, "rbw:Body"), self._mappings(node, "rbw:KinematicTree")
            form, package = records.text(node, "rbw:format"), records.text(node, "rbw:ros-package")
            opening = self._opening(node)
            yield ModelSource(node, form, kind, name, package, bodies, trees, arm, self._places(node), opening)

    def _source(self, node: Iri) -> tuple[str, str]:
        records = self._records
        catalog, path = records.text(node, "rbw:catalog-name"), records.text(node, "rbw:path")
        if catalog:
            return "catalog", catalog
        if path:
            return ("ros" if records.text(node, "rbw:ros-package") else "file"), path
        return "python", python_name(records, node)

    def _mappings(self, node: Iri, kind: str) -> tuple[tuple[str, str], ...]:
        records = self._records
        found: list[tuple[str, str]] = []
        for mapping in self._list(node, "rbw:mappings"):
            targets = records.iris(records.all(mapping, "rbw:stands-for"))
            found += [(target, records.text(mapping, "rbw:name")) for target in targets if records.is_a(target, kind)]
        return tuple(found)

    def _arm(self, node: Iri) -> ArmModel | None:
        records = self._records
        tool, actuator = (records.text(node, term) for term in ("rbw:tool", "rbw:gripper-actuator"))
        try:
            pads = tuple(str(records.value(pad)) for pad in records.list_of(node, "rbw:gripper-pads"))
        except Incomplete:
            pads = ()
        opened, closed, stroke = (number(records, node, term) for term in _GRIPPER)
        home, velocity = self._numbers(node, "rbw:home"), self._numbers(node, "rbw:velocity-limits")
        mounted = self._mounted_gripper(node)
        arm = ArmModel(tool, actuator, opened, closed, pads, stroke or 0.0, home, velocity, mounted)
        return None if arm == ArmModel() else arm

    def _mounted_gripper(self, node: Iri) -> MountedGripper | None:
        records = self._records
        for gripper in records.iris(records.all(node, "rbw:mounted-gripper")):
            kind, name = self._source(gripper)
            mount, package = (records.text(gripper, term) for term in ("rbw:mount", "rbw:ros-package"))
            place, turn = self._numbers(gripper, "rbw:position"), self._numbers(gripper, "rbw:orientation")
            usual = MountedGripper(kind, name, mount, package)
            return replace(usual, position=place or usual.position, rotation=turn or usual.rotation)
        return None

    def _opening(self, node: Iri) -> OpeningModel | None:
        terms = ("rbw:opening-joint", "rbw:opening-closed", "rbw:opening-open")
        opening = OpeningModel(*(self._records.text(node, term) for term in terms))
        return None if opening == OpeningModel() else opening

    def _friction(self, node: Iri) -> Iterator[Friction]:
        """Yield the friction between two elements or sets for each pair of elements."""
        records = self._records
        value = number(records, node, "rbw:coefficient")
        try:
            first, second = (self._members(records.one(node, term)) for term in ("rbw:first", "rbw:second"))
        except Incomplete:
            return
        for one, other in product(first, second):
            if value is not None and one != other:
                yield Friction(one, other, value, self._places(node))

    def _boxes(self, node: Iri) -> Iterator[WorkspaceBox]:
        """Yield the spaces of a workspace, also impossible ones."""
        records = self._records
        for workspace in records.iris(records.all(node, "rbw:realises")):
            for box in self._list(node, "rbw:boxes"):
                offset, size = self._numbers(box, "rbw:position") or (0.0, 0.0, 0.0), self._numbers(box, "rbw:edges")
                turn = self._numbers(box, "rbw:orientation")
                yield WorkspaceBox(workspace, offset, size, turn, self._places(box))

    def _members(self, node: Iri) -> tuple[Iri, ...]:
        return tuple(entry for entry in self._sets.get(node, (node,)) if isinstance(entry, Iri))
