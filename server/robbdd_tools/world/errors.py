"""Errors in a scenario's world; each message is shown to the user unchanged."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.monitor.fault import Fault


class _WithFault(Exception):
    """An error that users' code may have caused. In this case, ``fault`` describes it."""

    def __init__(self, message: str, fault: Fault | None = None) -> None:
        super().__init__(message)
        self.fault = fault


class SceneError(_WithFault):
    """The scene cannot be built; the message says what is wrong and what to change."""


class BehaviourError(Exception):
    """The agent cannot continue its behaviour; the message gives the reason and, if known, the time."""


class UserError(_WithFault):
    """Users' code failed; the message names file and line. The run is inconclusive."""


class SimulationError(Exception):
    """The simulation became numerically unstable."""
