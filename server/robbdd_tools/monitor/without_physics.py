"""Refuse to judge contacts by traces of the kinematic world, in which things move as commanded."""

from __future__ import annotations

from collections.abc import Mapping

from robbdd_tools.monitor.unobserved import Unobserved

KINEMATIC = "kinematic"
"""Name of the world without physics."""
WORLD = ("", "world")
"""Key of a trace's settings that stores its world; it is absent for a world with physics."""
NO_CONTACTS = "the kinematic world has no contacts and no forces: execute the scenario with physics"


def need_contacts(settings: Mapping[tuple[str, str], str]) -> None:
    """Raise ``Unobserved`` if a trace is of the kinematic world, by its settings: this world has no contacts."""
    if settings.get(WORLD) == KINEMATIC:
        raise Unobserved(NO_CONTACTS)
