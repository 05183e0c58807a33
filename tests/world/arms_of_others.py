"""Arms of other projects as shipped, from the folder that ``make arms`` fills, and the cell in which they are tried."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import (
    ArmModel,
    Body,
    Friction,
    Implementation,
    Link,
    ModelSource,
    MountedGripper,
    Origin,
    Realisation,
    SceneInstance,
)
from robbdd_tools.protocol.specs import ExecutionSpec
from world.worlds import BIN, BIN_WS, CUBE, SCENE, pick_place, scenario

FOLDER = Path(os.environ.get("ROBBDD_ARMS") or Path(__file__).parents[2] / "build" / "arms")
"""Folder of the unpacked wheels."""
OWN = "env:own"
HEIGHT = 0.15
"""Height (m) of the arm's base above the table, as that of the catalog's arms."""
NEAR = 0.15
"""Distance (m) of the cube from the middle of the bin up to which it is in the bin."""
_MANI_SKILL = "mani_skill/assets/robots"
_EXAMPLES = "cmeel.prefix/share/example-robot-data/robots"
_PYBULLET, _ROBOSUITE = "pybullet_data", "robosuite/models/assets"


@dataclass(frozen=True, slots=True)
class Arm:
    """An arm as shipped.

    - ``path``: its file in the folder, and ``hand`` that of a gripper that is fixed to its ``right_hand``.
    - ``forward``: how much (m) nearer to the table than the catalog's arms its base stands.
    - ``height``: height (m) of its base above the table.
    - ``friction``: the stated coefficient between gripper and cube; 0 means that the files decide.
    - ``works``: the number of seeds from 1 to 10 with which the cube ends in the bin.
    """

    name: str
    path: str
    works: int
    hand: str = ""
    forward: float = 0.0
    friction: float = 0.0
    height: float = HEIGHT


def _robosuite(name: str, folder: str, works: int, hand: str, forward: float = 0.0, friction: float = 0.0) -> Arm:
    path, gripper = f"{_ROBOSUITE}/robots/{folder}/robot.xml", f"{_ROBOSUITE}/grippers/{hand}_gripper.xml"
    return Arm(name, path, works, gripper, forward, friction)


ARMS = (
    Arm("panda-of-pybullet", f"{_PYBULLET}/franka_panda/panda.urdf", 10),
    Arm("xarm6-of-pybullet", f"{_PYBULLET}/xarm/xarm6_with_gripper.urdf", 10, forward=0.08),
    _robosuite("panda-of-robosuite", "panda", 10, "panda"),
    _robosuite("ur5e-of-robosuite", "ur5e", 10, "panda"),
    _robosuite("sawyer-of-robosuite", "sawyer", 10, "rethink", friction=0.8),
    _robosuite("iiwa-of-robosuite", "iiwa", 6, "panda"),
    _robosuite("gen3-of-robosuite", "kinova3", 10, "panda", forward=0.08),
    _robosuite("jaco-of-robosuite", "jaco", 10, "panda", forward=0.08),
    _robosuite("xarm7-of-robosuite", "xarm7", 10, "panda", forward=0.08),
    Arm("fetch-of-mani-skill", f"{_MANI_SKILL}/fetch/fetch.urdf", 10, forward=-0.1, height=-0.64),
    Arm("panda-of-mani-skill", f"{_MANI_SKILL}/panda/panda_v2.urdf", 10),
    Arm("panda-with-camera-of-mani-skill", f"{_MANI_SKILL}/panda/panda_v3.urdf", 10),
    Arm("panda-that-pinches-of-mani-skill", f"{_MANI_SKILL}/panda/panda_pinch.urdf", 10),
    Arm("panda-of-example-robot-data", f"{_EXAMPLES}/panda_description/urdf/panda.urdf", 10),
    Arm(
        "panda-urdf-of-robosuite", "robosuite/models/assets/bullet_data/panda_description/urdf/panda_arm_hand.urdf", 10
    ),
    Arm("panda-of-gym-hil", "gym_hil/assets/scene.xml", 10),
)


def source_of(arm: Arm) -> ModelSource:
    """Return the source of an arm."""
    path = FOLDER / arm.path
    kind = "urdf" if path.suffix == ".urdf" else "mjcf"
    mounted = MountedGripper("file", str(FOLDER / arm.hand), "right_hand") if arm.hand else None
    stated = None if mounted is None else ArmModel(mounted=mounted)
    return ModelSource(f"x:{arm.name}", kind, "file", str(path), arm=stated, origin=Origin(str(path), 1, 1))


def picking(arm: Arm, seed: int) -> Execution:
    """Return the execution in which an arm moves the cube from the table into the bin."""
    source = replace(source_of(arm), bodies=(("x:own", ""),))
    instance = SceneInstance(
        "x:cell",
        elements=(Realisation(OWN, (source,)),),
        bodies=(Body("x:room", ("x:root",)), Body("x:own", ("x:own.foot",))),
        links=(Link("x:own.foot", "x:root", "pose", (arm.forward, 0.0, arm.height), (1.0, 0.0, 0.0, 0.0)),),
        anchor="x:root",
        frictions=(Friction(OWN, CUBE, arm.friction),) if arm.friction else (),
    )
    execution = ExecutionSpec("x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), instance)
    spec = replace(scenario(replace(SCENE, agents=(OWN,)), seed), execution=execution)
    return Execution(spec, [pick_place(CUBE, BIN_WS, OWN)])


def outcome(arm: Arm, seed: int) -> str:
    """Return ``in the bin``, or why the cube is not there."""
    run = picking(arm, seed)
    run.run_behaviour(0)
    (cube, _), (container, _) = run.simulation.pose(CUBE), run.simulation.pose(BIN)
    return "in the bin" if abs(cube[:2] - container[:2]).max() < NEAR else run.trace.remark
