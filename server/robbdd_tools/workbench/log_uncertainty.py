"""Parse the uncertainty of a log's measurements as users state it."""

from __future__ import annotations

from robbdd_tools.base.quantity_units import QuantityError, read_quantity
from robbdd_tools.protocol.recorded_log import ERROR_KEYS

FORM = "write '3 mm', 'cube1=5 mm', '2 deg' or '0.05 m/s'"


def read_uncertainty(text: str) -> tuple[str, float]:
    """Parse ``[ELEMENT=]QUANTITY``: return the key in ``LogRequest.uncertainty``, and the quantity in the SI unit.

    Raises ``QuantityError`` for another text.
    """
    element, separator, stated = text.rpartition("=")
    for dimension, key in ERROR_KEYS.items():
        try:
            value = read_quantity(stated, dimension).si
        except QuantityError:
            continue
        if value < 0 or (separator and (not element or dimension != "length")):
            break
        return element.strip() or key, value
    raise QuantityError(f"'{text}' is no uncertainty: {FORM}")
