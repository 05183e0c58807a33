"""Arms of tests as files, and the execution in which such an arm picks and places a cube."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.api import RobotModel
from robbdd_tools.catalog.executable import (
    ArmModel,
    Implementation,
    ModelSource,
    Origin,
    Realisation,
    SceneInstance,
)
from robbdd_tools.protocol.specs import ExecutionSpec, SceneSpec
from robbdd_tools.world.robot_files import robot_from
from world.worlds import BIN_WS, CUBE, SCENE, pick_place, scenario

ARM = "env:own"


def source(folder: Path, text: str, arm: ArmModel | None = None, name: str = "") -> ModelSource:
    is_urdf = text.startswith("<robot")
    name = name or ("arm.urdf" if is_urdf else "arm.xml")
    (folder / name).write_text(text, encoding="utf-8")
    origin = Origin(str(folder / "cell.scenex"), 3, 7)
    return ModelSource("x:arm", "urdf" if is_urdf else "mjcf", "file", name, arm=arm, origin=origin)


def robot(folder: Path, text: str, arm: ArmModel | None = None, name: str = "") -> RobotModel:
    return robot_from(source(folder, text, arm, name), ARM)


def picking(folder: Path, text: str, arm: ArmModel | None = None, scene: SceneSpec | None = None) -> Execution:
    """Return the execution in which an arm from a file moves the cube into the bin."""
    instance = SceneInstance("x:cell", elements=(Realisation(ARM, (source(folder, text, arm),)),))
    execution = ExecutionSpec("x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), instance)
    spec = replace(scenario(scene or replace(SCENE, agents=(ARM,)), 1), execution=execution)
    return Execution(spec, [pick_place(CUBE, BIN_WS, ARM)])
