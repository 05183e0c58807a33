"""Belts carry by friction alone, at their speed; an arm picks objects at rest at the stop."""

from __future__ import annotations

import numpy as np
import pytest

from robbdd_tools.catalog.objects.conveyor import LENGTH, STOP
from robbdd_tools.protocol.specs import ConfigSpec, SceneSpec
from robbdd_tools.world.composition import build_world
from robbdd_tools.world.configured_values import read_back
from robbdd_tools.world.engine import TICK
from robbdd_tools.world.pick_place import PickPlace
from robbdd_tools.world.simulation import Simulation
from world.worlds import pick_place

pytestmark = pytest.mark.physics
CUBE, CONVEYOR, PANDA = "env:cube", "env:conveyor", "env:panda"
BELT_WS, BIN_WS = "env:belt_ws", "env:bin_ws"
GRAVITY = 9.81
HALF_EDGE = 0.01575
"""Half the edge of a cube, m."""


def line(*config: ConfigSpec, seed: int = 1) -> Simulation:
    """Return a settled conveyor with a cube on it."""
    scene = SceneSpec(
        objects=("env:table", CONVEYOR, "env:bin", CUBE),
        agents=(PANDA,),
        workspaces={"env:table_ws": ("env:table",), BELT_WS: (CONVEYOR,), BIN_WS: ("env:bin",)},
        contains={"env:table_ws": (BELT_WS, BIN_WS)},
        places={CUBE: BELT_WS},
        config=config,
    )
    simulation = Simulation(build_world(scene, seed))
    simulation.settle()
    assert read_back(simulation, scene)[CONVEYOR, "belt_speed"] == next((c.value for c in config), "0.1")
    return simulation


def along(simulation: Simulation) -> float:
    """Return the cube's place along the belt, m."""
    return float(simulation.pose(CUBE)[0][1])


def after(simulation: Simulation, seconds: float) -> float:
    """Return where the cube is some seconds later, m."""
    for _ in range(round(seconds / TICK)):
        simulation.tick()
    return along(simulation)


@pytest.mark.parametrize("speed", [0.05, 0.2])
def test_a_thing_rides_at_the_speed_of_the_belt(speed: float) -> None:
    simulation = line(ConfigSpec(CONVEYOR, "belt_speed", str(speed)))
    start = after(simulation, 0.16)
    assert start - after(simulation, 0.8) == pytest.approx(0.8 * speed, rel=0.01)


def test_on_a_slippery_belt_a_thing_is_only_accelerated_by_friction() -> None:
    """By Coulomb's law its way is μgt²/2 as long as the belt is faster."""
    slippery = [ConfigSpec(name, "friction", "0.01") for name in (CUBE, CONVEYOR)]
    simulation = line(ConfigSpec(CONVEYOR, "belt_speed", "0.3"), *slippery)
    start = along(simulation)
    assert start - after(simulation, 0.8) == pytest.approx(0.01 * GRAVITY * 0.8**2 / 2, rel=0.05)


def test_the_stop_holds_a_thing_while_the_belt_slips_below_it() -> None:
    simulation = line()
    stop = -LENGTH / 2 + STOP
    place = after(simulation, 12.0)
    assert place - stop == pytest.approx(HALF_EDGE, abs=1e-3)
    assert after(simulation, 4.0) == pytest.approx(place, abs=1e-3)


def test_the_conveyor_stands_still_and_its_belt_does_not_run_away() -> None:
    simulation = line()
    before = simulation.pose(CONVEYOR)[0]
    after(simulation, 4.0)
    assert np.abs(simulation.pose(CONVEYOR)[0] - before).max() < 1e-4
    belt = simulation.data.body(f"{CONVEYOR}/belt2").xpos
    assert abs(float(belt[1]) - float(before[1])) < 1e-4


def test_the_arm_waits_until_the_thing_has_come_to_rest() -> None:
    simulation = line()
    start = along(simulation)
    places: dict[str, float] = {}

    def note(event: str) -> None:
        places[event] = along(simulation)

    call = pick_place(CUBE, BIN_WS, PANDA)
    for _ in PickPlace(simulation, PANDA, note).pick_place(call.element("object"), call.places):
        simulation.tick()
    assert start - places["pick-start"] > 0.05, "it has ridden"
    assert places["pick-start"] == pytest.approx(-LENGTH / 2 + STOP + HALF_EDGE, abs=2e-3)
    bin_place, _ = simulation.pose("env:bin")
    assert np.abs(simulation.pose(CUBE)[0] - bin_place)[:2].max() < 0.1


def test_the_arm_approaches_again_when_the_thing_has_moved_meanwhile() -> None:
    simulation = line()
    address = int(simulation.model.joint(simulation.model.body(CUBE).jntadr[0]).qposadr[0])
    begun: list[int] = []
    events: list[str] = []

    def note(event: str) -> None:
        events.append(event)
        begun.append(simulation.ticks)

    for _ in PickPlace(simulation, PANDA, note).pick(CUBE):
        if begun and simulation.ticks == begun[0] + 30:
            simulation.data.qpos[address] += 0.04
        simulation.tick()
    assert events == ["pick-start", "pick-end"]
    assert simulation.holds(PANDA, CUBE)
