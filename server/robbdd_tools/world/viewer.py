"""Interactive window that follows a simulation in real time."""

from __future__ import annotations

from importlib import import_module
from time import perf_counter, sleep
from typing import TYPE_CHECKING, Any

from robbdd_tools.world.engine import TICK

if TYPE_CHECKING:
    from robbdd_tools.world.simulation import Simulation


class NoViewer(Exception):
    """No window can be opened; the message gives the reason."""


class Viewer:
    """A window that shows a simulation; the user may turn the camera. Raises ``NoViewer``.

    The simulation runs in real time while the window is open, and at full speed once the user has closed it.
    """

    def __init__(self, simulation: Simulation) -> None:
        try:
            launch: Any = import_module("mujoco.viewer").launch_passive
            self._window: Any = launch(simulation.model, simulation.data, show_left_ui=False, show_right_ui=False)
        except Exception as error:  # failures of window systems have many types
            raise NoViewer(f"no window can be opened: {error}") from error
        self._due = perf_counter()
        self._watchers = simulation.watchers
        self._watchers.append(self._follow)

    def close(self) -> None:
        """Close the window."""
        if self._follow in self._watchers:
            self._watchers.remove(self._follow)
        self._window.close()

    def _follow(self) -> None:
        if not self._window.is_running():
            return
        self._window.sync()
        self._due = max(self._due + TICK, perf_counter() - TICK)
        sleep(max(0.0, self._due - perf_counter()))
