"""Events of a model are matched with those of a behaviour by name, in any naming style."""

from __future__ import annotations

import pytest

from robbdd_tools.catalog.event_names import inner_event
from robbdd_tools.catalog.registry import load_catalog

EVENTS = load_catalog().behaviours["pick-place"].events


@pytest.mark.parametrize(
    "name",
    [
        "pick-end",
        "evt-pick-end",
        "event_pick_end",
        "E_PICK_END",
        "EVT-PICK-END",
        "pickEnd",
        "PickEnd",
        "EPickEnd",
        "evtPickEnd",
        "pick_ended",
        "PickEnded",
        "onPickEnd",
        "pick-end-event",
        "https://example.org/t/evt-pick-end",
        "https://example.org/t#PickEnd",
        "t:pick_end",
        "pickup_end",
        "pick-up-ended",
        "evt-picking-end",
    ],
)
def test_a_decorated_name_means_the_event(name: str) -> None:
    assert inner_event(name, EVENTS) == "pick-end"


@pytest.mark.parametrize("name", ["pick", "end", "evt", "e", "pick-end-2", "pick-bend", "picked-end", "", "end-pick"])
def test_another_name_means_none(name: str) -> None:
    assert inner_event(name, EVENTS) is None


def test_each_event_means_itself() -> None:
    for behaviour in load_catalog().behaviours.values():
        assert [inner_event(event, behaviour.events) for event in behaviour.events] == list(behaviour.events)
