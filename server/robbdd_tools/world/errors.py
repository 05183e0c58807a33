"""Errors in a scenario's world; each message is shown to the user unchanged."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import ModelEntry, Origin
    from robbdd_tools.monitor.fault import Fault


def at(origin: Origin | None) -> str:
    """Return a source position as the beginning of a message."""
    return "" if origin is None else f"{Path(origin.file).name}:{origin.line}:{origin.column}: "


class _WithFault(Exception):
    """An error that users' code may have caused. In this case, ``fault`` describes it."""

    def __init__(self, message: str, fault: Fault | None = None) -> None:
        super().__init__(message)
        self.fault = fault


class SceneError(_WithFault):
    """The scene cannot be built; the message says what is wrong and what to change.

    ``origin`` is the source position that the message begins with; ``reason`` is the message without it. ``entry`` is
    the entry of the model at ``origin`` that is wrong, if a single one is.
    """

    def __init__(
        self, reason: str, fault: Fault | None = None, origin: Origin | None = None, entry: ModelEntry | None = None
    ) -> None:
        super().__init__(at(origin) + reason, fault)
        self.reason = reason
        self.origin = origin
        self.entry = entry


class NoRoomLeft(SceneError):
    """There is no place left for the object ``name``."""

    def __init__(self, name: str, where: str) -> None:
        super().__init__(f"there is no room left for '{name}' {where}")
        self.name = name


class BehaviourError(Exception):
    """The agent cannot continue its behaviour; the message gives the reason and, if known, the time."""


class UserError(_WithFault):
    """Users' code failed; the message names file and line. The run is inconclusive."""


class SimulationError(Exception):
    """The simulation became numerically unstable, or the engine cannot compute it.

    ``element`` is the element of the scene that causes it; empty if unknown.
    """

    def __init__(self, message: str, element: str = "") -> None:
        super().__init__(message)
        self.element = element
