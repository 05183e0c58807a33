"""Read the mass and the friction that properties state about objects."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from robbdd_tools.base.property_values import NUMBER, PropertyValue
from robbdd_tools.base.quantity_units import read_quantity
from robbdd_tools.graph.acceptance_model import Iri
from robbdd_tools.graph.rdf.records import Records
from robbdd_tools.graph.read.scene_columns import properties_of

SETTINGS: Mapping[str, str] = {"mass": "mass", "friction": NUMBER}
"""Name of a property that is also a configuration of objects → what its value measures."""


def read_stated_settings(records: Records, objects: Iterable[Iri]) -> dict[Iri, dict[str, str]]:
    """Return the configurations that each object's properties state, in the units of ``catalog.settings``.

    A property with several values, or with a value of another kind, states nothing about a simulated object.
    """
    found = {one: dict(_stated(properties_of(records, one))) for one in objects}
    return {one: stated for one, stated in found.items() if stated}


def stated_setting(name: str, value: PropertyValue) -> str | None:
    """Return the value of a configuration that one value of a property states; ``None`` for any other property."""
    measured = SETTINGS.get(name)
    if measured is None or value.measures != measured:
        return None
    return value.text if measured == NUMBER else f"{read_quantity(value.text, measured).si:.12g}"


def _stated(properties: Mapping[str, tuple[PropertyValue, ...]]) -> Iterator[tuple[str, str]]:
    for name in SETTINGS:
        values = properties.get(name, ())
        setting = stated_setting(name, values[0]) if len(values) == 1 else None
        if setting is not None:
            yield name, setting
