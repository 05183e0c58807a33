"""Warnings and errors of the physics engine. A simulation with one of them proves nothing."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from typing import Any

from robbdd_tools.world.engine import WARNINGS, mujoco
from robbdd_tools.world.errors import SimulationError
from robbdd_tools.world.owners import is_scenery


@contextmanager
def strict(model: Any, data: Any) -> Generator[None]:
    """Raise ``SimulationError`` if the engine warns or fails while it advances ``data``."""
    WARNINGS.clear()
    try:
        yield
    except mujoco.FatalError as error:
        raise SimulationError(f"the physics engine failed: {str(error).partition(chr(10))[0]}") from error
    if WARNINGS:
        raise _error(model, data)


def _error(model: Any, data: Any) -> SimulationError:
    numbers, places = data.warning.number.tolist(), data.warning.lastinfo.tolist()
    kinds = mujoco.mjtWarning
    for kind in (kinds.mjWARN_CONTACTFULL, kinds.mjWARN_CNSTRFULL):
        if numbers[int(kind)]:
            return SimulationError("the physics engine ran out of memory for contacts, so some of them are missing")
    for kind in (kinds.mjWARN_BADQPOS, kinds.mjWARN_BADQVEL, kinds.mjWARN_BADQACC):
        if numbers[int(kind)]:
            element, joint = _joint(model, places[int(kind)])
            return SimulationError(f"the simulation became unstable: the {joint} moves without bounds", element)
    if numbers[int(kinds.mjWARN_INERTIA)]:
        element, joint = _joint(model, places[int(kinds.mjWARN_INERTIA)])
        return SimulationError(
            f"the inertia at the {joint} is singular, so its motion cannot be computed: give every moving part a mass "
            "and an inertia, and no two joints of a body the same axis",
            element,
        )
    return SimulationError(f"the physics engine warns: {WARNINGS[0]}")


def _joint(model: Any, dof: int) -> tuple[str, str]:
    """Return the element of a degree of freedom, and its joint as text."""
    joint = model.joint(int(model.dof_jntid[dof]))
    body = str(model.body(int(joint.bodyid[0])).name)
    # Names from an agent's file, or from a model of the whole scene, have a prefix; an object's free joint has no name.
    owner, _, name = str(joint.name).rpartition("/")
    if not name:
        return body.partition("/")[0], f"free joint of '{body}'"
    return owner, f"joint '{name}' of '{owner}'" if owner and not is_scenery(owner) else f"joint '{name}'"
