"""The physics engine, which publishes no types: the one place that imports it."""

from __future__ import annotations

from importlib import import_module
from typing import Any

mujoco: Any = import_module("mujoco")

TIMESTEP = 0.002
"""Seconds per physics step; at 4 ms a gripped cube is dropped."""
SUBSTEPS = 8
"""Physics steps per control tick."""
TICK = TIMESTEP * SUBSTEPS
"""Seconds of simulated time per control tick and per recorded sample."""


def version() -> str:
    """Return the engine's name and version for people to read."""
    return f"MuJoCo {mujoco.__version__}"


def _ignore(_warning: object) -> None:
    """Take a warning of the engine, which it would else write to a file in the working folder.

    What they warn of (a state that is not a number) is found by the simulation itself.
    """


mujoco.set_mju_user_warning(_ignore)
