"""Write elements, sets, compositions and scenes as triples, and compute the members of scenes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robbdd_tools.graph.rdf.vocabulary import ELEMENT_TYPES, MEMBERSHIPS
from robbdd_tools.graph.write.sink import Frame, Sink, namespace_of
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from rdflib import URIRef
    from rdflib.term import Node

    from robbdd_tools.graph.write.property_sets import PropertySets

SET_TYPES = ("bdd:Set", "bdd:ConstantSet")
_LINKED_SETS = {"ObjectSet": "object", "WorkspaceSet": "workspace", "AgentSet": "agent"}
Members = Mapping[str, tuple["URIRef", ...]]
"""Kind of element → elements in written order, each once."""


@dataclass(frozen=True, slots=True)
class _Composition:
    workspace: URIRef | None
    entries: tuple[tuple[str, URIRef], ...]


@dataclass(slots=True)
class Scenes:
    """Data of the sets, compositions and scenes written so far, by node.

    The members of variants are computed from it.
    """

    selected: PropertySets
    sets: dict[URIRef, tuple[str, tuple[URIRef, ...]]] = field(
        default_factory=dict["URIRef", tuple[str, tuple["URIRef", ...]]]
    )
    compositions: dict[URIRef, _Composition] = field(default_factory=dict["URIRef", _Composition])
    scenes: dict[URIRef, tuple[URIRef, ...]] = field(default_factory=dict["URIRef", tuple["URIRef", ...]])

    def members(self, scene: URIRef) -> Members:
        """Return the members of a scene. A nested composition counts as its workspace."""
        found = [member for entry in self.scenes.get(scene, ()) for member in self._of_entry(entry)]
        return {kind: _unique(node for its, node in found if its == kind) for kind in ELEMENT_TYPES}

    def _of_entry(self, entry: URIRef) -> Iterator[tuple[str, URIRef]]:
        if entry in self.sets:
            kind, members = self.sets[entry]
            yield from ((kind, member) for member in members)
        composition = self.compositions.get(entry)
        if composition is None:
            return
        if composition.workspace is not None:
            yield "workspace", composition.workspace
        for kind, node in composition.entries:
            nested = self.compositions.get(node)
            if kind != "composition":
                yield kind, node
            elif nested is not None and nested.workspace is not None:
                yield "workspace", nested.workspace

    def named_set_members(self, frame: Frame, variation: tree.Table | tree.Product) -> Members:
        """Return the members of the element sets that a variation names, for example by ``obj set <…>``."""
        found: list[tuple[str, tuple[URIRef, ...]]] = []
        for link in _links(variation):
            node = frame.target(link.reference)
            if node is not None and node in self.sets:
                kind, members = self.sets[node]
                found.append((kind, members if link.where is None else self.selected.members(frame, link) or ()))
        return {
            kind: _unique(member for its, members in found if its == kind for member in members)
            for kind in ELEMENT_TYPES
        }


@dataclass(slots=True)
class Memberships:
    """Assigns nodes for the membership of elements in a scene.

    Such a node has its published IRI or, if the node of this IRI already has other members, another IRI.
    """

    sink: Sink
    _known: dict[tuple[URIRef, str], list[tuple[URIRef, tuple[URIRef, ...]]]] = field(
        default_factory=dict[tuple["URIRef", str], list[tuple["URIRef", tuple["URIRef", ...]]]]
    )

    def node(self, scene: URIRef, kind: str, template_scene: URIRef, members: tuple[URIRef, ...]) -> URIRef:
        """Return the node that makes ``members`` members of a template's scene. Add the node if it is new."""
        from rdflib import URIRef

        known = self._known.setdefault((scene, kind), [])
        is_new = (template_scene, members) not in known
        if is_new:
            known.append((template_scene, members))
        number = known.index((template_scene, members)) + 1
        node = URIRef(scene + MEMBERSHIPS[kind][2] + (f"-{number}" if number > 1 else ""))
        self.sink.mark_node(node, self.sink.claims[scene])
        if is_new:
            self._state(node, kind, template_scene, members)
        return node

    def _state(self, node: URIRef, kind: str, template_scene: URIRef, members: tuple[URIRef, ...]) -> None:
        type_, term, _ = MEMBERSHIPS[kind]
        self.sink.add_types(node, [type_])
        self.sink.add(node, "bdd:of-scene", template_scene)
        for member in members:
            self.sink.add(node, term, member)
        self.sink.add(node, "rbw:member-list", self.sink.make_list(members))


def add_element_set(frame: Frame, scenes: Scenes, declared: tree.ElementSet) -> None:
    """Add ``obj set``, ``ws set`` or ``agn set`` and its members."""
    node = frame.claimed(declared.name.text, declared.name)
    if node is None:
        return
    members: list[URIRef] = []
    for member in declared.members:
        element = frame.claimed(f"{declared.name.text}.{member.name.text}", member.name)
        if element is not None:
            frame.sink.add_types(element, [ELEMENT_TYPES[declared.kind]], frame.at(member.name))
            frame.sink.mark(node, "bdd:elements", element, frame.at(member.name))
            members.append(element)
            _add_fitting_objects(frame, scenes.selected, element, member)
            namespace = namespace_of(element, member.name.text)
            _add_properties(frame, namespace, element, member.properties)
    scenes.sets[node] = (declared.kind, tuple(members))
    add_set(frame, node, declared.name, members)


def _add_fitting_objects(frame: Frame, selected: PropertySets, workspace: URIRef, member: tree.Member) -> None:
    """Add the objects, or sets of objects, for which a workspace is the correct place."""
    for link in member.correct_for:
        target = selected.target(frame, link.reference, link.where)
        if target is not None:
            frame.sink.add(workspace, "rbw:correct-for", target, frame.at(link.reference))


def _add_properties(frame: Frame, namespace: str, element: URIRef, properties: Iterable[tree.Property]) -> None:
    """Add the declared properties of an element, in the namespace of its set."""
    for stated in properties:
        term = frame.sink.iri(namespace + stated.name.text)
        for written in stated.values if term is not None else ():
            value = frame.target(written) if isinstance(written, tree.Ref) else frame.sink.value(written)
            if value is not None:
                frame.sink.add(element, str(term), value, frame.at(stated))


def add_similar_set(frame: Frame, scenes: Scenes, declared: tree.SimilarSet) -> None:
    """Add a ``similar`` set and its numbered members."""
    node = frame.claimed(declared.name.text, declared.name)
    if node is None:
        return
    members: list[URIRef] = []
    for index in range(_count(declared.count)):
        element = frame.node(f"{declared.name.text}.{declared.base.text}{index}")
        if element is None:
            break
        if frame.sink.claim(element, frame.at(declared.base)):
            frame.sink.add_types(element, [ELEMENT_TYPES[declared.kind]], frame.at(declared.base))
            members.append(element)
            namespace = namespace_of(node, declared.name.text)
            _add_properties(frame, namespace, element, declared.properties)
    scenes.sets[node] = (declared.kind, tuple(members))
    frame.sink.add(node, "rbw:count", frame.sink.literal(declared.count.value), frame.at(declared.count))
    add_set(frame, node, declared.name, members)


def add_set(frame: Frame, node: URIRef, name: tree.Name, elements: Iterable[Node]) -> None:
    """Add a set with its elements, as unordered elements and as a list in written order."""
    ordered = list(elements)
    frame.sink.add_types(node, SET_TYPES, frame.at(name))
    for element in ordered:
        frame.sink.add(node, "bdd:elements", element)
    frame.sink.add(node, "rbw:element-list", frame.sink.make_list(ordered))


def add_composition(frame: Frame, scenes: Scenes, declared: tree.Composition) -> None:
    """Add the objects and workspaces of a workspace's composition."""
    node = frame.claimed(declared.name.text, declared.name)
    if node is None:
        return
    sink = frame.sink
    workspace = frame.target(declared.workspace)
    entries: list[tuple[str, URIRef]] = []
    for entry in declared.entries:
        target = frame.target(entry.reference)
        if target is not None:
            entries.append((_entry_kind(entry), target))
            sink.mark(node, "rbw:entries", target, frame.at(entry.reference))
    scenes.compositions[node] = _Composition(workspace, tuple(entries))
    sink.mark_node(node, frame.at(declared.name))
    sink.add(node, "env:of-workspace", workspace, frame.at(declared.workspace))
    sink.add(node, "rbw:entries", sink.make_list(target for _, target in entries))


def add_composition_contents(frame: Frame, scenes: Scenes, declared: tree.Composition) -> None:
    """Add the members of a composition. The members of nested compositions must already be known."""
    node = frame.node(declared.name.text)
    composition = scenes.compositions.get(node) if node is not None else None
    if node is None or composition is None:
        return
    for entry in declared.entries:
        target = frame.target(entry.reference)
        kind = _entry_kind(entry)
        if kind == "composition" and target is not None:
            nested = scenes.compositions.get(target)
            target = None if nested is None else nested.workspace
        if target is None:
            continue
        holds_object = kind == "object"
        type_ = "env:WorkspaceHasObject" if holds_object else "env:WorkspaceHasWorkspace"
        frame.sink.add_types(node, [type_], frame.at(declared.name))
        term = "env:has-object" if holds_object else "env:has-workspace"
        frame.sink.add(node, term, target, frame.at(entry.reference))


def add_scene(frame: Frame, scenes: Scenes, declared: tree.Scene) -> None:
    """Add a scene and its entries in written order."""
    node = frame.claimed(declared.name.text, declared.name)
    if node is None:
        return
    entries: list[URIRef] = []
    for entry in declared.entries:
        target = frame.target(entry.reference)
        if target is not None:
            entries.append(target)
            frame.sink.mark(node, "rbw:entries", target, frame.at(entry.reference))
    scenes.scenes[node] = tuple(entries)
    frame.sink.add_types(node, ["bdd:Scene"], frame.at(declared.name))
    frame.sink.add(node, "rbw:entries", frame.sink.make_list(entries))
    columns = list(_columns(frame, node, declared))
    if columns:
        frame.sink.add(node, "rbw:table-columns", frame.sink.make_list(columns))


def _columns(frame: Frame, scene: URIRef, declared: tree.Scene) -> Iterator[URIRef]:
    """Add the columns of the tables that list a scene's elements, and yield them in written order."""
    sink = frame.sink
    stated = ((entry, name) for entry in declared.entries if entry.columns for name in entry.columns.names)
    for number, (entry, name) in enumerate(stated, start=1):
        node, target = sink.iri(f"{scene}.column-{number}"), frame.target(entry.reference)
        if node is not None and target is not None:
            sink.add_types(node, ["rbw:PropertyColumn"], frame.at(name))
            sink.add(node, "rbw:property-name", sink.literal(name.text), frame.at(name))
            sink.add(node, "rbw:of-set", target, frame.at(entry.reference))
            yield node


def _entry_kind(entry: tree.Link) -> str:
    return entry.reference.role.lower()


def _count(number: tree.Number) -> int:
    return number.value if isinstance(number.value, int) else 0


def _links(variation: tree.Table | tree.Product) -> Iterator[tree.Link]:
    """Yield links to element sets, in text order."""
    if isinstance(variation, tree.Table):
        pieces = [cell for row in variation.rows for cell in row.cells]
    else:
        pieces = [assignment.choices for assignment in variation.assignments]
    for piece in pieces:
        if isinstance(piece, tree.Link) and piece.reference.role in _LINKED_SETS:
            yield piece


def _unique(nodes: Iterable[URIRef]) -> tuple[URIRef, ...]:
    return tuple(dict.fromkeys(nodes))
