"""Detect changes of a simulation that users' code makes around its interface, such as an object put elsewhere."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.engine import mujoco

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

STATE = ("qpos", "qvel", "act", "mocap_pos", "mocap_quat", "qfrc_applied", "xfrc_applied", "eq_active")
"""Arrays of the engine's state that only its steps and this package change."""
PARAMETERS = (
    "body_mass",
    "body_inertia",
    "body_gravcomp",
    "body_pos",
    "geom_size",
    "geom_pos",
    "geom_friction",
    "geom_contype",
    "geom_conaffinity",
    "pair_friction",
    "jnt_range",
    "dof_damping",
    "actuator_gainprm",
    "actuator_biasprm",
    "actuator_forcerange",
    "actuator_ctrlrange",
    "jnt_actfrcrange",
    "jnt_stiffness",
    "dof_armature",
    "dof_frictionloss",
    "geom_margin",
    "geom_gap",
    "geom_solref",
    "geom_solimp",
    "eq_data",
)
"""Arrays of the engine's model that nothing changes in an execution, and on which results of the physics depend."""
OPTIONS: tuple[str, ...] = tuple(name for name in dir(mujoco.MjOption) if not name.startswith("_"))
"""Settings of the engine, such as its gravity and its time step."""
CALLBACKS: dict[str, Callable[[], object]] = {
    name.removeprefix("get_"): getattr(mujoco, name) for name in dir(mujoco) if name.startswith("get_mjcb_")
}
"""Functions that return what the engine calls in each step, by its name."""


def contents_of(model: Any, data: Any) -> Mapping[str, bytes]:
    """Return what only the simulator may change, by the engine's names."""
    found = {name: getattr(data, name).tobytes() for name in STATE}
    found |= {name: getattr(model, name).tobytes() for name in PARAMETERS}
    found |= {name: np.asarray(getattr(model.opt, name)).tobytes() for name in OPTIONS}
    found |= {name: str(callback()).encode() for name, callback in CALLBACKS.items()}
    found["time"] = np.float64(data.time).tobytes()
    return found


def changed(before: Mapping[str, bytes], after: Mapping[str, bytes]) -> tuple[str, ...]:
    """Return the names of what differs."""
    return tuple(name for name, content in before.items() if after[name] != content)
