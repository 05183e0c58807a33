"""Map the names of events in a model to the events of a behaviour."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|[0-9]+")
"""A word of ``pick_end``, ``PickEnd``, ``EPickEnd`` or ``E_PICK_END``."""
_DECORATION = frozenset({"e", "ev", "evt", "event", "on"})
"""Words before or after a name that only mark it as an event."""
_FORMS: Mapping[str, str] = {
    "started": "start",
    "starts": "start",
    "ended": "end",
    "ends": "end",
    "pickup": "pick",
    "picking": "pick",
    "placing": "place",
}


def inner_event(name: str, events: Iterable[str]) -> str | None:
    """Return the event of a behaviour that a name (CURIE, IRI or local name) denotes, or ``None``.

    Case, separators, verb forms and words such as ``evt`` are ignored. So ``evt-pick-end``, ``E_PICK_END``,
    ``pickEnd``, ``pick_ended``, ``PickEnded`` and ``pickup_end`` all denote ``pick-end``.
    """
    words = _words(name)
    return next((event for event in events if _words(event) == words), None)


def _words(name: str) -> list[str]:
    found: list[str] = [word.lower() for word in _WORD.findall(re.split(r"[#/:]", name)[-1])]
    while len(found) > 1 and found[0] in _DECORATION:
        found = found[1:]
    while len(found) > 1 and found[-1] in _DECORATION:
        found = found[:-1]
    forms = [_FORMS.get(word, word) for word in found]
    return ["pick", *forms[2:]] if forms[:2] == ["pick", "up"] else forms
