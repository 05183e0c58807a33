"""Signals of events as users declare them."""

from __future__ import annotations

import pytest

from robbdd_tools.protocol.event_signals import EventSignal, NoEventSignal, read_event_signal


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("done=/finished", EventSignal("done", "/finished")),
        ("evt-a = /state becomes 3", EventSignal("evt-a", "/state", "data", "becomes", "3")),
        ("a=/arm/state.mode is RUNNING", EventSignal("a", "/arm/state", "mode", "is", "RUNNING")),
        ("a=/j.position[2] rises above 0.4", EventSignal("a", "/j", "position[2]", "above", "0.4")),
        ("a=/ft.wrench.force.z falls  below -3", EventSignal("a", "/ft", "wrench.force.z", "below", "-3")),
        ("a=/say becomes two words", EventSignal("a", "/say", "data", "becomes", "two words")),
    ],
)
def test_a_signal_has_a_topic_a_field_and_a_condition(text: str, expected: EventSignal) -> None:
    assert read_event_signal(text) == expected


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("done", "declares no event: write EVENT=/topic"),
        ("=/finished", "declares no event"),
        ("done=finished", "declares no event"),
        ("done=/state.mode", "declares no event"),
        ("done=/state equals 3", "declares no event"),
        ("done=/state becomes", "declares no event"),
        ("done=/x.z rises above high", "'high' in 'done=/x.z rises above high' is no number"),
    ],
)
def test_another_text_is_refused_with_the_form(text: str, words: str) -> None:
    with pytest.raises(NoEventSignal) as caught:
        read_event_signal(text)
    assert words in str(caught.value)
