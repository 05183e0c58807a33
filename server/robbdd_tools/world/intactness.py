"""Detect changes of a simulation that users' code makes around its interface, such as an object put elsewhere."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping

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
)
"""Arrays of the engine's model that nothing changes in an execution, and on which results of the physics depend."""


def contents_of(model: Any, data: Any) -> Mapping[str, bytes]:
    """Return what only the simulator may change, by the engine's names."""
    found = {name: getattr(data, name).tobytes() for name in STATE}
    found |= {name: getattr(model, name).tobytes() for name in PARAMETERS}
    found["gravity"] = model.opt.gravity.tobytes()
    return found


def changed(before: Mapping[str, bytes], after: Mapping[str, bytes]) -> tuple[str, ...]:
    """Return the names of what differs."""
    return tuple(name for name, content in before.items() if after[name] != content)
