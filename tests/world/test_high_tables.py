"""Tables near or above the usual travelling height: parts are lifted off them and over what stands on them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import (
    Body,
    Implementation,
    Link,
    ModelSource,
    Origin,
    Realisation,
    SceneInstance,
)
from robbdd_tools.protocol.specs import ConfigSpec, ExecutionSpec
from robbdd_tools.world.configured_values import read_back
from robbdd_tools.world.motion import tool_pose
from robbdd_tools.world.placement import TABLE_TOP
from robbdd_tools.world.reaching import at_travel, is_high, over_support
from world.arms import MJCF
from world.worlds import BIN, BIN_WS, CUBE, PANDA, SCENE, pick_place, scenario

ARM, BENCH, OTHER = "env:own", "env:bench", "env:bench2"
FLOOR = -0.65
Place = tuple[float, float, float]
SLAB = (
    '<mujoco><worldbody><body name="t"><geom type="box" size=".3 .4 .02" pos="0 0 -.02"/></body></worldbody></mujoco>'
)
PART = """<mujoco><worldbody><body name="p"><freejoint/><geom type="box" size=".015 .015 .015" mass=".05"/></body>
</worldbody></mujoco>"""
SLANTED = "".join(
    f'<geom type="box" size="{half[0]} {half[1]} .06" pos="{at[0]} {at[1]} .06" euler="{turn}"/>'
    for half, at, turn in (
        ((0.005, 0.15), (0.125, 0.0), "0 25 0"),
        ((0.005, 0.15), (-0.125, 0.0), "0 -25 0"),
        ((0.1, 0.005), (0.0, 0.175), "-25 0 0"),
        ((0.1, 0.005), (0.0, -0.175), "25 0 0"),
    )
)
TUB = f"""<mujoco><worldbody><body name="tub"><geom type="box" size=".1 .15 .005" pos="0 0 .005"/>{SLANTED}
<site name="workspace" type="box" size=".09 .14 .05" pos="0 0 .06"/></body></worldbody></mujoco>"""
LID = '<mujoco><worldbody><body name="lid"><geom type="box" size=".1 .1 .005"/></body></worldbody></mujoco>'


def carrying(
    folder: Path, base: Place, things: dict[str, tuple[Place, str]], own: bool, *config: ConfigSpec
) -> Execution:
    """Return the execution in which an arm at ``base`` moves the cube into the tub; things have a place and a file."""
    origin = Origin(str(folder / "cell.scenex"), 3, 7)
    arm = ARM if own else PANDA
    files = {name: text for name, (_, text) in things.items()} | ({ARM: MJCF} if own else {})
    elements: list[Realisation] = []
    for name, text in files.items():
        file = f"{name.partition(':')[2]}.xml"
        (folder / file).write_text(text, encoding="utf-8")
        model = ModelSource(f"x:{folder.name}-{file}", "mjcf", "file", file, origin=origin)
        elements.append(Realisation(name, (replace(model, bodies=((f"x:b-{name}", ""),)),)))
    if not own:
        panda = ModelSource("x:panda", "mjcf", "catalog", "franka-panda", bodies=((f"x:b-{PANDA}", ""),))
        elements.append(Realisation(PANDA, (panda,)))
    places = {name: place for name, (place, _) in things.items()} | {arm: base}
    instance = SceneInstance(
        "x:cell",
        elements=tuple(elements),
        bodies=(Body("x:room", ("x:root",)), *(Body(f"x:b-{name}", (f"x:b-{name}.o",)) for name in places)),
        links=tuple(
            Link(f"x:b-{name}.o", "x:root", "pose", place, (1.0, 0.0, 0.0, 0.0)) for name, place in places.items()
        ),
        anchor="x:root",
    )
    scene = replace(
        SCENE,
        objects=tuple(things),
        agents=(arm,),
        workspaces={"env:bench_ws": (BENCH,), BIN_WS: (BIN,)},
        contains={},
        config=config,
    )
    spec = ExecutionSpec("x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), instance)
    return Execution(replace(scenario(scene), execution=spec), [pick_place(CUBE, BIN_WS, arm)])


@pytest.mark.physics
@pytest.mark.parametrize("height", [0.4, 1.1])
def test_an_arm_works_on_a_low_and_on_a_high_table(tmp_path: Path, height: float) -> None:
    top = FLOOR + height
    things = {BENCH: ((0.5, 0.0, top), SLAB), BIN: ((0.4, 0.25, top), TUB), CUBE: ((0.45, -0.1, top + 0.016), PART)}
    run = carrying(tmp_path, (0.0, 0.0, top), things, own=True)
    assert run.run_behaviour(0), run.trace.remark
    (cube, _), (tub, _) = run.simulation.pose(CUBE), run.simulation.pose(BIN)
    assert abs(cube[:2] - tub[:2]).max() < 0.12


@pytest.mark.physics
@pytest.mark.parametrize("height", [0.4, 1.1])
def test_a_part_is_carried_to_a_lower_and_to_a_higher_table(tmp_path: Path, height: float) -> None:
    top = FLOOR + height
    things = {
        BENCH: ((0.5, 0.0, 0.0), SLAB),
        OTHER: ((0.2, 0.75, top), SLAB),
        BIN: ((0.15, 0.5, top), TUB),
        CUBE: ((0.45, -0.1, 0.016), PART),
    }
    run = carrying(tmp_path, (0.0, 0.0, 0.2 if height > 1.0 else 0.0), things, own=False)
    assert run.run_behaviour(0), run.trace.remark
    (cube, _), (tub, _) = run.simulation.pose(CUBE), run.simulation.pose(BIN)
    assert abs(cube[:2] - tub[:2]).max() < 0.12


@pytest.mark.parametrize(
    ("height", "lid", "lift"), [(1.1, False, 0.10), (1.1, True, 0.0), (0.9, False, 0.10), (0.89, False, 0.03)]
)
def test_a_part_on_a_high_table_is_lifted_unless_something_is_above_it(
    tmp_path: Path, height: float, lid: bool, lift: float
) -> None:
    """A table of 0.89 m is 0.24 m high in the world frame: the tool rises from 0.27 m to 0.30 m.

    The largest table has the usual height.
    """
    top = round(FLOOR + height, 3)
    things = {
        BENCH: ((0.5, 1.5, TABLE_TOP), SLAB),
        OTHER: ((0.5, 0.0, top), SLAB),
        BIN: ((0.4, 0.25, top), TUB),
        CUBE: ((0.45, -0.1, top + 0.015), PART),
    }
    if lid:
        things["env:lid"] = ((0.45, -0.1, top + 0.06), LID)
    simulation = carrying(tmp_path, (0.0, 0.0, top), things, own=True).simulation
    robot = simulation.robots[ARM]
    pose = tool_pose(robot.base, np.array([0.45, -0.1, top + 0.03]), 0.0)
    over = over_support(simulation, robot, CUBE, pose, 0.03 - 1e-3)
    assert over.height - pose.height == pytest.approx(lift, abs=1e-6)


def things_at(height: float) -> dict[str, tuple[Place, str]]:
    """Return a table, a tub and a part at a height (m) of the table's top."""
    part = (0.45, -0.1, height + 0.016), PART
    return {BENCH: ((0.5, 0.0, height), SLAB), BIN: ((0.4, 0.25, height), TUB), CUBE: part}


@pytest.mark.parametrize("height", [TABLE_TOP, 0.89, 1.1])
def test_a_tool_travels_equally_high_above_the_largest_table_wherever_the_origin_is(
    tmp_path: Path, height: float
) -> None:
    """In models of users, the origin of the world is often on the floor."""
    run = carrying(tmp_path, (0.0, 0.0, height), things_at(height), True)
    robot = run.simulation.robots[ARM]
    pose = tool_pose(robot.base, np.array([0.45, -0.1, height + 0.03]), 0.0)
    assert robot.travel_height == pytest.approx(height + 0.2)
    told = read_back(run.simulation, SCENE)[ARM, "travel_height"]
    assert float(told) == pytest.approx(height + 0.2), "clauses see the height that is used"
    assert at_travel(robot, pose).height - pose.height == pytest.approx(0.17, abs=1e-6)
    assert not is_high(robot, pose, 0.03)


def test_a_configured_height_is_that_in_the_world(tmp_path: Path) -> None:
    config = ConfigSpec(ARM, "travel_height", "0.9")
    run = carrying(tmp_path, (0.0, 0.0, 0.5), things_at(0.5), True, config)
    assert run.simulation.robots[ARM].travel_height == pytest.approx(0.9)


@pytest.mark.physics
def test_the_height_of_the_origin_changes_no_verdict(tmp_path: Path) -> None:
    ends: list[list[float]] = []
    for height in (TABLE_TOP, 0.8):
        run = carrying(tmp_path, (0.0, 0.0, height), things_at(height), own=True)
        assert run.run_behaviour(0), run.trace.remark
        place, _ = run.simulation.pose(CUBE)
        ends.append([*place[:2].tolist(), float(place[2]) - height, run.trace.end])
    assert ends[0] == pytest.approx(ends[1], abs=2e-3)
