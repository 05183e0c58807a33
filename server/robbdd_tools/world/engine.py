"""The physics engine, which has no type information: only this module imports it."""

from __future__ import annotations

from importlib import import_module
from typing import Any

mujoco: Any = import_module("mujoco")

TIMESTEP = 0.002
"""Seconds per physics step; at 4 ms, a gripped cube is dropped."""
SUBSTEPS = 8
"""Physics steps per control tick."""
TICK = TIMESTEP * SUBSTEPS
"""Seconds of simulated time per control tick and per recorded sample."""


def version() -> str:
    """Return the engine's name and version for display."""
    return f"MuJoCo {mujoco.__version__}"


WARNINGS: list[str] = []
"""The engine's warnings since ``engine_faults`` last cleared the list."""


def _keep(warning: object) -> None:
    """Keep a warning of the engine, which it would otherwise write to MUJOCO_LOG.TXT in the working folder."""
    WARNINGS.append(str(warning))


mujoco.set_mju_user_warning(_keep)
