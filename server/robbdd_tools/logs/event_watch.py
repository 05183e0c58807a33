"""Find the messages of a log that report events, by the signals that the user declares."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, cast

from robbdd_tools.logs.log_contents import UnreadableLog

if TYPE_CHECKING:
    from robbdd_tools.protocol.event_signals import EventSignal

_PART = re.compile(r"(\w+)((?:\[\d+\])*)")
TRUTHS = {"true": True, "false": False}


class EventWatch:
    """The declared signals of a log, by their topics.

    A message is a mapping (JSON) or an object with attributes (a decoded message of ROS).
    """

    def __init__(self, signals: Iterable[EventSignal]) -> None:
        self._signals = tuple(signals)
        self._before: dict[EventSignal, bool] = {}
        self._seen: set[str] = set()
        self.remarks: list[str] = []

    @property
    def topics(self) -> frozenset[str]:
        """The topics of the signals."""
        return frozenset(one.topic for one in self._signals)

    def events(self, topic: str, message: Any) -> list[str]:
        """Return the events that a message reports. Raises ``UnreadableLog`` if it lacks a declared field or value."""
        own = [one for one in self._signals if one.topic == topic]
        self._seen.add(topic)
        return [one.event for one in own if self._occurs(one, message)]

    def check(self, known: Iterable[str]) -> None:
        """Raise ``UnreadableLog`` if a topic is not in the log; ``known`` are its topics."""
        for one in self._signals:
            if one.topic not in self._seen and one.topic not in (every := sorted(known)):
                raise UnreadableLog(f"the log has no topic '{one.topic}'; it has: {', '.join(every)}")

    def _occurs(self, signal: EventSignal, message: Any) -> bool:
        if signal.kind == "message":
            return True
        holds = _holds(signal, message)
        if signal.kind == "is":
            return holds
        before = self._before.get(signal)
        self._before[signal] = holds
        if before is None and holds:
            words = f"'{signal.topic}' fulfils the condition of {signal.event} in its first message"
            self.remarks.append(f"{words}: since when is not known, so this is no event")
        return holds and before is False


def _holds(signal: EventSignal, message: Any) -> bool:
    owner, value = _value(signal, message)
    if signal.kind in ("above", "below"):
        if isinstance(value, str) or not hasattr(value, "__float__"):
            raise UnreadableLog(f"'{signal.topic}.{signal.field}' is no number, but {value!r}")
        return float(value) > float(signal.value) if signal.kind == "above" else float(value) < float(signal.value)
    if isinstance(value, str):
        return value == signal.value
    if signal.value.casefold() in TRUTHS:
        return bool(value) == TRUTHS[signal.value.casefold()]
    try:
        return float(value) == float(signal.value)
    except ValueError:
        constant = getattr(owner, signal.value, None)
    except TypeError:
        raise UnreadableLog(f"'{signal.topic}.{signal.field}' is neither a number nor a text") from None
    if constant is None:
        words = f"'{signal.value}' is no value of '{signal.topic}.{signal.field}', which is {value!r}"
        raise UnreadableLog(f"{words}: name a number, true, false, or a constant of the message's type")
    return float(value) == float(constant)


def _value(signal: EventSignal, message: Any) -> tuple[Any, Any]:
    """Return the object that has the field, and the value of the field."""
    owner, value = message, message
    for part in signal.field.split("."):
        match = _PART.fullmatch(part)
        known = _fields(value)
        if match is None or match[1] not in known:
            words = f"a message on '{signal.topic}' has no field '{signal.field}'"
            raise UnreadableLog(f"{words}; it has: {', '.join(known) or 'no fields'}")
        owner, value = value, known[match[1]]
        for number in re.findall(r"\d+", match[2]):
            if int(number) >= len(value):
                raise UnreadableLog(f"'{part}' of a message on '{signal.topic}' has {len(value)} elements only")
            value = value[int(number)]
    return owner, value


def _fields(value: Any) -> Mapping[str, Any]:
    if isinstance(value, Mapping):
        return {str(name): one for name, one in cast("Mapping[Any, Any]", value).items()}
    names = [name for name in getattr(value, "__dataclass_fields__", {}) if not name.startswith("_")]
    return {name: getattr(value, name) for name in names}
