"""The contents of sets and scenes. They are read from syntax trees, without building a graph."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import MAX_COPIES

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class Element:
    """One member of a set. ``kind`` is ``object``, ``workspace``, ``agent``, ``number`` or ``string``.

    Equal members have the same ``key``: the document and the qualified name of an element, or the value of a literal.
    """

    kind: str
    name: str
    key: tuple[str, str]


@dataclass(frozen=True, slots=True, eq=False)
class Site:
    """A declaration in its file. Sites are compared by identity."""

    snapshot: Snapshot
    file: FileAnalysis
    placed: PlacedDeclaration

    @property
    def uri(self) -> str:
        """The URI of the declaration's document."""
        return self.file.document.uri

    @property
    def tree(self) -> tree.ChunkTree | None:
        """The syntax tree of the declaration; ``None`` if it is broken."""
        return self.placed.declaration.tree

    def span(self, node: tree.Node) -> Span:
        """Return the absolute span of a node in the syntax tree."""
        return node.span.shifted(self.placed.offset)

    def target(self, ref: tree.Ref) -> Definition | None:
        """Return the definition of one of the declaration's references."""
        return self.placed.targets.get(ref)

    def whole(self, node: tree.Node) -> bool:
        """Return whether the text of a node has no syntax error, so that its tree is complete."""
        return not any(node.span.start <= fault.span.start <= node.span.end for fault in self.placed.declaration.faults)

    def follow(self, ref: tree.Ref) -> Site | None:
        """Return the declaration that contains the target of one of the declaration's references."""
        definition = self.target(ref)
        return None if definition is None else site_of(self.snapshot, definition)


def site_of(snapshot: Snapshot, definition: Definition) -> Site | None:
    """Return the declaration that declares a name."""
    file = snapshot.file(definition.uri)
    if file is None:
        return None
    index = bisect_right(file.declarations, definition.span.start, key=lambda placed: placed.offset) - 1
    return Site(snapshot, file, file.declarations[index]) if index >= 0 else None


def story_sites(snapshot: Snapshot, file: FileAnalysis, within: Span | None = None) -> Iterator[Site]:
    """Yield the stories of a file, or of a part of it. A story that has parts is yielded scenario by scenario."""
    for part in file.parts(within):
        if isinstance(part.declaration.tree, tree.Story | tree.Variant):
            yield Site(snapshot, file, part)


def element_of(site: Site, value: tree.Value) -> Element | None:
    """Return the element or the literal that a value in a declaration denotes; ``None`` for an unknown name."""
    match value:
        case tree.Number():
            return Element("number", str(value.value), ("", str(value.value)))
        case tree.Quantity():
            return Element("quantity", value.text, ("", value.text))
        case tree.Text():
            return Element("string", value.value, ("", f'"{value.value}"'))
        case tree.Ref():
            found = site.target(value)
            if found is None:
                return None
            return Element(str(found.kind), found.symbol.path, (found.uri, found.symbol.path))


def elements_of(site: Site | None) -> tuple[Element, ...] | None:
    """Return the members of a set in written order.

    Returns ``None`` if the declaration is not a set, or if its members are not completely known.
    """
    declared = None if site is None else site.tree
    if site is None or declared is None or not site.whole(declared):
        return None
    match declared:
        case tree.ElementSet():
            names = [member.name.text for member in declared.members]
            return _members(site.uri, declared.kind, declared.name.text, names)
        case tree.SimilarSet():
            count = declared.count.value if isinstance(declared.count.value, int) else 0
            names = [f"{declared.base.text}{number}" for number in range(min(count, MAX_COPIES))]
            return _members(site.uri, declared.kind, declared.name.text, names)
        case tree.ConstantSet():
            found = [element_of(site, value) for value in declared.values]
            known = tuple(element for element in found if element is not None)
            return known if len(known) == len(found) else None
        case _:
            return None


def _members(uri: str, kind: str, owner: str, names: list[str]) -> tuple[Element, ...]:
    return tuple(Element(kind, f"{owner}.{name}", (uri, f"{owner}.{name}")) for name in names)


def scene_members(site: Site | None) -> frozenset[Element] | None:
    """Return the members of a scene, or ``None`` if it is not a scene or its members are not completely known.

    A composition adds its workspace and its entries. A nested composition adds only its workspace.
    """
    scene = None if site is None else site.tree
    if site is None or not isinstance(scene, tree.Scene) or not site.whole(scene):
        return None
    found: set[Element] = set()
    for entry in scene.entries:
        inner = site.follow(entry.reference)
        members = _composed(inner) if entry.reference.role == "Composition" else elements_of(inner)
        if members is None:
            return None
        found.update(members)
    return frozenset(found)


def simulated_members(site: Site) -> frozenset[Element]:
    """Return the elements of a scene that a simulation places: its members, and the objects of nested compositions.

    A workspace needs the objects that carry it, at any depth. The result is empty if some members are unknown.
    """
    members = scene_members(site)
    if members is None or not isinstance(site.tree, tree.Scene):
        return frozenset()
    found = set(members)
    seen: set[tuple[str, int]] = set()
    waiting = [site.follow(entry.reference) for entry in site.tree.entries if entry.reference.role == "Composition"]
    for composition in waiting:
        inner = None if composition is None else composition.tree
        if composition is None or not isinstance(inner, tree.Composition):
            continue
        place = (composition.uri, composition.placed.offset)
        if place in seen:
            continue
        seen.add(place)
        for entry in inner.entries:
            if entry.reference.role == "Composition":
                waiting.append(composition.follow(entry.reference))
            elif (element := element_of(composition, entry.reference)) is not None:
                found.add(element)
    return frozenset(found)


def _composed(site: Site | None) -> tuple[Element, ...] | None:
    composition = None if site is None else site.tree
    if site is None or not isinstance(composition, tree.Composition) or not site.whole(composition):
        return None
    found = [element_of(site, ref) for ref in _held(composition)]
    nested = [entry for entry in composition.entries if entry.reference.role == "Composition"]
    found += [_workspace(site.follow(entry.reference)) for entry in nested]
    known = tuple(element for element in found if element is not None)
    return known if len(known) == len(found) else None


def _held(composition: tree.Composition) -> Iterator[tree.Ref]:
    yield composition.workspace
    yield from (entry.reference for entry in composition.entries if entry.reference.role != "Composition")


def _workspace(site: Site | None) -> Element | None:
    composition = None if site is None else site.tree
    if site is None or not isinstance(composition, tree.Composition):
        return None
    return element_of(site, composition.workspace)
