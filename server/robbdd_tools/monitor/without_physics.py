"""Traces of the kinematic world, in which things move as commanded: what they cannot show."""

from __future__ import annotations

from collections.abc import Mapping

from robbdd_tools.monitor.unobserved import Unobserved

KINEMATIC = "kinematic"
"""Name of the world without physics."""
WORLD = ("", "world")
"""Key of a trace's settings under which its world is stored; it is absent for a world with physics."""
NO_CONTACTS = "the kinematic world has no contacts and no forces: execute the scenario with physics"


def need_contacts(settings: Mapping[tuple[str, str], str]) -> None:
    """Raise ``Unobserved`` if the settings of a trace are those of the kinematic world, which has no contacts."""
    if settings.get(WORLD) == KINEMATIC:
        raise Unobserved(NO_CONTACTS)
