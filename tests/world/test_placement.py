"""Initial places of objects."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from math import hypot

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robbdd_tools.catalog.objects.table import HEIGHT
from robbdd_tools.protocol.specs import SceneSpec
from robbdd_tools.world.composition import build_world
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.free_places import Field, Size, Taken, draw_place
from robbdd_tools.world.placement import TABLE_TOP, Pose, arrange, footprint, mounts
from robbdd_tools.world.scene import PEDESTAL, cast_scene
from world.worlds import BALL, BENCH_WS, BIN, BIN_WS, CUBE, OTHER_BIN, SCENE

MANY = replace(SCENE, objects=(*SCENE.objects, *(f"env:cube{number}" for number in range(2, 6)), "env:ball2"))


def places(scene: SceneSpec, seed: int = 1) -> dict[str, Pose]:
    cast = cast_scene(scene)
    base = next(iter(mounts(cast).values()), Pose((0.0, 0.0, 0.0)))
    return arrange(scene, cast, base, np.random.default_rng(seed)).poses


def test_a_workspace_that_nothing_carries_is_the_union_of_those_that_it_lists() -> None:
    """Both boards of the shelf are workspaces; the area lists the lower one only, and the block all of these."""
    shelf, lower, upper, area, block = "env:shelf", "env:lower_ws", "env:upper_ws", "env:area_ws", "env:block_ws"
    scene = replace(
        SCENE,
        objects=(*SCENE.objects, shelf),
        workspaces={**SCENE.workspaces, lower: (shelf,), upper: (shelf,), area: ()},
        contains={**SCENE.contains, area: (lower,), block: (area, upper, lower)},
    )
    regions = cast_scene(scene).regions
    assert len(regions[lower]) == len(regions[upper]) == 1
    assert regions[area] == regions[lower]
    assert set(regions[block]) == {*regions[lower], *regions[upper]}
    assert len(regions[block]) == 2


def test_the_seed_decides() -> None:
    assert places(SCENE, 5) == places(SCENE, 5)
    assert places(SCENE, 5)[CUBE] != places(SCENE, 6)[CUBE]
    assert places(SCENE, 5)[BIN] == places(SCENE, 6)[BIN]


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=60)
def test_things_lie_apart_before_the_robot_and_clear_of_the_bins(seed: int) -> None:
    cast, poses = cast_scene(MANY), places(MANY, seed)
    things = [name for name, model in cast.objects.items() if model.graspable]
    for name in things:
        x, y, z = poses[name].position
        assert 0.25 <= x <= 0.60
        assert -0.40 <= y <= 0.40
        assert z == pytest.approx(TABLE_TOP + cast.objects[name].rest_height)
        for other in (BIN, OTHER_BIN):
            assert abs(y - poses[other].position[1]) > 0.10 + footprint(cast.objects[name])
    for one, other in combinations(things, 2):
        (ax, ay, _), (bx, by, _) = poses[one].position, poses[other].position
        assert hypot(ax - bx, ay - by) > footprint(cast.objects[one]) + footprint(cast.objects[other])


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=30)
def test_a_thing_lies_in_the_bin_that_the_scene_names(seed: int) -> None:
    scene = replace(SCENE, places={CUBE: BIN_WS, BALL: BENCH_WS})
    poses = places(scene, seed)
    assert abs(poses[CUBE].position[0] - poses[BIN].position[0]) < 0.1
    assert abs(poses[CUBE].position[1] - poses[BIN].position[1]) < 0.06
    assert abs(poses[BALL].position[1]) <= 0.4


def test_without_a_table_things_stand_on_a_pedestal() -> None:
    poses = places(SceneSpec(objects=(CUBE, BIN), agents=("env:panda",), workspaces={BIN_WS: (BIN,)}))
    assert poses.keys() == {PEDESTAL, CUBE, BIN}
    assert poses[PEDESTAL].position[2] == pytest.approx(TABLE_TOP - HEIGHT / 2)


def test_a_bin_stands_on_the_table_whose_workspace_holds_its_own() -> None:
    scene = SceneSpec(
        objects=("env:table1", "env:table2", BIN),
        workspaces={"env:t1_ws": ("env:table1",), "env:t2_ws": ("env:table2",), BIN_WS: (BIN,)},
        contains={"env:t2_ws": (BIN_WS,)},
    )
    poses = places(scene)
    assert poses[BIN].position[0] < 0 < poses["env:table1"].position[0]


def test_a_second_robot_faces_the_first_across_the_table() -> None:
    scene = replace(SCENE, agents=("env:panda1", "env:panda2"))
    first, second = mounts(cast_scene(scene)).values()
    assert first.position[0] < places(scene)["env:bench"].position[0] < second.position[0]


BALLS = tuple(f"t:ball{number}" for number in range(40))


@pytest.mark.parametrize(
    ("scene", "message"),
    [
        (
            replace(SCENE, objects=("env:gizmo",)),
            "no model for object 'env:gizmo': .* one of apple, article, ball, basket, beaker, beam, belt, bench, bin, ",
        ),
        (
            replace(SCENE, agents=("env:hal",)),
            "no model for agent 'env:hal': .* one of franka, gen3, human, kinova, mobile, ",
        ),
        (
            replace(SCENE, agents=tuple(f"t:panda{number}" for number in range(1, 6))),
            "room for 4 agents around 'env:bench', one at each side; place t:panda5 in a .scenex",
        ),
        (replace(SCENE, places={CUBE: "env:void_ws"}), "'env:cube1' should be at 'env:void_ws', but nothing"),
        (replace(SCENE, workspaces={BIN_WS: ("env:bin9",)}), "carried by 'env:bin9', which is not in the scene"),
        (
            replace(SCENE, objects=(*SCENE.objects, "t:bin3", "t:bin4", "t:bin5")),
            "room for 4 objects of the kind 'bin'",
        ),
        (
            replace(SCENE, objects=(*SCENE.objects, *(f"t:ball{n}" for n in range(200)))),
            "no room left for 't:ball[0-9]+' at 'env:bench' ",
        ),
        (
            replace(SCENE, objects=(*SCENE.objects, *BALLS), places=dict.fromkeys(BALLS, BIN_WS)),
            f"no room left for 't:ball[0-9]+' at '{BIN_WS}' among",
        ),
    ],
)
def test_a_scene_that_cannot_be_is_explained(scene: SceneSpec, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        places(scene)


def test_a_free_place_keeps_the_gap_between_the_circles_of_objects() -> None:
    field = Field((0.5, 0.0), (0.2, 0.2), 0.0, 0.0, 0.03, None, Pose((0.0, 0.0, 0.0)))
    other = Taken("env:other", 0.5, 0.0, 0.05)
    rng = np.random.default_rng(1)
    places = [
        draw_place("env:x", "env:ws", Size(0.04, 0.02), [field], [other], [], rng)[0].position for _ in range(200)
    ]
    nearest = min(hypot(x - other.x, y - other.y) for x, y, _ in places)
    assert 0.05 + 0.04 + 0.03 <= nearest < 0.05 + 0.04 + 0.03 + 0.02


def test_places_that_overlap_are_drawn_again_and_counted() -> None:
    alone = replace(SCENE, objects=(CUBE, "env:bench"), workspaces={}, contains={})
    crowd = replace(alone, objects=(*alone.objects, *(f"t:ball{number}" for number in range(12))))
    assert build_world(alone, 1).resampled == 0
    world = build_world(crowd, 1)
    assert world.resampled > 0
    assert build_world(crowd, 1).resampled == world.resampled


def test_four_arms_fit_around_a_table_and_each_has_things_within_reach() -> None:
    agents = tuple(f"t:panda{number}" for number in range(1, 5))
    scene = replace(SCENE, agents=agents)
    cast = cast_scene(scene)
    bases = mounts(cast)
    assert all(
        hypot(*(a - b for a, b in zip(one.position, other.position, strict=True))) > 0.8
        for one, other in combinations(bases.values(), 2)
    )
    for base in bases.values():
        x, y, _ = arrange(scene, cast, base, np.random.default_rng(1)).poses[CUBE].position
        assert hypot(x - base.position[0], y - base.position[1]) < 0.75


def test_what_no_clause_speaks_of_needs_neither_model_nor_place() -> None:
    scene = replace(
        SCENE,
        objects=(*SCENE.objects, "env:first-aid-kit"),
        agents=("env:arm1", "env:panda", "env:ur10"),
        unused=("env:first-aid-kit", "env:arm1", "env:ur10"),
    )
    cast = cast_scene(scene)
    assert tuple(cast.agents) == ("env:panda",)
    assert cast.left_out == ("env:first-aid-kit", "env:arm1", "env:ur10")
    with pytest.raises(SceneError, match="no model for object 'env:first-aid-kit'"):
        cast_scene(replace(scene, unused=("env:arm1", "env:ur10")))


def test_the_name_of_a_set_chooses_a_model() -> None:
    cast = cast_scene(replace(SCENE, agents=("env:robot1",), sets={"env:robot1": ("panda_arms",)}))
    assert cast.agents["env:robot1"].name == "franka-panda"
