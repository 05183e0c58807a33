"""Recognize free text of ``pred("…")`` that has the same words as a predicate's phrase."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from functools import cache
from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Kind
from robbdd_tools.catalog.registry import load_catalog

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Predicate

    Said = tuple[Predicate, Mapping[str, str]]

_KINDS = {
    Kind.OBJECT: "object",
    Kind.OBJECT_SET: "object",
    Kind.WORKSPACE: "workspace",
    Kind.WORKSPACE_SET: "workspace",
    Kind.AGENT: "agent",
}
_PLACEHOLDER = re.compile(r'"?\{(\w[\w-]*)\}"?')
_SLOT = re.compile(r"<([\w-]+)>|#([\w-]+)")


def predicates_in_text(template: str, names: Collection[str]) -> tuple[Said, ...]:
    """Return the predicates whose phrase has the words of a text, each with the text's placeholders for its slots.

    ``{a} is correct for {b}`` matches ``<workspace> is correct for <object>``. Quotes around placeholders and the width
    of blanks do not matter. Not recognized are phrases that set something up or have names or values without a unit,
    and texts with a placeholder that is not among ``names``. If the words are those of several predicates, the kinds of
    the values decide; the predicate whose phrase it is in a clause is the first.
    """
    words = " ".join(_PLACEHOLDER.sub("{}", template).split())
    placeholders = _PLACEHOLDER.findall(template)
    if not set(names) >= set(placeholders):
        return ()
    found = _phrases().get(words, ())
    return tuple((predicate, dict(zip(slots, placeholders, strict=True))) for predicate, slots in found)


def predicates_in_sentence(predicate: Predicate) -> tuple[Said, ...]:
    """Return the predicates that have the words of a predicate's phrase, each with this predicate's slots for its own.

    The first is the predicate itself, unless its phrase cannot be written as a text.
    """
    slots = [slot.name for slot in predicate.slots]
    return predicates_in_text(_SLOT.sub(lambda match: f"{{{match[1] or match[2]}}}", predicate.phrase), slots)


def phrase_with(predicate: Predicate, values: Mapping[str, str]) -> str:
    """Return the phrase of a predicate with ``values`` in place of its slots."""
    return _SLOT.sub(lambda match: values[match[1] or match[2]], predicate.phrase)


def accepts(kind: Kind, element: str) -> bool:
    """Return whether a slot of a kind takes an ``object``, ``workspace`` or ``agent``."""
    return bool(element) and (kind is Kind.ANY or _KINDS.get(kind) == element)


@cache
def _phrases() -> Mapping[str, tuple[tuple[Predicate, tuple[str, ...]], ...]]:
    """Map each phrase, with ``{}`` for its slots, to its predicates and the names of their slots in written order."""
    found: dict[str, list[tuple[Predicate, tuple[str, ...]]]] = {}
    sayable = [
        predicate
        for predicate in load_catalog().predicates.values()
        if not {slot.kind for slot in predicate.slots} & {Kind.NAME, Kind.VALUE} and predicate.duration is None
    ]
    own = ((predicate, phrase) for predicate in sayable for phrase in (predicate.phrase, *predicate.aliases))
    others = ((predicate, phrase) for predicate in sayable for phrase in predicate.in_texts)
    for predicate, phrase in (*own, *others):
        slots = tuple(one or other for one, other in _SLOT.findall(phrase))
        found.setdefault(" ".join(_SLOT.sub("{}", phrase).split()), []).append((predicate, slots))
    return {words: tuple(predicates) for words, predicates in found.items()}
