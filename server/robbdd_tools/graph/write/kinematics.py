"""Write kinematic trees and graphs as triples: bodies, their frames, and the placement of frames.

The name of a frame is the name of its tree or graph followed by the path of the frame (``…/arm.base.origin``). An
instance of a tree has copies of the template's parts under its own name.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robbdd_tools.graph.write.rotations import numbers_of, rotation_of
from robbdd_tools.graph.write.units import ANGLES, LENGTHS, MASSES
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from rdflib import URIRef
    from rdflib.term import Node

    from robbdd_tools.graph.write.sink import Frame

Owner = tree.KinematicTree | tree.Graph
MAX_STEPS = 50
"""Maximum number of trees through which a name is resolved, because trees may contain one another."""


@dataclass(slots=True)
class Trees:
    """All trees and graphs by qualified name, each with its node and its declaration.

    The node of a template is ``None``.
    """

    owners: dict[str, tuple[URIRef | None, Owner]] = field(default_factory=dict[str, tuple["URIRef | None", Owner]])

    def node(self, path: str, scopes: tuple[str, ...] = ()) -> str | None:
        """Return the IRI of a qualified name, or ``None`` if there is none.

        The name is looked up in the scopes first.
        """
        for candidate in (*(f"{scope}.{path}" for scope in scopes), path):
            found = self._found(candidate)
            if found is not None:
                return found
        return None

    def _found(self, path: str) -> str | None:
        for _ in range(MAX_STEPS):
            owner = next((name for name in _prefixes(path) if name in self.owners), None)
            if owner is None:
                return None
            node, declared = self.owners[owner]
            rest = path[len(owner) + 1 :]
            if not rest:
                return None if node is None else str(node)
            if node is not None and _has(declared, rest):
                return f"{node}.{rest}"
            first, _, inner = rest.partition(".")
            used = next((use.reference.path for use in _uses(declared) if _last(use.reference.path) == first), None)
            if used is None:
                return None
            path = f"{used}.{inner}" if inner else used
        return None


def _prefixes(path: str) -> Iterator[str]:
    parts = path.split(".")
    return (".".join(parts[:length]) for length in range(len(parts), 0, -1))


def _last(path: str) -> str:
    return path.rpartition(".")[2]


def _uses(owner: Owner) -> Iterator[tree.TreeUse]:
    return (entry for entry in owner.entries if isinstance(entry, tree.TreeUse))


def _has(owner: Owner, path: str) -> bool:
    """Return whether a tree has a body, or a body has a frame, with this name."""
    body, _, frame = path.partition(".")
    for entry in owner.entries:
        if isinstance(entry, tree.RigidBody) and entry.name.text == body:
            return not frame or any(isinstance(p, tree.Frame) and p.name.text == frame for p in entry.parts)
    return False


@dataclass(frozen=True, slots=True)
class TreeWriter:
    """Writes the parts of a tree or graph.

    - ``owner``: the tree or graph that declares the parts.
    - ``node``: the node to which the parts are added.
    - ``path``: the qualified name of that node.
    - ``scopes``: the paths to which names may be relative, innermost last.
    - ``template``: the name by which the parts of an instance may refer to their own tree.
    """

    frame: Frame
    trees: Trees
    owner: Owner
    node: URIRef
    path: str
    scopes: tuple[str, ...]
    template: str = ""

    def write(self) -> None:
        """Write all triples of the tree or graph."""
        sink, owner = self.frame.sink, self.owner
        parts: list[Node | None] = []
        for entry in owner.entries:
            match entry:
                case tree.RigidBody():
                    parts.append(self._body(entry))
                case tree.Joints():
                    parts += [self._joint(joint, number) for number, joint in enumerate(entry.entries)]
                case tree.TreeUse():
                    parts.append(self._named(entry.reference))
        sink.add(self.node, "rbw:parts", sink.make_list(parts))
        root = owner.root if isinstance(owner, tree.KinematicTree) else owner.anchor
        if root is not None:
            sink.add(self.node, "rbw:root", self._named(root), self.frame.at(root))

    def _named(self, reference: tree.Ref, body: str = "") -> URIRef | None:
        path = reference.path
        if self.template and path.startswith(f"{self.template}."):
            path = self.path + path[len(self.template) :]
        within = (f"{self.path}.{body}",) if body else ()
        return self.frame.sink.iri(self.trees.node(path, (*within, self.path, *self.scopes)))

    def _body(self, body: tree.RigidBody) -> URIRef | None:
        sink, place = self.frame.sink, self.frame.at(body.name)
        node = sink.iri(f"{self.node}.{body.name.text}")
        if node is None:
            return None
        sink.add_types(node, ["rbw:Body"], place)
        frames = [part for part in body.parts if isinstance(part, tree.Frame)]
        sink.add(node, "rbw:frames", sink.make_list([self._frame(node, body.name.text, part) for part in frames]))
        for part in body.parts:
            if isinstance(part, tree.Inertia):
                self._inertia(node, body.name.text, part)
        return node

    def _inertia(self, node: URIRef, body: str, inertia: tree.Inertia) -> None:
        sink = self.frame.sink
        sink.add(node, "rbw:inertia-frame", self._named(inertia.frame, body), self.frame.at(inertia.frame))
        if inertia.mass is not None:
            mass = float(inertia.mass.value) * MASSES[inertia.mass_unit or "kg"]
            sink.add(node, "rbw:mass-kilograms", sink.literal(mass), self.frame.at(inertia.mass))
        if inertia.matrix is not None:
            numbers = [sink.literal(number) for number in numbers_of(inertia.matrix)]
            sink.add(node, "rbw:inertia-matrix", sink.make_list(numbers), self.frame.at(inertia.matrix))

    def _frame(self, body: URIRef, name: str, written: tree.Frame) -> URIRef | None:
        sink = self.frame.sink
        node = sink.iri(f"{body}.{written.name.text}")
        if node is not None:
            sink.add_types(node, ["rbw:Frame"], self.frame.at(written.name))
            poses = [self._pose(node, name, pose) for pose in written.poses]
            sink.add(node, "rbw:poses", sink.make_list(poses))
        return node

    def _pose(self, owner: URIRef, body: str, pose: tree.Pose) -> URIRef | None:
        sink, place = self.frame.sink, self.frame.at(pose.name)
        node = sink.iri(f"{owner}.{pose.name.text}")
        if node is None:
            return None
        sink.add_types(node, ["rbw:Pose"], place)
        if pose.wrt is not None:
            target = self._named(pose.wrt, body)
            sink.add(node, "rbw:with-respect-to", target, self.frame.at(pose.wrt))
        self._length(node, "rbw:position", pose.position, pose.unit)
        value = pose.orientation if isinstance(pose.orientation, tree.Sample) else pose.orientation.value
        if isinstance(value, tree.Sample):
            target = self.frame.target(value.distribution)
            sink.add(node, "rbw:orientation-sample", target, self.frame.at(value))
        elif (turn := rotation_of(value)) is not None:
            numbers = [sink.literal(number) for number in turn]
            sink.add(node, "rbw:orientation", sink.make_list(numbers), self.frame.at(value))
        return node

    def _length(self, node: URIRef, term: str, value: tree.Vector | tree.Sample, unit: str) -> None:
        sink = self.frame.sink
        if isinstance(value, tree.Sample):
            sink.add(node, f"{term}-sample", self.frame.target(value.distribution), self.frame.at(value))
            sink.add(node, "rbw:unit-metres", sink.literal(LENGTHS[unit]))
        else:
            numbers = [sink.literal(number * LENGTHS[unit]) for number in numbers_of(value)]
            sink.add(node, term, sink.make_list(numbers), self.frame.at(value))

    def _joint(self, joint: tree.Node, number: int) -> URIRef | None:
        sink = self.frame.sink
        match joint:
            case tree.FixedJoint():
                kind, name = "rbw:FixedJoint", joint.name.text
                ends = {"parent": joint.parent_frame, "child": joint.child_frame}
            case tree.RevoluteJoint():
                kind, name = "rbw:RevoluteJoint", joint.name.text
                ends = {"parent": joint.parent_frame.frame, "child": joint.child_frame.frame}
            case tree.SerialChain():
                kind, name, ends = (
                    "rbw:SerialChain",
                    f"chain-{number}",
                    {"chain-root": joint.root, "chain-tip": joint.tip},
                )
            case _:
                return None
        node = sink.iri(f"{self.node}.{name}")
        if node is None:
            return None
        sink.add_types(node, [kind], self.frame.at(joint))
        for end, reference in ends.items():
            sink.add(node, f"rbw:{end}", self._named(reference), self.frame.at(reference))
        if isinstance(joint, tree.RevoluteJoint):
            self._revolute(node, joint)
        return node

    def _revolute(self, node: URIRef, joint: tree.RevoluteJoint) -> None:
        sink = self.frame.sink
        sink.add(node, "rbw:parent-axis", sink.literal(joint.parent_frame.axis))
        sink.add(node, "rbw:child-axis", sink.literal(joint.child_frame.axis))
        for detail in joint.details:
            match detail:
                case tree.JointOffset():
                    self._length(node, "rbw:position", detail.position, detail.unit)
                case tree.Limits():
                    for limit in detail.limits:
                        factor = ANGLES.get(limit.unit.partition("/")[0], 1.0)
                        numbers = [sink.literal(number * factor) for number in numbers_of(limit.range)]
                        sink.add(node, f"rbw:{limit.quantity}-limits", sink.make_list(numbers), self.frame.at(limit))
                case tree.Mimic():
                    sink.add(node, "rbw:mimics", sink.iri(f"{self.node}.{_last(detail.joint.path)}"))
                    numbers = [sink.literal(float(part.value)) for part in (detail.multiplier, detail.offset)]
                    sink.add(node, "rbw:mimic-line", sink.make_list(numbers), self.frame.at(detail))
                case tree.Polarity():
                    sink.add(node, "rbw:polarity", sink.literal(detail.value), self.frame.at(detail))
                case tree.Actuation():
                    sink.add(node, "rbw:gear-ratio", sink.literal(float(detail.ratio.value)), self.frame.at(detail))
                    for term, words in (("command", detail.commands), ("state", detail.states)):
                        interfaces = sink.make_list([sink.literal(word) for word in words])
                        sink.add(node, f"rbw:{term}-interfaces", interfaces)
