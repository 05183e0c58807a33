"""Conditions of breakpoints on clauses: the moments at which they pause."""

from __future__ import annotations

from typing import Any

from robbdd_tools.protocol.pauses import Moment

LABELS = {
    Moment.OPENS: ("Window of any clause opens", "Pause where the window of any clause opens."),
    Moment.CLOSES: ("Window of any clause closes", "Pause where the window of any clause closes."),
    Moment.NEGATIVE: ("Any clause turns negative", "Pause where the margin of any clause is first negative."),
}
FILTERS: list[dict[str, Any]] = [
    {"filter": str(moment), "label": label, "description": description, "default": moment is Moment.NEGATIVE}
    for moment, (label, description) in LABELS.items()
]
"""The exception filters that an editor offers next to its breakpoints."""


class InvalidCondition(ValueError):
    """A condition names no moment; the message lists them."""


def moments_of(condition: str | None) -> tuple[str, ...]:
    """Return the moments that a condition such as ``opens or closes`` names, or all if it is empty.

    Raises ``InvalidCondition``.
    """
    words = [word.strip() for word in (condition or "").replace(",", " or ").split(" or ") if word.strip()]
    unknown = [word for word in words if word not in tuple(Moment)]
    if unknown:
        known = ", ".join(f"'{moment}'" for moment in Moment)
        raise InvalidCondition(f"'{unknown[0]}' is not a moment of a clause: write {known}, joined by 'or'")
    return tuple(moment for moment in Moment if not words or moment in words)
