"""Find the elements of sets in variations and quantifiers, even if conditions on properties select the elements."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.property_conditions import chosen
from robbdd_tools.graph.property_facts import conditions_of, properties_by_element
from robbdd_tools.names.elements import elements_of
from robbdd_tools.names.types import written_elements as elements_without_conditions
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.names.elements import Element, Site
    from robbdd_tools.names.types import Written


def chosen_elements(site: Site, ref: tree.Ref, where: tree.Where | None) -> tuple[Element, ...] | None:
    """Return the elements of a set that satisfy conditions; ``None`` if they are not completely known."""
    elements = elements_of(site.follow(ref))
    if elements is None or where is None:
        return elements
    conditions = conditions_of(site.placed, where)
    if conditions is None:
        return None
    iris = {element: iri_of(site, element) for element in elements}
    found = frozenset(chosen(iris.values(), properties_by_element(site.snapshot, site.uri), conditions))
    return tuple(element for element in elements if iris[element] in found)


def iri_of(site: Site, element: Element) -> str:
    """Return the IRI of an element, or an empty string for a literal."""
    uri, path = element.key
    file = site.snapshot.file(uri) if uri else None
    definition = None if file is None else file.definitions.get(path)
    return "" if definition is None else definition.iri or ""


def written_elements(site: Site, written: Written) -> Iterator[tuple[tree.Node, Element]]:
    """Yield each element in a cell or a line, with the syntax node at which to report it."""
    match written:
        case tree.Link(where=tree.Where()):
            for element in chosen_elements(site, written.reference, written.where) or ():
                yield written.reference, element
        case tree.Selection(where=tree.Where()):
            for element in chosen_elements(site, written.source, written.where) or ():
                yield written.source, element
        case _:
            yield from elements_without_conditions(site, written)
