"""Events of diagnostics: the changes of a component's state."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

LEVELS = {0: "ok", 1: "warn", 2: "error", 3: "stale"}
"""``diagnostic_msgs/DiagnosticStatus``: its levels."""


@dataclass
class Diagnostics:
    """Turns the states of components into texts: ``gripper error`` when the level changes, and each new message.

    The first state of a component is a text, too, because it is unknown how long it has lasted.
    """

    _states: dict[tuple[str, str], tuple[int, str]] = field(default_factory=dict[tuple[str, str], tuple[int, str]])

    def texts(self, topic: str, name: str, level: int, message: str) -> Iterator[str]:
        """Yield the texts of a component's state."""
        before = self._states.get((topic, name))
        self._states[topic, name] = (level, message)
        if before is None or before[0] != level:
            yield f"{name} {LEVELS.get(level, level)}"
        if message and (before is None or before[1] != message):
            yield message
