"""Overlapping initial poses are reported; nothing is silently pushed apart."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from robbdd_tools.agent.behaviour_run import BehaviourRun
from robbdd_tools.catalog.executable import (
    Body,
    Implementation,
    Link,
    ModelSource,
    Origin,
    Realisation,
    SceneInstance,
)
from robbdd_tools.protocol.specs import ExecutionSpec, SceneSpec
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.fixed_faults import fixed_faults
from robbdd_tools.world.placement import TABLE_TOP
from world.arms import MJCF
from world.scene_instances import instance, link
from world.worlds import BALL, BENCH_WS, CUBE, PANDA, SCENE, scenario

HALF_CUBE, RADIUS = 0.01575, 0.030
ON_TABLE = replace(SCENE, objects=(CUBE, BALL, "env:bench"), workspaces={BENCH_WS: ("env:bench",)}, contains={})


def course(scene: SceneSpec = ON_TABLE, **places: tuple[float, float, float]) -> BehaviourRun:
    """Set up a scene in which cubes and balls are given places (m, world frame)."""
    links = tuple(Link(f"x:{n}.mid", "x:root", "pose", place, (1.0, 0.0, 0.0, 0.0)) for n, place in places.items())
    bodies = (Body("x:room", ("x:root",)), *(Body(f"x:{name}", (f"x:{name}.mid",)) for name in places))
    elements = tuple(
        Realisation(
            f"env:{name}",
            (ModelSource(f"x:m-{name}", "mjcf", "catalog", name.rstrip("1234"), bodies=((f"x:{name}", "body"),)),),
            Origin("/w/cell.scenex", 7, 5),
        )
        for name in places
    )
    instance = SceneInstance("x:cell", (), elements, bodies, links, (), "x:root")
    execution = ExecutionSpec("x:e", "x:e", Implementation("x:i", "catalog", "pick-place"), instance)
    return BehaviourRun(replace(scenario(scene), execution=execution), ())


def test_things_that_touch_stay_where_they_are_given() -> None:
    height = TABLE_TOP + HALF_CUBE
    found = course(cube1=(0.5, 0.1, height), ball1=(0.5, 0.1 + HALF_CUBE + RADIUS + 0.002, TABLE_TOP + RADIUS))
    assert found.simulation.pose(CUBE)[0] == pytest.approx((0.5, 0.1, height), abs=1e-3)


def test_two_things_in_one_another_are_named_with_their_depth() -> None:
    height = TABLE_TOP + RADIUS
    with pytest.raises(
        SceneError,
        match=r"^cell\.scenex:7:5: 'env:ball1' and 'env:cube1' overlap by 12 mm: nothing may overlap",
    ):
        course(cube1=(0.5, 0.1, height), ball1=(0.5, 0.1 + HALF_CUBE + RADIUS - 0.012, height))


def test_a_body_that_an_arms_file_fixes_to_the_room_is_named(tmp_path: Path) -> None:
    wall = '<body name="wall" pos="0.5 0 0"><geom type="box" size="0.1 0.5 0.5"/></body></worldbody>'
    (tmp_path / "arm.xml").write_text(MJCF.replace("</worldbody>", wall), encoding="utf-8")
    arm = ModelSource("x:arm", "mjcf", "file", "arm.xml", origin=Origin(str(tmp_path / "cell.scenex"), 3, 7))
    cube = ModelSource("x:cube", "mjcf", "catalog", "cube", bodies=(("x:g.cube", "b"),))
    elements = Realisation(CUBE, (cube,)), Realisation("env:own", (arm,), is_agent=True)
    staged = instance(link("x:g.cube.f", (0.5, 0.1, 0.116)), elements=elements)
    execution = ExecutionSpec("x:e", "x:e", Implementation("x:i", "catalog", "pick-place"), staged)
    scene = replace(ON_TABLE, objects=(CUBE, "env:bench"), agents=("env:own",))
    with pytest.raises(SceneError, match=r"'env:cube1' and 'wall' of 'env:own' overlap by \d+ mm"):
        BehaviourRun(replace(scenario(scene), execution=execution), ())


def test_a_thing_in_the_table_is_named_with_its_depth() -> None:
    with pytest.raises(SceneError, match="'env:bench' and 'env:cube1' overlap by 7 mm"):
        course(cube1=(0.5, 0.1, TABLE_TOP + HALF_CUBE - 0.007))


def test_a_resting_contact_may_be_a_little_deep() -> None:
    course(cube1=(0.5, 0.1, TABLE_TOP + HALF_CUBE - 0.0009))
    with pytest.raises(SceneError, match="overlap by 1 mm"):
        course(cube1=(0.5, 0.1, TABLE_TOP + HALF_CUBE - 0.0012))


def test_a_thing_in_the_arm_is_reported() -> None:
    tool = course().simulation.data.body(f"{PANDA}/hand").xpos
    with pytest.raises(SceneError, match="'env:cube1' and 'env:panda' overlap"):
        course(cube1=(float(tool[0]), float(tool[1]), float(tool[2])))


BALLS = tuple(f"env:ball{number}" for number in range(1, 5))


def test_the_deepest_overlaps_are_named_first_and_the_others_counted() -> None:
    scene = replace(ON_TABLE, objects=(CUBE, *BALLS, "env:bench"))
    height = TABLE_TOP + RADIUS
    deep = {f"ball{number}": (0.5, 0.1 * number, height - 0.002 * number) for number in range(1, 5)}
    with pytest.raises(SceneError) as caught:
        course(scene, **deep)
    assert str(caught.value).startswith(
        "cell.scenex:7:5: 'env:ball4' and 'env:bench' overlap by 8 mm; 'env:ball3' and 'env:bench' overlap by 6 mm; "
        "'env:ball2' and 'env:bench' overlap by 4 mm; 1 more pairs overlap: "
    )


def test_of_two_contacts_of_a_pair_the_deeper_one_counts() -> None:
    scene = replace(ON_TABLE, objects=("env:cube1", "env:cube2", "env:bench"))
    with pytest.raises(SceneError, match=r"'env:cube1' and 'env:cube2' overlap by 12 mm: "):
        course(scene, cube1=(0.5, 0.1, 0.3), cube2=(0.5, 0.1 + 2 * HALF_CUBE - 0.012, 0.31))


@pytest.mark.parametrize(("height", "depth"), [(0.1, 0), (0.09, 10)])
def test_two_fixed_things_that_overlap_are_found_while_editing(tmp_path: Path, height: float, depth: int) -> None:
    """Nothing moves them, and nothing else would say that one was placed 10 mm too low."""
    (tmp_path / "plate.xml").write_text(
        '<mujoco><worldbody><body name="plate"><geom type="box" size=".3 .3 .05" pos="0 0 .05"/></body>'
        "</worldbody></mujoco>"
    )
    elements = tuple(
        Realisation(
            f"env:{name}",
            (
                ModelSource(
                    f"x:{name}",
                    "mjcf",
                    "file",
                    "plate.xml",
                    bodies=((f"x:g.{name}", "plate"),),
                    origin=Origin(str(tmp_path / "cell.scenex"), 7, 5),
                ),
            ),
        )
        for name in ("lower", "upper")
    )
    links = link("x:g.lower.foot", (0.5, 0.0, 0.0)), link("x:g.upper.foot", (0.5, 0.0, height))
    found = [str(one) for one in fixed_faults(instance(*links, elements=elements))]
    words = [f"'env:lower' and 'env:upper' overlap by {depth} mm: nothing may overlap at the start"] if depth else []
    assert [one[one.index("'env") :] for one in found] == words
