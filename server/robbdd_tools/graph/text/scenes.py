"""Write sets, compositions and scenes of a graph as RobBDD text."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robbdd_tools.graph.rdf.records import Incomplete, elements_of, items_of
from robbdd_tools.graph.rdf.vocabulary import ELEMENT_TYPES, MEMBERSHIPS
from robbdd_tools.graph.text.names import NAME, Names, braces, indented
from robbdd_tools.graph.text.property_text import SET_BY_PROPERTY, base_of, column_names, set_reference, value_text

if TYPE_CHECKING:
    from robbdd_tools.graph.acceptance_model import Iri

WORDS = {"object": "obj", "workspace": "ws", "agent": "agn"}
_MEMBERSHIP = re.compile(r"-scene-has-(?:obj|ws|agn)(?:-\d+)?\Z")


@dataclass(slots=True)
class SceneText:
    """Writes the contents of scenes. ``kinds`` maps each set that declares elements to the kind of these elements."""

    names: Names
    kinds: dict[str, str] = field(default_factory=dict[str, str])
    constant_sets: list[Iri] = field(default_factory=list["Iri"])
    scenes: dict[str, str] = field(default_factory=dict[str, str])
    _members: dict[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    _elements: dict[str, str] = field(default_factory=dict[str, str])
    _compositions: tuple[Iri, ...] = ()
    _inferred: dict[str, frozenset[str]] = field(default_factory=dict[str, frozenset[str]])

    def text(self) -> list[str]:
        """Return all declarations of a scene file."""
        records = self.names.records
        for kind, type_ in ELEMENT_TYPES.items():
            for node in records.instances(type_):
                self._elements.setdefault(node, kind)
        self._choose_sets()
        blocks = [self._set(node) for node in self._members]
        self._compositions = records.subjects("env:of-workspace")
        for node in self._compositions:
            self.names.declare(node, "composition")
        blocks += [block for node in self._compositions for block in self._composition(node)]
        stated = [node for node in records.subjects("rbw:entries") if records.is_a(node, "bdd:Scene")]
        blocks += [self._scene(node, items_of(records, node, "rbw:entries")) for node in stated]
        blocks += [block for variant in records.instances("bdd:ScenarioVariant") for block in self._of(variant)]
        return blocks

    def link(self, node: str) -> str:
        """Return a reference to a set in a variation or a scene, for example ``obj set <…>`` or ``set <…>``."""
        kind = self.kinds.get(base_of(self.names, node))
        reference = set_reference(self.names, node)
        return f"{WORDS[kind]} set {reference}" if kind else f"set {reference}"

    def constant_set(self, node: Iri) -> str:
        """Return the declaration of a set of values."""
        values: list[str] = []
        for item in elements_of(self.names.records, node):
            try:
                values.append(self.names.value(item))
            except Incomplete:
                continue
        return f"const set {self.names.scope_of(node)} {self.names.paths[node]} {braces(values)}"

    def _choose_sets(self) -> None:
        """Choose the sets that declare elements, so that each element is declared once.

        Sets that scenes name are chosen first, then larger sets.
        """
        records = self.names.records
        in_scenes = {
            str(item) for node in records.subjects("rbw:entries") for item in items_of(records, node, "rbw:entries")
        }
        sets = {
            node: tuple(map(str, elements_of(records, node)))
            for node in records.instances("bdd:ConstantSet")
            if not records.is_a(node, SET_BY_PROPERTY)
        }
        taken: set[str] = set()
        for node in sorted(sets, key=lambda entry: (entry not in in_scenes, -len(sets[entry]), entry)):
            members = sets[node]
            kinds = {self._elements.get(member, "") for member in members} or {"object"}
            is_uniform = len(kinds) == 1 and "" not in kinds
            if is_uniform and taken.isdisjoint(members) and self._declares(node, members, in_scenes):
                taken.update(members)
                self._declare_set(node, kinds.pop(), members)
            else:
                self.constant_sets.append(node)
        self._declare_rest([node for node in self._elements if node not in taken])
        for node in self.constant_sets:
            self.names.declare(node, "values")

    def _declares(self, node: str, members: tuple[str, ...], in_scenes: set[str]) -> bool:
        namespace = self.names.split(node)[0]
        if len(set(members)) < len(members):
            return False
        if not members:
            return node in in_scenes or bool(self.names.records.all(node, "rbw:count"))
        return all(m.startswith(namespace) and NAME.fullmatch(m[len(namespace) :]) for m in members)

    def _declare_set(self, node: str, kind: str, members: tuple[str, ...]) -> None:
        name = self.names.declare(node, f"{kind}s")
        self.kinds[node] = kind
        self._members[node] = members
        for member in members:
            self.names.declare(member, kind, owner=name, namespace=self.names.split(node)[0])

    def _declare_rest(self, elements: list[str]) -> None:
        """Put the elements that no set declares into generated sets, one for each kind and namespace."""
        groups: dict[tuple[str, str], list[str]] = {}
        for element in sorted(elements):
            groups.setdefault((self._elements[element], self.names.split(element)[0]), []).append(element)
        for (kind, namespace), members in groups.items():
            self._declare_set(f"{namespace}{kind}s", kind, tuple(members))

    def _set(self, node: str) -> str:
        kind, members = self.kinds[node], self._members[node]
        head = f"{WORDS[kind]} set {self.names.scope_of(node)} {self.names.paths[node]}"
        names = [self.names.paths[member].rpartition(".")[2] for member in members]
        count = self.names.records.literal(node, "rbw:count")
        base = names[0].removesuffix("0") if names else kind
        if count == len(names) and names == [f"{base}{index}" for index in range(len(names))]:
            first, *others = (self._properties(node, member) for member in members)
            common = [one for one in first if all(one in properties for properties in others)]
            return f"similar {head} {{ {'  '.join((f'base name: {base}', f'count: {count}', *common))} }}"
        entries = [f"{kind} {name}{self._details(node, m, kind)}" for m, name in zip(members, names, strict=True)]
        if any(self._properties(node, member) for member in members):
            lines = indented(",\n".join(entries))
            return f"{head} {{\n{lines}\n}}"
        return f"{head} {braces(entries)}"

    def _details(self, set_: str, member: str, kind: str) -> str:
        """Return the statements of the graph about an element, in braces; empty if there are none."""
        stated = map(str, self.names.records.all(member, "rbw:correct-for")) if kind == "workspace" else ()
        fitting = sorted(node for node in stated if self._kind(node) == "object")
        correct = [f"correct for: {', '.join(map(self._entry, fitting))}"] if fitting else []
        found = (*correct, *self._properties(set_, member))
        return f" {{ {'  '.join(found)} }}" if found else ""

    def _kind(self, node: str) -> str | None:
        return self.kinds.get(base_of(self.names, node), self._elements.get(node))

    def _properties(self, set_: str, member: str) -> list[str]:
        """Return the properties of an element in the namespace of its set."""
        records, namespace = self.names.records, self.names.split(set_)[0]
        found: list[str] = []
        for term in records.properties(member):
            name = term.removeprefix(namespace)
            if term != name and NAME.fullmatch(name):
                values = [
                    text for value in records.all(member, term) if (text := value_text(self.names, value)) is not None
                ]
                found += [f"{name}: {', '.join(values)}"] if values else []
        return found

    def _composition(self, node: Iri) -> Iterator[str]:
        records, names = self.names.records, self.names
        listed = items_of(records, node, "rbw:entries")
        entries = listed or (*records.all(node, "env:has-object"), *records.all(node, "env:has-workspace"))
        try:
            workspace = names.reference(records.one(node, "env:of-workspace"))
            inner = "".join(f"    {self._entry(str(entry))}\n" for entry in entries)
        except Incomplete:
            return
        yield f"comp {names.scope_of(node)} {names.paths[node]} of ws {workspace} {{\n{inner}}}"

    def _entry(self, node: str) -> str:
        if node in self._compositions:
            return f"ws comp {self.names.reference(node)}"
        if node in self._elements:
            return f"{WORDS[self._elements[node]]} {self.names.reference(node)}"
        return self.link(node)

    def _scene(self, node: str, entries: tuple[object, ...]) -> str:
        self.names.declare(node, "scene")
        self.scenes[node] = self.names.reference(node)
        columns = column_names(self.names.records, node)
        lines = "\n".join(self._shown(str(entry), columns) for entry in entries)
        body = f"\n{indented(lines)}\n" if lines else " "
        return f"scene {self.names.scope_of(node)} {self.names.paths[node]} {{{body}}}"

    def _shown(self, node: str, columns: dict[str, list[str]]) -> str:
        """Return an entry of a scene. The columns of a set are written once."""
        names = columns.pop(node, ())
        return f"{self._entry(node)} with {', '.join(names)}" if names else self._entry(node)

    def _of(self, variant: Iri) -> Iterator[str]:
        """Yield a generated scene for a variant whose scene the graph does not name."""
        records = self.names.records
        stated = records.all(variant, "rbw:scene")
        if stated:
            self.scenes[variant] = self.names.reference(str(stated[0]))
            return
        nodes = records.iris(records.all(variant, "bdd:has-scene"))
        terms = [term for _, term, _ in MEMBERSHIPS.values()]
        members = frozenset(str(m) for node in nodes for term in terms for m in records.all(node, term))
        named = sorted({_MEMBERSHIP.sub("", node) for node in nodes if _MEMBERSHIP.search(node)})
        node = named[0] if len(named) == 1 else f"{variant}-scene"
        if self._inferred.get(node, members) != members:
            node = f"{variant}-scene"
        if node not in self._inferred:
            self._inferred[node] = members
            yield self._scene(node, tuple(self._parts(members)))
        self.scenes[variant] = self.scenes[node]

    def _parts(self, members: frozenset[str]) -> Iterator[str]:
        """Yield the sets and compositions that contain the members of a scene.

        A set is included as a whole even if the scene needs only some of its elements.
        """
        missing = set(members)
        for node in self._compositions:
            workspaces = set(map(str, self.names.records.all(node, "env:of-workspace")))
            if workspaces & members:
                missing -= workspaces | {str(o) for o in self.names.records.all(node, "env:has-object")}
                yield node
        for node, inner in self._members.items():
            if missing.intersection(inner) or (inner and members.issuperset(inner)):
                yield node
