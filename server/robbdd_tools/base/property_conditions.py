"""Evaluate conditions on the properties of elements, such as ``colour = red``."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from types import MappingProxyType

from robbdd_tools.base.property_values import NUMBER, QUANTITY, TRUTH, PropertyValue
from robbdd_tools.base.quantity_units import UNITS

EQUAL, UNEQUAL, NOT = "=", "!=", "not"
TRUE = PropertyValue(TRUTH, "true")
ORDERS: Mapping[str, Callable[[Fraction, Fraction], bool]] = MappingProxyType(
    {
        "<": lambda left, right: left < right,
        "<=": lambda left, right: left <= right,
        ">": lambda left, right: left > right,
        ">=": lambda left, right: left >= right,
    }
)
"""Comparisons of numbers and quantities."""
_NUMBER = re.compile(r"[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d{1,3})?")
Properties = Mapping[str, Sequence[PropertyValue]]
"""Name of a property → its values for one element."""


@dataclass(frozen=True, slots=True)
class PropertyCondition:
    """``name comparison value``. ``not`` means "is not true", which also holds for elements without the property."""

    name: str
    comparison: str
    value: PropertyValue

    def holds(self, properties: Properties) -> bool:
        """Return whether an element with some properties satisfies the condition.

        ``=`` holds if one of the element's values is equal, ``not`` if none is. Any other comparison holds if the
        element has the property and each of its values satisfies the comparison.
        """
        values = properties.get(self.name, ())
        if self.comparison == EQUAL:
            return any(same(value, self.value) for value in values)
        if self.comparison == NOT:
            return not any(same(value, self.value) for value in values)
        return bool(values) and all(self._satisfied(value) for value in values)

    def compares(self, value: PropertyValue) -> bool:
        """Return whether a value can be compared with the value of the condition."""
        same_kind = value.measures == self.value.measures
        return same_kind and (self.comparison not in ORDERS or value.kind in (NUMBER, QUANTITY))

    def _satisfied(self, value: PropertyValue) -> bool:
        if self.comparison == UNEQUAL:
            return not same(value, self.value)
        left, right = size_of(value), size_of(self.value)
        if left is None or right is None or not self.compares(value):
            return False
        return ORDERS[self.comparison](left, right)

    def __str__(self) -> str:
        if self.value == TRUE and self.comparison in (EQUAL, NOT):
            return self.name if self.comparison == EQUAL else f"not {self.name}"
        return f"{self.name} {self.comparison} {self.value.text}"


def same(one: PropertyValue, other: PropertyValue) -> bool:
    """Return whether two values are equal. ``20 g`` equals ``0.02 kg``, and 3 equals 3.0."""
    if one.measures != other.measures:
        return False
    left, right = size_of(one), size_of(other)
    return left == right if left is not None and right is not None else one.text == other.text


def size_of(value: PropertyValue) -> Fraction | None:
    """Return a number, or a quantity in SI units, exactly as written; ``None`` for any other value."""
    if value.kind not in (NUMBER, QUANTITY):
        return None
    number, _, unit = value.text.partition(" ")
    if not _NUMBER.fullmatch(number):
        return None  # A graph may state infinity, or a number that is too large to compute with.
    return Fraction(number) * Fraction(str(UNITS[unit][1] if unit else 1))


def chosen(
    elements: Iterable[str], properties: Mapping[str, Properties], conditions: Sequence[PropertyCondition]
) -> tuple[str, ...]:
    """Return the elements (IRIs) that satisfy all conditions, in their order."""
    return tuple(one for one in elements if all(condition.holds(properties.get(one, {})) for condition in conditions))
