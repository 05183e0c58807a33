"""Faults of robots change what the simulated robot does in the stated way, and nothing else."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING

import numpy as np
import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import Implementation, Origin
from robbdd_tools.catalog.robot_faults import ROBOT_FAULTS, robot_fault
from robbdd_tools.protocol.specs import ConfigSpec, ExecutionSpec, SceneSpec
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.user_behaviour import AgentWorld
from world.worlds import BALL, BIN, BIN_WS, CUBE, OTHER_BIN, PANDA, SCENE, pick_place, scenario

if TYPE_CHECKING:
    from pathlib import Path

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.monitor.trace import Trace

pytestmark = pytest.mark.physics
ALONE = replace(SCENE, objects=(CUBE, BIN, "env:bench"), workspaces={BIN_WS: (BIN,)}, contains={})


def begun(fault: str, scene: SceneSpec = SCENE) -> Execution:
    spec = replace(scenario(scene), fault=robot_fault(fault) if fault else None)
    return Execution(spec, [pick_place()])


@cache
def trace(fault: str = "", config: tuple[str, str] = ("", "")) -> Trace:
    """The whole execution with a fault and a configuration of the cube."""
    scene = replace(SCENE, config=(ConfigSpec(CUBE, *config),)) if config[0] else SCENE
    return begun(fault, scene).advance_until(lambda found: found.event_time("t:end") is not None)


def row(found: Trace, event: str) -> int:
    time = found.event_time(event)
    assert time is not None
    return int(np.searchsorted(found.times, time - 1e-9))


def grips(found: Trace) -> FloatArray:
    """Whether the Panda holds the cube, in each sample."""
    return found.grips[PANDA][:, found.column(CUBE)]


def released(found: Trace) -> int:
    return int(np.flatnonzero(grips(found))[-1]) + 1


def at(found: Trace, name: str, sample: int) -> FloatArray:
    return found.positions[sample, found.column(name)]


def seconds(found: Trace, sample: int) -> float:
    return float(found.times[sample])


def test_a_weak_gripper_loses_what_a_sound_one_carries() -> None:
    heavy = ("mass", "0.8")
    assert at(trace("", heavy), CUBE, row(trace("", heavy), "t:pick-end"))[2] > 0.25
    weak = trace("weak-grip=0.1", heavy)
    assert at(weak, CUBE, -1)[2] < 0.15
    sound = begun("").simulation.model.actuator_forcerange.max(axis=1)
    share = begun("weak-grip").simulation.model.actuator_forcerange.max(axis=1) / sound
    assert sorted(set(share.tolist())) == [0.25, 1.0]


def test_an_offset_moves_the_grasp_beside_the_object() -> None:
    def gap(found: Trace) -> float:
        first = int(np.flatnonzero(grips(found))[0])
        return float(np.linalg.norm((at(found, PANDA, first) - at(found, CUBE, first))[:2]))

    assert gap(trace()) < 2e-3
    # The fingers push the object along their axis; across it, the offset remains.
    assert 3e-3 < gap(trace("offset-pose=12")) < 13e-3


def test_noise_is_drawn_anew_for_each_reading_and_from_the_seed() -> None:
    simulation = begun("sensor-noise").simulation
    truth, _ = simulation.pose(CUBE)
    errors = np.array([simulation.seen(CUBE)[0] - truth for _ in range(500)])
    assert errors.std(axis=0) == pytest.approx(5e-3, rel=0.15)
    assert np.abs(errors.mean(axis=0)).max() < 1e-3
    again = begun("sensor-noise").simulation
    assert np.array_equal(again.seen(CUBE)[0] - truth, errors[0])


def test_backlash_lets_the_first_joint_trail_by_half_of_it() -> None:
    run, sound = begun("backlash=4"), begun("")
    robot = run.simulation.robots[PANDA]
    joint = int(robot.joints[0])
    last: list[float] = []
    for one in (sound, run):
        one.advance_until(lambda found: found.event_time("t:place-start") is not None)
        size = len(one.trace.times)
        last.append(float(one.simulation.recorder.states[size - 1, joint]))
    assert abs(last[1] - last[0]) == pytest.approx(np.deg2rad(2.0), rel=0.2)


def test_the_speed_of_the_arm_changes_its_time() -> None:
    def duration(found: Trace) -> float:
        return seconds(found, row(found, "t:place-end")) - seconds(found, row(found, "t:pick-start"))

    assert duration(trace("slow-arm")) > 1.3 * duration(trace())
    assert duration(trace("fast-arm")) < duration(trace())


def test_releases_are_late_early_or_too_high() -> None:
    sound, late, early, high = trace(), trace("late-release"), trace("early-release"), trace("high-release")
    assert seconds(late, released(late)) == pytest.approx(seconds(sound, released(sound)) + 0.5, abs=0.05)
    # The tool has not yet reached the height of the release.
    assert at(early, PANDA, released(early))[2] > at(sound, PANDA, released(sound))[2] + 5e-3
    assert at(high, CUBE, released(high))[2] == pytest.approx(at(sound, CUBE, released(sound))[2] + 0.05, abs=5e-3)


def test_an_early_release_moves_the_arm_no_faster_and_ends_at_the_same_place() -> None:
    sound, early = trace(), trace("early-release")
    speeds = [
        np.linalg.norm(np.diff(one.positions[:, one.column(PANDA)], axis=0), axis=1).max() for one in (sound, early)
    ]
    assert speeds[1] == pytest.approx(speeds[0], rel=0.02)
    assert at(early, PANDA, -1) == pytest.approx(at(sound, PANDA, -1), abs=2e-3)


def test_the_gripper_never_closes_or_never_opens() -> None:
    assert not grips(trace("no-grip")).any()
    assert grips(trace("no-release"))[-1]


def test_the_arm_stays_where_it_releases() -> None:
    stuck = trace("no-retreat")
    assert at(stuck, PANDA, -1) == pytest.approx(at(stuck, PANDA, released(stuck)), abs=5e-3)
    assert at(trace(), PANDA, -1)[2] > at(stuck, PANDA, -1)[2] + 0.05


def test_another_object_or_another_bin_is_used() -> None:
    other, away = trace("swapped-object"), trace("swapped-goal")
    assert np.linalg.norm((at(other, BALL, -1) - at(other, BIN, -1))[:2]) < 0.12
    assert np.linalg.norm((at(away, CUBE, -1) - at(away, OTHER_BIN, -1))[:2]) < 0.12


@pytest.mark.parametrize(
    ("fault", "reason"),
    [
        ("swapped-object", f"the scene has no other loose object than {CUBE}"),
        ("swapped-goal", f"the scene has no other workspace than {BIN_WS}"),
    ],
)
def test_a_fault_that_cannot_occur_is_refused(fault: str, reason: str) -> None:
    with pytest.raises(SceneError, match=reason):
        begun(fault, ALONE)


def test_a_fault_begins_with_the_scenario_and_repeats() -> None:
    """The settled world is the same with every fault; the same fault gives the same execution."""
    for name in ROBOT_FAULTS:
        assert np.array_equal(begun(name).trace.positions[0], trace().positions[0])
    trace.cache_clear()
    first = trace("sensor-noise").positions
    trace.cache_clear()
    assert np.array_equal(trace("sensor-noise").positions, first)


WATCH = """
class Watch:
    seen = []

    def reset(self, world, behaviour, arguments):
        self.world, self.steps = world, 0
        Watch.seen = [world.pose(arguments["object"])[0], world.place(arguments["workspace"])]

    def step(self):
        self.steps += 1
        Watch.steps = self.steps, self.world.time
        return self.steps == 40
"""


@pytest.mark.parametrize(
    ("fault", "moved", "raised", "share"),
    [
        ("", 0.0, 0.0, 1.0),
        ("offset-pose=10", 0.01, 0.0, 1.0),
        ("high-release=50", 0.0, 0.05, 1.0),
        ("slow-arm=0.5", 0.0, 0.0, 2.0),
    ],
)
def test_behaviours_of_users_have_the_same_faults(
    tmp_path: Path, fault: str, moved: float, raised: float, share: float
) -> None:
    module = f"watching_{fault.partition('-')[0]}"
    (tmp_path / f"{module}.py").write_text(WATCH, encoding="utf-8")
    own = Implementation("x:own", "python", f"{module}:Watch", Origin(str(tmp_path / "run.bddx"), 1, 1))
    spec = replace(scenario(), execution=ExecutionSpec("x:run", "x:run", own))
    run = Execution(replace(spec, fault=robot_fault(fault) if fault else None), [pick_place()])
    run.run_behaviour(0)
    watch = import_module(module).Watch
    part, place = watch.seen
    assert np.linalg.norm(part - at(run.trace, CUBE, 0)) == pytest.approx(moved, abs=1e-9)
    inside = AgentWorld(begun("").simulation, PANDA, lambda _: None).place(BIN_WS)
    assert place[2] - inside[2] == pytest.approx(raised, abs=1e-9)
    assert watch.steps[1] == pytest.approx(0.5 + 40 * share * 0.016, abs=0.05)
