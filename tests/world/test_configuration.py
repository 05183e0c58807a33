"""Configurations are applied before a scenario starts and read back from the world that came of it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.objects.bin import HEIGHT
from robbdd_tools.catalog.objects.cube import HALF
from robbdd_tools.judging.decisions import decide
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.specs import ConfigSpec, SceneSpec
from robbdd_tools.world.errors import SceneError
from world.worlds import BALL, BIN, BIN_WS, CUBE, OTHER_BIN, PANDA, SCENE, execution, pick_place

pytestmark = pytest.mark.physics


def configured(*wanted: tuple[str, str, str]) -> SceneSpec:
    return replace(SCENE, config=tuple(ConfigSpec(*one) for one in wanted))


def verdict(run: Execution, target: str, name: str, value: str) -> Outcome:
    clause = read_clause(f'"{target}" has config "{name}" = "{value}" before event "t:start"')
    return decide(clause, run.measured(clause, run.trace), run.regions, {"t:start"}).outcome


def started(scene: SceneSpec = SCENE, seed: int = 1) -> Execution:
    run = execution([pick_place()], scene, seed)
    run.advance_until(lambda trace: trace.event_time("t:start") is not None)
    return run


@pytest.mark.parametrize(
    ("target", "name", "value"),
    [
        (CUBE, "mass", "0.2"),
        (CUBE, "friction", "0.3"),
        (BIN, "height_scale", "0.8"),
        (BIN_WS, "height_scale", "1.2"),
        (BIN, "width_scale", "0.9"),
        (CUBE, "size_scale", "1.2"),
        (CUBE, "position_ahead", "0.45"),
        (BALL, "position_left", "-0.2"),
        (CUBE, "contact_time", "0.01"),
        (PANDA, "contact_time", "0.02"),
        (PANDA, "grip_force", "7"),
        (PANDA, "ee_speed", "0.25"),
        (PANDA, "approach_speed", "0.1"),
        (PANDA, "travel_height", "0.4"),
        (PANDA, "carry_clearance", "0.02"),
        (PANDA, "grip_time", "0.08"),
        (PANDA, "release_time", "1"),
        (PANDA, "position_range", "dense"),
        (PANDA, "follow_speed", "0.7"),
        (PANDA, "drop_height", "0.15 0.2"),
        (BALL, "drop_height", "0.2 0.3"),
        (BALL, "position_range", "0.4 0.5 -0.1 0.1"),
        (PANDA, "seed", "17"),
        ("env:bench_scene", "seed", "17"),
    ],
)
def test_a_configuration_holds_once_it_is_applied_and_not_before(target: str, name: str, value: str) -> None:
    run = started(configured((target, name, value)))
    assert verdict(run, target, name, value) is Outcome.HOLDS
    plain = verdict(started(), target, name, value)
    without = target == "env:bench_scene" or name == "drop_height"
    assert plain is (Outcome.UNKNOWN if without else Outcome.VIOLATED)


def test_the_verdict_comes_from_the_world_and_not_from_the_wish() -> None:
    run = started(configured((CUBE, "mass", "0.2")))
    assert run.simulation.model.body(CUBE).mass[0] == pytest.approx(0.2)
    assert verdict(run, CUBE, "mass", "0.3") is Outcome.VIOLATED


def test_a_taller_bin_is_taller_and_so_is_its_workspace() -> None:
    run = started(configured((BIN, "height_scale", "1.5")))
    model = run.simulation.model
    tops = {
        name: max(float(model.geom_pos[g, 2] + model.geom_size[g, 2]) for g in range(model.ngeom) if owner[g] == body)
        for name in (BIN, OTHER_BIN)
        for owner, body in [(model.geom_bodyid, model.body(name).id)]
    }
    # Above the middle.
    assert tops == {BIN: pytest.approx(1.5 * HEIGHT / 2), OTHER_BIN: pytest.approx(HEIGHT / 2)}
    ((_, region),) = run.regions[BIN_WS]
    assert region.center[2] + region.half[2] == pytest.approx(1.5 * HEIGHT / 2)


def test_a_wider_bin_is_wider_and_so_is_its_workspace() -> None:
    run = started(configured((BIN, "width_scale", "0.8")))
    ((_, narrow),), ((_, plain),) = run.regions[BIN_WS], started().regions[BIN_WS]
    assert narrow.half == pytest.approx((0.8 * plain.half[0], 0.8 * plain.half[1], plain.half[2]))
    assert narrow.center == pytest.approx(plain.center)


def test_a_larger_cube_is_larger_in_all_directions_and_as_heavy() -> None:
    model = started(configured((CUBE, "size_scale", "1.5"))).simulation.model
    geom = model.body(CUBE).geomadr[0]
    assert model.geom_size[geom] == pytest.approx([1.5 * HALF] * 3)
    assert model.body(CUBE).mass[0] == pytest.approx(0.031)


@pytest.mark.parametrize(("force", "holds"), [("8", True), ("6", False)])
def test_fingers_hold_what_their_force_allows(force: str, holds: bool) -> None:
    """2 μ F is 4.8 N and 3.6 N; the cube weighs 3.9 N, and more while it is lifted."""
    scene = configured((PANDA, "grip_force", force), (CUBE, "mass", "0.4"), (CUBE, "friction", "0.3"))
    run = execution([pick_place()], scene)
    trace = run.advance_until(lambda _: False)
    assert (trace.event_time("t:place-end") is not None) is holds


def test_a_cup_pulls_with_the_given_force() -> None:
    scene = replace(configured(("env:ur10", "grip_force", "20")), agents=("env:ur10",))
    run = execution([pick_place(agent="env:ur10")], scene)
    assert run.simulation.model.actuator("env:ur10/gripper").gainprm[0] == 20.0


def test_contacts_have_the_time_constant_of_the_smoother_surface_or_of_the_gripping_face() -> None:
    model = started(configured((BIN, "contact_time", "0.008"), (PANDA, "contact_time", "0.03"))).simulation.model
    assert {float(model.geom_solref[geom, 0]) for geom in geoms_of(model, BIN)} == {0.008}
    assert {float(model.geom_solref[geom, 0]) for geom in geoms_of(model, CUBE)} == {0.02}
    assert {float(value) for value in model.pair_solref[:, 0]} == {0.03}


def geoms_of(model: Any, name: str) -> range:
    first = int(model.body(name).geomadr[0])
    return range(first, first + int(model.body(name).geomnum[0]))


def test_an_object_lies_exactly_where_it_is_placed() -> None:
    scene = configured((CUBE, "position_ahead", "0.5"), (CUBE, "position_left", "-0.15"))
    for seed in range(3):
        run = started(scene, seed)
        assert run.trace.positions[0, run.trace.column(CUBE), :2] == pytest.approx([0.5, -0.15], abs=1e-3)


def test_an_exact_place_that_only_leaves_no_room_for_a_hand_is_taken_and_not_counted_as_drawn_again() -> None:
    run = started(configured((CUBE, "position_ahead", "0.5"), (CUBE, "position_left", "0.42")))
    assert run.simulation.world.resampled == 0
    assert run.trace.positions[0, run.trace.column(CUBE), :2] == pytest.approx([0.5, 0.42], abs=1e-3)


def test_things_lie_within_the_range_that_is_asked_for() -> None:
    scene = configured((PANDA, "position_range", "0.35 0.45 0.1 0.3"), (BALL, "position_range", "dense"))
    for seed in range(5):
        run = started(scene, seed)
        x, y, _ = run.trace.positions[0, run.trace.column(CUBE)]
        assert 0.35 - 1e-3 <= x <= 0.45 + 1e-3
        assert 0.1 - 1e-3 <= y <= 0.3 + 1e-3


def test_a_slower_arm_takes_longer_and_stays_below_its_speed() -> None:
    ends: list[float] = []
    for speed in (0.2, 0.5):
        run = execution([pick_place()], configured((PANDA, "ee_speed", str(speed))))
        trace = run.advance_until(lambda _: False)
        tool = trace.positions[:, trace.column(PANDA)]
        speeds = np.linalg.norm(np.diff(tool, axis=0), axis=1) / np.diff(trace.times)
        assert speeds.max() < 1.1 * speed
        ends.append(trace.event_time("t:place-end") or 0.0)
    assert ends[0] > 1.5 * ends[1] > 0.0


def ending(*wanted: tuple[str, str, str], robot: str = PANDA) -> Execution:
    run = execution([pick_place(agent=robot)], replace(configured(*wanted), agents=(robot,)))
    run.advance_until(lambda _: False)
    assert run.completed == 1
    return run


def lasts(run: Execution, start: str, end: str) -> float:
    """Return the time from one event to another, s."""
    begins, ends = run.trace.event_time(start), run.trace.event_time(end)
    assert begins is not None
    assert ends is not None
    return ends - begins


def highest(run: Execution, robot: str) -> float:
    """Return the greatest height (m) of the tool while it travels with its load."""
    start, end = run.trace.event_time("t:place-start"), run.trace.event_time("t:place-end")
    assert start is not None
    assert end is not None
    during = (run.trace.times >= start) & (run.trace.times <= end)
    return float(run.trace.positions[during, run.trace.column(robot), 2].max())


@pytest.mark.parametrize("robot", [PANDA, "env:ur10"])
def test_the_phases_of_pick_and_place_take_as_long_as_is_asked_for(robot: str) -> None:
    plain = ending(robot=robot)
    picks, places = lasts(plain, "t:pick-start", "t:pick-end"), lasts(plain, "t:place-start", "t:place-end")
    waits = ending((robot, "release_time", "1.32"), robot=robot)
    assert lasts(waits, "t:place-start", "t:place-end") == pytest.approx(places + 1.0, abs=0.05)
    assert lasts(waits, "t:pick-start", "t:pick-end") == pytest.approx(picks)
    watches = ending((robot, "grip_time", "0.66"), robot=robot)
    times = 2 if robot == PANDA else 1
    assert lasts(watches, "t:pick-start", "t:pick-end") == pytest.approx(picks + 0.5 * times, abs=0.05)
    assert lasts(ending((robot, "approach_speed", "0.05"), robot=robot), "t:pick-start", "t:pick-end") > picks + 1.0


def test_the_tool_travels_as_high_as_is_asked_for() -> None:
    assert highest(ending(), PANDA) == pytest.approx(0.30, abs=0.01)
    assert highest(ending((PANDA, "travel_height", "0.4")), PANDA) == pytest.approx(0.40, abs=0.01)


def test_what_is_written_out_as_it_is_by_itself_changes_no_bit() -> None:
    written = (("ee_speed", "0.5"), ("travel_height", "0.3"), ("grip_time", "0.16"), ("release_time", "0.32"))
    plain, same = ending(), ending(*((PANDA, name, value) for name, value in written))
    assert plain.trace.positions.tobytes() == same.trace.positions.tobytes()
    assert plain.trace.events == same.trace.events


def test_a_seed_of_the_model_outranks_that_of_the_run() -> None:
    scene = configured((PANDA, "seed", "5"))
    one, two, plain = started(scene, 1), started(scene, 2), started(seed=5)
    assert one.trace.positions[0].tobytes() == two.trace.positions[0].tobytes() == plain.trace.positions[0].tobytes()


@pytest.mark.parametrize(
    ("wanted", "message"),
    [
        (
            [(CUBE, "colour", "red")],
            "there is no configuration 'colour'; the known ones are approach_speed, attach_distance,",
        ),
        ([(CUBE, "mass", "heavy")], "'env:cube1' cannot be configured: 'mass' cannot be 'heavy': it must be a number"),
        ([(CUBE, "ee_speed", "1")], "'env:cube1' has no ee_speed: it applies to an agent"),
        ([(PANDA, "mass", "1")], "'env:panda' has no mass: it applies to a loose object"),
        ([("env:bench", "height_scale", "1")], "'env:bench' has no height_scale: it applies to a bin, tray or shelf"),
        ([("env:bolt", "mass", "1")], "'env:bolt', which should have mass = 1, is not in the scene"),
        ([(CUBE, "mass", "1"), (CUBE, "mass", "2")], "'env:cube1' should have mass = 1 and 2"),
        ([(CUBE, "position_ahead", "1.5")], "no part of 'env:bench', where 'env:cube1' should be"),
        (
            [(CUBE, "position_ahead", "0.5"), (CUBE, "position_left", "0.6")],
            "there is no room left for 'env:cube1' at its exact place: 'env:bin1' is there",
        ),
        (
            [(name, key, "0.4") for name in (CUBE, BALL) for key in ("position_ahead", "position_left")],
            "at its exact place: 'env:ball1' is there",
        ),
        ([(CUBE, "grip_force", "5")], "'env:cube1' has no grip_force: it applies to an agent"),
        ([(BIN, "size_scale", "1.1")], "'env:bin1' has no size_scale: it applies to an object of the catalog to grasp"),
        ([(CUBE, "position_range", "1.5 1.6 0 0.1")], "no part of 'env:bench', where 'env:cube1' should be"),
    ],
)
def test_what_cannot_be_set_up_is_explained(wanted: list[tuple[str, str, str]], message: str) -> None:
    with pytest.raises(SceneError) as error:
        execution([pick_place()], configured(*wanted))
    assert message in str(error.value)


def test_a_stated_mass_is_that_of_a_model_of_the_catalog() -> None:
    run = started(replace(SCENE, stated=(ConfigSpec(CUBE, "mass", "0.2"), ConfigSpec(BALL, "friction", "0.3"))))
    assert verdict(run, CUBE, "mass", "0.2") is Outcome.HOLDS
    assert verdict(run, BALL, "friction", "0.3") is Outcome.HOLDS


def test_a_given_clause_replaces_a_stated_mass() -> None:
    run = started(replace(configured((CUBE, "mass", "0.1")), stated=(ConfigSpec(CUBE, "mass", "0.2"),)))
    assert verdict(run, CUBE, "mass", "0.1") is Outcome.HOLDS


def test_a_stated_mass_outside_the_limits_is_refused() -> None:
    with pytest.raises(SceneError, match="'mass' cannot be '0'"):
        started(replace(SCENE, stated=(ConfigSpec(CUBE, "mass", "0"),)))


def test_the_stated_mass_of_a_fixed_object_only_describes() -> None:
    run = started(replace(SCENE, stated=(ConfigSpec("env:bench", "mass", "60"),)))
    assert ("env:bench", "mass") not in run.trace.settings
