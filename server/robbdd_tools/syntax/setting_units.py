"""Explain a unit behind the value of ``has config``, whose unit the setting determines."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.base.quantity_units import UNITS, si_factor
from robbdd_tools.catalog.settings import SettingError, setting_of
from robbdd_tools.syntax.declaration import SyntaxFault, SyntaxFix

if TYPE_CHECKING:
    from robbdd_tools.syntax.parsed import Rejected

_VALUE = re.compile(r"\bhas\s+config\s+(?P<name>[\w\-]+)\s*=\s*(?P<number>[-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*\Z")
_UNIT = re.compile(r"(?:m/s|deg/s|deg|rad|mm|cm|ms|kg|g|m|s|N|%)(?![\w\-/])")
LONGEST = 120
"""Maximum number of characters from ``has config`` to the unit."""


def unit_of_setting(text: str, rejected: Rejected) -> SyntaxFault | None:
    """Return the fault of a unit in a setting; ``None`` if the parser stopped elsewhere.

    The fix writes the number in the unit of the setting. There is none if the setting measures something else.
    """
    unit = _UNIT.match(text, rejected.offset)
    value = _VALUE.search(text, max(0, rejected.offset - LONGEST), rejected.offset)
    if unit is None or value is None:
        return None
    try:
        wanted = setting_of(value["name"]).unit
    except SettingError:
        wanted = ""
    span, whole = Span(*unit.span()), Span(value.start("number"), unit.end())
    if wanted and UNITS[unit[0]][0] != UNITS.get(wanted, ("",))[0]:
        return SyntaxFault(span, f"'{value['name']}' is a number in {wanted}, without a unit: write it in {wanted}")
    number = _converted(value["number"], unit[0], wanted)
    if number is None:
        return None
    of = f" in {wanted}" if wanted else ""
    message = f"'{value['name']}' is a number{of}, without a unit: write '{number}'"
    return SyntaxFault(span, message, SyntaxFix(whole, number, f"Change to '{number}'"))


def _converted(number: str, unit: str, wanted: str) -> str | None:
    """Return a number in another unit of its dimension, or as it is for a setting without a unit."""
    try:
        value = float(number)
    except ValueError:
        return None
    if unit == wanted or not wanted:
        return number
    return f"{value * si_factor(unit) / si_factor(wanted):.12g}"
