"""Columns of the tables that list the elements of a scene, as plain data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from robbdd_tools.base.property_values import PropertyValue


@dataclass(frozen=True, slots=True)
class Column:
    """A property that the table of some elements shows.

    ``elements`` (IRIs) are those of the set for which it was chosen. ``values`` has the values of all elements of the
    scene that have the property.
    """

    name: str
    elements: frozenset[str]
    values: Mapping[str, tuple[PropertyValue, ...]]
