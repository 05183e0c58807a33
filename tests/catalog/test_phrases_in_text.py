"""Free text that says a phrase of the catalog."""

from __future__ import annotations

import re
from itertools import permutations

import pytest

from robbdd_tools.catalog.api import Kind
from robbdd_tools.catalog.phrases_in_text import phrase_with, predicates_in_text
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
    predicate, found = predicates_in_text(text, placeholders.values())[0]
    assert (predicate.name, found) == (word, placeholders)


PREPOSITIONS = {"with", "to", "from", "at", "in", "into", "on", "of", "by", "for"}


def words_of(phrase: str) -> tuple[str, ...]:
    """Return the words of a phrase without prepositions; a slot is ``{}``."""
    words = re.sub(r"<[\w-]+>|#[\w-]+", "{}", phrase).split()
    return tuple(word for word in words if word not in PREPOSITIONS)


def test_the_kinds_of_values_decide_between_all_phrases_that_differ_only_in_prepositions() -> None:
    sayable = [
        predicate
        for predicate in load_catalog().predicates.values()
        if not {slot.kind for slot in predicate.slots} & {Kind.NAME, Kind.VALUE} and predicate.duration is None
    ]
    pairs = [(one, two) for one, two in permutations(sayable, 2) if words_of(one.phrase) == words_of(two.phrase)]
    assert {one.name for one, _ in pairs} == {"does-not-collide", "object-does-not-collide"}
    for one, two in pairs:
        text = re.sub(r"<([\w-]+)>|#([\w-]+)", r"{\1\2}", one.phrase)
        own, other = predicates_in_text(text, [slot.name for slot in one.slots])
        assert (own[0], other[0]) == (one, two)
        # The values have the same order, whatever the slots are called.
        assert list(own[1].values()) == list(other[1].values()) == [slot.name for slot in one.slots]
        assert one.slots[0].kind != two.slots[0].kind


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
    assert predicates_in_text(text, NAMES) == ()


def test_values_are_written_into_a_phrase() -> None:
    word = load_catalog().predicates["is-nearer-than"]
    values = {slot.name: f"<{slot.name}>" for slot in word.slots}
    assert phrase_with(word, values) == "<one> is nearer than <distance> to <other>"
