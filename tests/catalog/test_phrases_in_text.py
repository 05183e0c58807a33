"""Free text that says a phrase of the catalog."""

from __future__ import annotations

import pytest

from robbdd_tools.catalog.phrases_in_text import phrase_with, predicate_in_text
from robbdd_tools.catalog.registry import load_catalog


@pytest.mark.parametrize(
    ("text", "word", "placeholders"),
    [
        ("{bin} is correct for {part}", "is-correct-for", {"workspace": "bin", "object": "part"}),
        ('"{bin}" is correct for "{part}"', "is-correct-for", {"workspace": "bin", "object": "part"}),
        ("  {b}  is correct\nfor {p} ", "is-correct-for", {"workspace": "b", "object": "p"}),
        ("{r} moves slower than {limit}", "moves-slower-than", {"agent": "r", "limit": "limit"}),
        ("{r} does not collide {x}", "does-not-collide", {"agent": "r", "target": "x"}),
        ("{r} does not collide with {x}", "object-does-not-collide", {"one": "r", "other": "x"}),
    ],
)
def test_a_text_says_a_phrase(text: str, word: str, placeholders: dict[str, str]) -> None:
    found = predicate_in_text(text, placeholders.values())
    assert found is not None
    assert (found[0].name, found[1]) == (word, placeholders)


NAMES = ("bin", "part", "r", "name", "value", "limit")


@pytest.mark.parametrize(
    "text",
    [
        "{bin} is right for {part}",
        "{bin} is correct for {part}!",
        "not {bin} is correct for {part}",
        "{bin} Is correct for {part}",
        "bin is correct for {part}",
        "{r} has config {name} = {value}",  # it sets up a world
        "it takes less than {limit}",  # about a time between events, not about samples
        "{r} moves slower than 0.25 m/s",
        "{bin} is correct for {gone}",
        "",
    ],
)
def test_other_text_says_none(text: str) -> None:
    assert predicate_in_text(text, NAMES) is None


def test_values_are_written_into_a_phrase() -> None:
    word = load_catalog().predicates["is-nearer-than"]
    values = {slot.name: f"<{slot.name}>" for slot in word.slots}
    assert phrase_with(word, values) == "<one> is nearer than <distance> to <other>"
