"""Prepare robots of the catalog for bases that hang or lean: they need another home."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING

from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.home_posture import find_home
from robbdd_tools.world.mobile_base import base_of
from robbdd_tools.world.robot_specs import load_robot
from robbdd_tools.world.tilted_base import tilt_model

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import RobotModel
    from robbdd_tools.catalog.executable import ModelSource
    from robbdd_tools.world.tilted_base import Tilt

ARMS = 16
"""Size of the cache of arms."""


def tilted(robot: RobotModel, tilt: Tilt | None, source: ModelSource) -> RobotModel:
    """Return a robot of the catalog for a base that may be tilted. Raises ``SceneError``."""
    if tilt is None:
        return robot
    if base_of(robot) is not None:
        raise SceneError(f"'{robot.name}' drives on the floor, so its base cannot be tilted", origin=source.origin)
    return _with_home(robot, tilt, source)


@lru_cache(maxsize=ARMS)
def _with_home(robot: RobotModel, tilt: Tilt, source: ModelSource) -> RobotModel:
    spec = load_robot(robot)
    fingers = {str(joint.name): robot.gripper_open for pad in robot.pads for joint in spec.geom(pad).parent.joints}
    palm = str(spec.site(robot.tool_site).parent.name)
    model = spec.compile()
    tilt_model(model, tilt.rotation)
    home = find_home(model, source, robot.joints, robot.tool_site, fingers, palm, height=tilt.height, is_upright=False)
    return replace(robot, home=home, tilt=tilt.rotation)
