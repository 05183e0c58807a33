"""Swap the object or the goal of a behaviour, as a fault of the robot."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

from robbdd_tools.world.errors import SceneError

if TYPE_CHECKING:
    from robbdd_tools.agent.behaviour_calls import Call
    from robbdd_tools.catalog.robot_faults import RobotFault
    from robbdd_tools.world.simulation import Simulation


def with_swapped_element(call: Call, fault: RobotFault, simulation: Simulation) -> Call:
    """Return a behaviour as a robot with a fault understands it.

    Raises ``SceneError`` if the fault cannot occur in the scene: it has no other object, or no other workspace.
    """
    cast = simulation.world.cast
    if fault.name == "swapped-object" and "object" in call.arguments:
        others = [name for name, model in cast.objects.items() if model.graspable]
        return _with(call, "object", others, "loose object")
    if fault.name == "swapped-goal" and "workspace" in call.arguments:
        walled = {name for name, found in cast.regions.items() if any(region.walled for _, region in found)}
        # Confuse a bin with another bin rather than with the table below it.
        alike = walled.intersection(call.places)
        others = sorted(cast.regions, key=lambda name: (bool(alike) != (name in walled), name))
        return _with(call, "workspace", others, "workspace")
    return call


def _with(call: Call, slot: str, others: Iterable[str], what: str) -> Call:
    stated = call.arguments[slot]
    present = (stated,) if isinstance(stated, str) else stated
    other = next((name for name in others if name not in present), None)
    if other is None:
        raise SceneError(f"the scene has no other {what} than {', '.join(present)}")
    return replace(call, arguments={**call.arguments, slot: other})
