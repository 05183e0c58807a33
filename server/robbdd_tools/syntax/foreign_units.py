"""Explain units that the language does not have, such as ``km/h`` and ``minutes``, and convert their numbers."""

from __future__ import annotations

import re
from math import pi
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.base.quantity_units import UNITS
from robbdd_tools.syntax.declaration import SyntaxFault, SyntaxFix

if TYPE_CHECKING:
    from robbdd_tools.syntax.parsed import Rejected

_UNITS = {
    **dict.fromkeys(("second", "seconds", "sec", "secs"), ("s", 1.0)),
    **dict.fromkeys(("min", "mins", "minute", "minutes"), ("s", 60.0)),
    **dict.fromkeys(("h", "hour", "hours"), ("s", 3600.0)),
    **dict.fromkeys(("meter", "meters", "metre", "metres"), ("m", 1.0)),
    **dict.fromkeys(("centimeter", "centimeters", "centimetre", "centimetres"), ("cm", 1.0)),
    **dict.fromkeys(("millimeter", "millimeters", "millimetre", "millimetres"), ("mm", 1.0)),
    **dict.fromkeys(("degree", "degrees", "°"), ("deg", 1.0)),
    **dict.fromkeys(("gram", "grams"), ("g", 1.0)),
    **dict.fromkeys(("kilogram", "kilograms"), ("kg", 1.0)),
    **dict.fromkeys(("newton", "newtons", "Newton"), ("N", 1.0)),
    "percent": ("%", 1.0),
    "km": ("m", 1000.0),
    "cm/s": ("m/s", 0.01),
    "mm/s": ("m/s", 0.001),
    "km/h": ("m/s", 1 / 3.6),
    "rad/s": ("deg/s", 180 / pi),
    "kN": ("N", 1000.0),
}
"""Unit → the unit of the language, and its number of these units."""
_SECONDS = {**{unit: size for unit, (other, size) in _UNITS.items() if other == "s" and size != 1.0}, "ms": 0.001}
"""Unit of time → its number of seconds."""
_NUMBER = r"(?P<number>[-+]?(?:\d+(?:\.\d*)?|\.\d+))"
_UNIT = r"(?P<unit>[^\W\d_]+(?:/[^\W\d_]+)?|°)(?![\w\-/])"
_QUANTITY = re.compile(rf"{_NUMBER}\s*{_UNIT}")
_TIME = re.compile(rf"{_NUMBER}\s*\Z")
_PROPERTY = re.compile(rf":\s*{_NUMBER}[ \t]*{_UNIT}\s*\Z")
_TIME_UNIT = re.compile(_UNIT)
_AFTER_VALUES = frozenset({"|", ","})
"""The signs after a value in a table or in a list."""
LONGEST = 40
"""Maximum number of characters from a number to its unit."""


def foreign_unit(text: str, rejected: Rejected) -> SyntaxFault | None:
    """Return the fault of a unit that the language does not have; ``None`` if the parser stopped elsewhere."""
    if "QuantityLiteral" in rejected.expected.rules:
        found = _QUANTITY.match(text, rejected.offset)
        if found is None or found["unit"] not in _UNITS:
            return None
        return _not_a_unit(found["number"], found["unit"], found.start(), found.start("unit"))
    if rejected.expected.literals & _AFTER_VALUES:
        number = _TIME.search(text, max(0, rejected.offset - LONGEST), rejected.offset)
        unit = _TIME_UNIT.match(text, rejected.offset)
        if number is not None and unit is not None and unit["unit"] in _UNITS:
            return _not_a_unit(number["number"], unit["unit"], number.start(), unit.start())
    if ":" in rejected.expected.literals:
        head = text[max(0, rejected.offset - LONGEST) : rejected.offset]
        found = _PROPERTY.search(head)
        if found is None:
            return None
        shift = rejected.offset - len(head)
        start, unit = found.start("number") + shift, found["unit"]
        if unit in _UNITS:
            return _not_a_unit(found["number"], unit, start, found.start("unit") + shift)
        message = f"'{unit}' is neither a unit nor a property with a value: the units are {' '.join(UNITS)}"
        return SyntaxFault(Span(found.start("unit") + shift, found.end("unit") + shift), message)
    if "seconds" in rejected.expected.literals:
        number = _TIME.search(text, max(0, rejected.offset - LONGEST), rejected.offset)
        unit = _TIME_UNIT.match(text, rejected.offset)
        size = None if unit is None else _SECONDS.get(unit["unit"])
        if number is None or unit is None or size is None:
            return None
        written = f"{_converted(number['number'], size)} seconds"
        message = f"write the time in 'seconds': '{written}'"
        return SyntaxFault(Span(*unit.span()), message, _change(Span(number.start(), unit.end()), written))
    return None


def _not_a_unit(number: str, unit: str, start: int, place: int) -> SyntaxFault:
    """Return the fault of a number at ``start`` with a unit at ``place``."""
    known, size = _UNITS[unit]
    written = f"{_converted(number, size)} {known}"
    message = f"'{unit}' is not a unit of the language: write '{written}'"
    return SyntaxFault(Span(place, place + len(unit)), message, _change(Span(start, place + len(unit)), written))


def _change(span: Span, written: str) -> SyntaxFix:
    return SyntaxFix(span, written, f"Change to '{written}'")


def _converted(number: str, size: float) -> str:
    return number if size == 1.0 else f"{float(number) * size:.6g}"
