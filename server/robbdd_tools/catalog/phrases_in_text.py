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

_KINDS = {
    Kind.OBJECT: "object",
    Kind.OBJECT_SET: "object",
    Kind.WORKSPACE: "workspace",
    Kind.WORKSPACE_SET: "workspace",
    Kind.AGENT: "agent",
}
_PLACEHOLDER = re.compile(r'"?\{(\w[\w-]*)\}"?')
_SLOT = re.compile(r"<([\w-]+)>|#([\w-]+)")


def predicate_in_text(template: str, names: Collection[str]) -> tuple[Predicate, Mapping[str, str]] | None:
    """Return the predicate whose phrase has the words of a text, and the text's placeholder for each of its slots.

    ``{a} is correct for {b}`` matches ``<workspace> is correct for <object>``. Quotes around placeholders and the width
    of blanks do not matter. Not recognized are phrases that set something up or have names or values without a unit,
    and texts with a placeholder that is not among ``names``.
    """
    words = " ".join(_PLACEHOLDER.sub("{}", template).split())
    found = _phrases().get(words)
    placeholders = _PLACEHOLDER.findall(template)
    if found is None or not set(names) >= set(placeholders):
        return None
    return found[0], dict(zip(found[1], placeholders, strict=True))


def phrase_with(predicate: Predicate, values: Mapping[str, str]) -> str:
    """Return the phrase of a predicate with ``values`` in place of its slots."""
    return _SLOT.sub(lambda match: values[match[1] or match[2]], predicate.phrase)


def accepts(kind: Kind, element: str) -> bool:
    """Return whether a slot of a kind takes an ``object``, ``workspace`` or ``agent``."""
    return bool(element) and (kind is Kind.ANY or _KINDS.get(kind) == element)


@cache
def _phrases() -> Mapping[str, tuple[Predicate, tuple[str, ...]]]:
    """Map each phrase, with ``{}`` for its slots, to its predicate and the names of the slots in written order."""
    found: dict[str, tuple[Predicate, tuple[str, ...]]] = {}
    for predicate in load_catalog().predicates.values():
        if not {slot.kind for slot in predicate.slots} & {Kind.NAME, Kind.VALUE} and predicate.duration is None:
            for phrase in (predicate.phrase, *predicate.aliases):
                slots = tuple(one or other for one, other in _SLOT.findall(phrase))
                found[" ".join(_SLOT.sub("{}", phrase).split())] = (predicate, slots)
    return found
