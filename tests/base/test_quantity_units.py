"""Quantities are read with their units."""

from __future__ import annotations

from math import pi

import pytest

from robbdd_tools.base.quantity_units import UNITS, Quantity, QuantityError, is_quantity, read_quantity


@pytest.mark.parametrize(
    ("text", "dimension", "quantity", "si"),
    [
        ("0.25 m/s", "speed", Quantity(0.25, "m/s"), 0.25),
        ("30cm", "length", Quantity(30, "cm"), 0.3),
        ("-5e-1 mm", "length", Quantity(-0.5, "mm"), -0.0005),
        ("180 deg", "angle", Quantity(180, "deg"), pi),
        ("90 deg/s", "angular speed", Quantity(90, "deg/s"), pi / 2),
        ("20 %", "ratio", Quantity(20, "%"), 0.2),
    ],
)
def test_a_quantity_is_a_number_with_a_unit(text: str, dimension: str, quantity: Quantity, si: float) -> None:
    found = read_quantity(text, dimension)
    assert found == quantity
    assert found.si == pytest.approx(si)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("0.25", "'0.25' has no unit: write a speed with its unit, as in '5 m/s'"),
        ("0.25 mph", "'0.25 mph' has no unit: write a speed"),
        ("5 deg", "'5 deg' is an angle, not a speed: write a speed"),
        ("", "'' has no unit"),
    ],
)
def test_anything_else_says_what_to_write(text: str, message: str) -> None:
    with pytest.raises(QuantityError) as caught:
        read_quantity(text, "speed")
    assert str(caught.value).startswith(message)


def test_every_unit_is_read() -> None:
    for unit, (dimension, _) in UNITS.items():
        assert read_quantity(f"2 {unit}", dimension).unit == unit
        assert is_quantity(f"2 {unit}")
    assert not is_quantity("2")
    assert not is_quantity("m")
