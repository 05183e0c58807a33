"""Signals of grippers as users declare them."""

from __future__ import annotations

from math import inf, pi

import pytest

from robbdd_tools.protocol.grip_signals import GripSignal, NoGripSignal, read_grip_signal


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("ur10=/vacuum/on", GripSignal("ur10", "", "topic", "/vacuum/on")),
        ("ur10/cube1 = /vacuum", GripSignal("ur10", "cube1", "topic", "/vacuum")),
        ("a=joint left_finger between 5 mm and 1.1 cm", GripSignal("a", "", "joint", "left_finger", 0.005, 0.011)),
        ("a=joint knuckle above 30 deg", GripSignal("a", "", "joint", "knuckle", pi / 6, inf)),
        ("a=joint finger below 0.02 m", GripSignal("a", "", "joint", "finger", -inf, 0.02)),
        ("a=effort finger above 5 N", GripSignal("a", "", "effort", "finger", 5.0, inf)),
        ("a=effort knuckle above 0.4 N m", GripSignal("a", "", "effort", "knuckle", 0.4, inf)),
        ("a=wrench /ft above 3 N", GripSignal("a", "", "wrench", "/ft", 3.0, inf)),
    ],
)
def test_a_signal_has_a_source_and_bounds(text: str, expected: GripSignal) -> None:
    found = read_grip_signal(text)
    assert (found.agent, found.held, found.kind, found.source) == (
        expected.agent,
        expected.held,
        expected.kind,
        expected.source,
    )
    assert (found.low, found.high) == pytest.approx((expected.low, expected.high))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("/vacuum", "declares no grip: write AGENT=/topic"),
        ("a/=/vacuum", "declares no grip"),
        ("a=vacuum", "declares no grip"),
        ("a=joint finger", "declares no grip"),
        ("a=joint finger about 5 mm", "declares no grip"),
        ("a=joint finger above 5 N", "'5 N' in 'a=joint finger above 5 N' is no length or angle"),
        ("a=wrench /ft above 5", "'5' in 'a=wrench /ft above 5' is no force"),
        ("a=effort finger above much", "'much' in 'a=effort finger above much' is no number"),
        ("a=joint finger between 9 mm and 5 mm", "are in the wrong order"),
    ],
)
def test_another_text_is_refused_with_the_form(text: str, words: str) -> None:
    with pytest.raises(NoGripSignal) as caught:
        read_grip_signal(text)
    assert words in str(caught.value)
