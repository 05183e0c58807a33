"""Values of the properties of elements as plain data: texts, numbers, quantities, truth values and elements."""

from __future__ import annotations

from dataclasses import dataclass

from robbdd_tools.base.quantity_units import UNITS, split_quantity

TEXT, NUMBER, QUANTITY, TRUTH, ELEMENT = "text", "number", "quantity", "truth value", "element"


@dataclass(frozen=True, slots=True, order=True)
class PropertyValue:
    """One value of a property.

    ``kind`` is a constant of this module. ``text`` is the value as text. For an element, it is the IRI. For a
    quantity, it has one space before the unit.
    """

    kind: str
    text: str

    @property
    def measures(self) -> str:
        """The dimension of a quantity, such as ``mass``; the kind of any other value."""
        return UNITS[self.text.split()[1]][0] if self.kind == QUANTITY else self.kind


def quantity_value(text: str) -> PropertyValue:
    """Return the value of a quantity's literal. A text that is not a quantity of the language stays a text."""
    found = split_quantity(text.strip())
    return PropertyValue(TEXT, text) if found is None else PropertyValue(QUANTITY, " ".join(found))
