"""Find the properties of elements that scenes declare, and those that imported graphs state.

In a model, a property is known by its name without the namespace: ``colour`` stands for every property of this name.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from robbdd_tools.base.graph_formats import graph_format
from robbdd_tools.base.property_conditions import TRUE, Properties, PropertyCondition
from robbdd_tools.base.property_values import ELEMENT, NUMBER, TEXT, TRUTH, PropertyValue, quantity_value
from robbdd_tools.graph.rdf.property_terms import property_name, value_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import MAX_COPIES

if TYPE_CHECKING:
    from robbdd_tools.graph.write.imported_graphs import ImportedGraph
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class Fact:
    """One value of a property of an element.

    ``element`` and ``term`` are IRIs; ``name`` is the name of the property. ``written`` is the place of the value in a
    declaration.
    """

    element: str
    term: str
    name: str
    value: PropertyValue
    written: tree.Property | None = None


def facts(snapshot: Snapshot, uri: str) -> Iterator[Fact]:
    """Yield the properties of the elements that a file can use: first declared ones, then ones from imported graphs."""
    closure = snapshot.closure(uri)
    for file in closure:
        for placed in file.declarations:
            if isinstance(placed.declaration.tree, tree.ElementSet | tree.SimilarSet):
                yield from declared_facts(file, placed)
    if any(graph_format(link.uri) for file in closure for link in file.imports):
        from robbdd_tools.graph.write.imported_graphs import imported_graph

        elements = {definition.iri or "" for file in closure for definition in file.definitions.values()}
        yield from imported_facts(imported_graph(snapshot, uri), elements)


def declared_facts(file: FileAnalysis, placed: PlacedDeclaration) -> Iterator[Fact]:
    """Yield the properties that a set of elements declares."""
    root = placed.declaration.tree
    if isinstance(root, tree.ElementSet):
        for member in root.members:
            yield from _of_element(file, placed, f"{root.name.text}.{member.name.text}", member.properties)
    elif isinstance(root, tree.SimilarSet) and root.properties:
        count = root.count.value if isinstance(root.count.value, int) else 0
        for number in range(min(count, MAX_COPIES)):
            yield from _of_element(file, placed, f"{root.name.text}.{root.base.text}{number}", root.properties)


def imported_facts(imported: ImportedGraph, elements: Container[str]) -> Iterator[Fact]:
    """Yield the properties of some elements (IRIs) in imported graphs, sorted."""
    found: list[Fact] = []
    for subject, predicate, node in imported.triples:
        name = property_name(str(predicate)) if str(subject) in elements else None
        value = None if name is None else value_of(node)
        if name is not None and value is not None:
            found.append(Fact(str(subject), str(predicate), name, value))
    yield from sorted(found, key=lambda fact: (fact.element, fact.term, fact.value))


def _of_element(
    file: FileAnalysis, placed: PlacedDeclaration, path: str, properties: tuple[tree.Property, ...]
) -> Iterator[Fact]:
    definition = file.definitions.get(path) if properties else None
    if definition is None or definition.iri is None:
        return
    namespace = definition.iri.removesuffix(definition.symbol.name)
    for stated in properties:
        for written in stated.values:
            value = written_value(placed, written)
            if value is not None:
                yield Fact(definition.iri, namespace + stated.name.text, stated.name.text, value, stated)


def written_value(placed: PlacedDeclaration, written: tree.PropertyValue) -> PropertyValue | None:
    """Return the value that a text in a declaration denotes; ``None`` for an unknown name."""
    match written:
        case tree.Quantity():
            return quantity_value(written.text)
        case tree.Number():
            return PropertyValue(NUMBER, str(written.value))
        case tree.Truth():
            return PropertyValue(TRUTH, str(written.value).lower())
        case tree.Text():
            return PropertyValue(TEXT, written.value)
        case tree.Ref():
            target = placed.targets.get(written)
            return None if target is None or target.iri is None else PropertyValue(ELEMENT, target.iri)


def conditions_of(placed: PlacedDeclaration, where: tree.Where) -> tuple[PropertyCondition, ...] | None:
    """Return the conditions in a declaration, or ``None`` if one of them contains an unknown name."""
    found: list[PropertyCondition] = []
    for written in where.conditions:
        value = TRUE if written.value is None else written_value(placed, written.value)
        if value is None:
            return None
        found.append(PropertyCondition(written.name.text, written.comparison, value))
    return tuple(found)


def grouped(found: Iterable[Fact]) -> Mapping[str, Properties]:
    """Return the values of each property (by name) of each element (IRI)."""
    known: dict[str, dict[str, dict[PropertyValue, None]]] = {}
    for fact in found:
        known.setdefault(fact.element, {}).setdefault(fact.name, {})[fact.value] = None
    return {element: {name: tuple(values) for name, values in by_name.items()} for element, by_name in known.items()}


@lru_cache(maxsize=4)
def properties_by_element(snapshot: Snapshot, uri: str) -> Mapping[str, Properties]:
    """Return the values of each property (by name) of each element (IRI) that a file can use."""
    return grouped(facts(snapshot, uri))
