"""Read which properties the tables of a scene's elements show, and their values."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from robbdd_tools.base.property_values import PropertyValue
from robbdd_tools.graph.acceptance_model import Iri
from robbdd_tools.graph.rdf.property_terms import property_name, value_of
from robbdd_tools.graph.rdf.records import Records, elements_of, items_of
from robbdd_tools.graph.shown_properties import Column


def read_columns(records: Records, variant: Iri, members: Iterable[Iri]) -> Iterator[Column]:
    """Yield the columns of the scenes of a variant in written order. ``members`` are the elements of its scene."""
    columns = [
        column
        for scene in records.iris(records.all(variant, "rbw:scene"))
        for column in map(str, items_of(records, scene, "rbw:table-columns"))
    ]
    known = {member: properties_of(records, member) for member in members} if columns else {}
    for column in columns:
        name = records.text(column, "rbw:property-name")
        sets = records.iris(records.all(column, "rbw:of-set"))
        elements = frozenset(str(one) for set_ in sets for one in elements_of(records, set_))
        if name:
            yield Column(name, elements, {member: found[name] for member, found in known.items() if name in found})


def properties_of(records: Records, element: Iri) -> dict[str, tuple[PropertyValue, ...]]:
    """Return the values of an element's properties by their names."""
    found: dict[str, dict[PropertyValue, None]] = {}
    for term in records.properties(element):
        name = property_name(term)
        values = map(value_of, records.all(element, term)) if name is not None else ()
        for value in values:
            if name is not None and value is not None:
                found.setdefault(name, {})[value] = None
    return {name: tuple(values) for name, values in found.items()}
