"""The engine's editable descriptions of robots, from the catalog's files and from users' prepared files."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.robot_files import prepared_robot

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import RobotModel


def mjcf_path(robot: RobotModel) -> Path:
    """Return the path of the robot's model file. Raises ``SceneError`` if the file is missing."""
    from robbdd_tools.catalog import robots

    own = Path(robots.__path__[0]) / robot.mjcf
    path = own if own.is_file() else Path(robot.mjcf)
    if not path.is_file():
        raise SceneError(f"the model file '{robot.mjcf}' of robot '{robot.name}' is missing")
    return path


def load_robot(robot: RobotModel) -> Any:
    """Return the engine's editable description of a robot; raises ``SceneError`` if its file is broken."""
    prepared = prepared_robot(robot.mjcf)
    if prepared is not None:
        return prepared.copy()
    try:
        return _read(str(mjcf_path(robot))).copy()
    except ValueError as error:
        raise SceneError(f"the model file of robot '{robot.name}' cannot be read: {error}") from error


@cache
def _read(path: str) -> Any:
    return mujoco.MjSpec.from_file(path)
