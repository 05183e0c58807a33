"""The words of names, and which parts of an object the name of a workspace means."""

from __future__ import annotations

import pytest

from robbdd_tools.catalog.name_words import is_named, parts_named, words_of


def test_names_are_split_at_humps_separators_and_numbers() -> None:
    assert words_of("upperLeft_slot-12b") == ["upper", "left", "slot", "12", "b"]
    assert words_of("Größe_3 架") == ["größe", "3", "架"]


@pytest.mark.parametrize(
    ("workspace", "expected"),
    [
        ("slot_1", {"slot_1"}),
        ("Slot10_ws", {"slot_10"}),
        ("slot_1_and_slot_10", {"slot_1", "slot_10"}),
        ("upper_ws", {"upper"}),
        ("upper_left_ws", {"upper left"}),
        ("uppershelf", {"upper"}),
        ("table_ws", set[str]()),
        ("b_ws", {"b"}),
        ("bench_ws", set[str]()),
        ("myslot10ws", {"slot_10"}),
        ("magazine_slot_2", set[str]()),
    ],
)
def test_a_workspace_means_the_parts_that_its_name_contains(workspace: str, expected: set[str]) -> None:
    assert parts_named(["slot_1", "slot_10", "upper", "upper left", "b"], workspace) == expected


@pytest.mark.parametrize(
    ("site", "workspace", "expected"),
    [
        ("slot_1", "slot_1", True),
        ("Slot-1", "slot1_ws", True),
        ("slot_1_workspace", "slot_1", True),
        ("slot_1", "slot_10", False),
        ("slot", "slot_1", False),
        ("ws", "workspace", False),
    ],
)
def test_a_site_has_the_name_of_a_workspace(site: str, workspace: str, expected: bool) -> None:
    assert is_named(site, workspace) is expected
