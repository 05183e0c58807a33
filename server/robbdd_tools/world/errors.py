"""What can go wrong in a scenario's world; each message is for the user to read as it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.monitor.fault import Fault


class _WithFault(Exception):
    """An error that code of the user may have caused: ``fault`` describes it then."""

    def __init__(self, message: str, fault: Fault | None = None) -> None:
        super().__init__(message)
        self.fault = fault


class SceneError(_WithFault):
    """The scene cannot be built; the message says what is wrong with it and what to change."""


class BehaviourError(Exception):
    """The agent cannot go on with its behaviour; the message says why, with the time where one is known."""


class UserError(_WithFault):
    """The user's own code is broken; the message names its file and line. Nothing can be concluded from the run."""


class SimulationError(Exception):
    """The simulation itself broke down."""
