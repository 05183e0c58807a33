"""Signals of a log that report an event of the model, as users declare them."""

from __future__ import annotations

import re
from dataclasses import dataclass

from robbdd_tools.base.exceptions import RobbddError

FORM = (
    "write EVENT=/topic, 'EVENT=/topic.field is VALUE', 'EVENT=/topic.field becomes VALUE', "
    "'EVENT=/topic.field rises above NUMBER' or 'EVENT=/topic.field falls below NUMBER'"
)
FIELD = "data"
"""The field of a message of ``std_msgs``."""
_SIGNAL = re.compile(
    r"(?P<topic>/[^\s.]+)(?:\.(?P<field>[\w.\[\]]+))?"
    r"(?:\s+(?P<kind>is|becomes|rises\s+above|falls\s+below)\s+(?P<value>.+))?"
)


class NoEventSignal(RobbddError, ValueError):
    """A text declares no signal of an event; the message says how to write one."""


@dataclass(frozen=True, slots=True)
class EventSignal:
    """A condition on the messages of a topic under which an event occurs.

    - ``kind``: ``message`` for each message; ``is`` for each message with the value; ``becomes`` for a message with the
      value after a message with another value; ``above`` and ``below`` for a number that passes the value.
    - ``field``: the path of a field (``state``, ``pose.position.z``, ``position[2]``).
    - ``value``: the text of a number, ``true``, ``false``, a text, or the name of a constant of the message's type.
    """

    event: str
    topic: str
    field: str = FIELD
    kind: str = "message"
    value: str = ""


def read_event_signal(text: str) -> EventSignal:
    """Return the signal that ``EVENT=SIGNAL`` declares. Raises ``NoEventSignal``."""
    event, _, words = text.partition("=")
    event = event.strip()
    match = _SIGNAL.fullmatch(words.strip())
    if not event or match is None or (match["kind"] is None and match["field"]):
        raise NoEventSignal(f"'{text}' declares no event: {FORM}")
    kind = "message" if match["kind"] is None else match["kind"].split()[-1]
    value = (match["value"] or "").strip()
    if kind in ("above", "below"):
        try:
            float(value)
        except ValueError:
            raise NoEventSignal(f"'{value}' in '{text}' is no number") from None
    return EventSignal(event, match["topic"], match["field"] or FIELD, kind, value)
