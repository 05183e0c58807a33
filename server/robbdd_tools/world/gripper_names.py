"""Names of the parts of a gripper that is mounted on an arm: in its own file, and in the description of the arm."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import ArmModel

PREFIX = "mounted-gripper/"
"""Begins the names of a mounted gripper's parts: both files may have a ``base``, and some arms a ``gripper/base``."""

MOUNT = f"{PREFIX}robbdd-mount"
"""The body that carries the mounted gripper."""


def name_in_file(name: str) -> str:
    """Return the name that a part of an arm or of its mounted gripper has in its file."""
    return name.removeprefix(PREFIX)


def named_in_spec(arm: ArmModel) -> ArmModel:
    """Return the data about an arm with the names that the parts of its mounted gripper have in the description."""
    if arm.mounted is None:
        return arm
    tool, actuator = (f"{PREFIX}{name}" if name else "" for name in (arm.tool, arm.actuator))
    return replace(arm, tool=tool, actuator=actuator, pads=tuple(f"{PREFIX}{pad}" for pad in arm.pads))
