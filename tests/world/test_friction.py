"""Friction is that of the pair: the smaller coefficient decides, for pads, parts, boards and users' files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import Friction, Implementation, ModelSource, Origin, Realisation, SceneInstance
from robbdd_tools.protocol.specs import ConfigSpec, ExecutionSpec, ScenarioSpec, SceneSpec
from robbdd_tools.world.composition import build_world
from robbdd_tools.world.engine import TICK, mujoco
from robbdd_tools.world.friction import rank_by_friction
from robbdd_tools.world.simulation import Simulation
from world.arms import MJCF
from world.test_own_robot import ARM, FIVE
from world.worlds import BALL, BENCH_WS, BIN_WS, CUBE, PANDA, SCENE, pick_place, scenario

pytestmark = pytest.mark.physics
BENCH = "env:bench"
KINOVA, CYLINDER = "env:kinova", "env:cylinder1"
GRAVITY = 9.81
MARGIN = 0.03
"""Distance from the bound 2 μ N, as a share, at which a part must hold or slip."""


def bench(agent: str, *things: str, **settings: float) -> SceneSpec:
    """Return a scene of an arm and objects on a bench; ``settings`` are those of the first object."""
    config = tuple(ConfigSpec(things[0], name, f"{value:.6f}") for name, value in settings.items())
    workspaces = {BENCH_WS: (BENCH,)}
    return replace(SCENE, agents=(agent,), objects=(*things, BENCH), workspaces=workspaces, contains={}, config=config)


def own_arm(scene: SceneSpec, folder: Path, text: str) -> ScenarioSpec:
    """Return a scenario whose arm is that of an MJCF text."""
    (folder / "five.xml").write_text(text, encoding="utf-8")
    origin = Origin(str(folder / "cell.scenex"), 3, 7)
    source = ModelSource("x:five_model", "mjcf", "file", "five.xml", arm=ARM, origin=origin)
    instance = SceneInstance("x:cell", elements=(Realisation(FIVE, (source,)),))
    behaviour = Implementation("x:own", "catalog", "pick-place")
    return replace(scenario(scene), execution=ExecutionSpec("x:run", "x:run", behaviour, instance))


class Held:
    """An object in the air between the pads of an arm, which close on it without gravity."""

    def __init__(self, simulation: Simulation, thing: str, force: float | None = None) -> None:
        """``force`` (N) is that of each finger, by default that of the arm's model."""
        self.simulation, self.thing = simulation, thing
        self.model, self.data = simulation.model, simulation.data
        (self.robot,) = simulation.robots.values()
        if force is not None:
            self.model.actuator_forcerange[self.robot.gripper] = (-2 * force, 2 * force)
        body = self.model.body(thing)
        place, speed = int(self.model.jnt_qposadr[body.jntadr[0]]), int(body.dofadr[0])
        self.data.qpos[place : place + 3] = self.data.site_xpos[self.robot.tool]
        mujoco.mju_mat2Quat(self.data.qpos[place + 3 : place + 7], self.data.site_xmat[self.robot.tool])
        self.data.qvel[speed : speed + 6] = 0.0
        self.model.opt.gravity[2] = 0.0
        self.opening = self.robot.model.gripper_open
        self.wait(1.3, closing=0.05)

    def wait(self, seconds: float, closing: float = 0.0) -> None:
        """Let time pass while the fingers close at a speed (m/s)."""
        for _ in range(round(seconds / TICK)):
            self.opening = max(self.robot.model.gripper_closed, self.opening - closing * TICK)
            self.simulation.command(self.robot, np.array(self.robot.model.home), self.opening)
            self.simulation.tick()

    def height(self) -> float:
        """Return the height (m) of the object above the tool's centre."""
        return float(self.data.body(self.thing).xpos[2] - self.data.site_xpos[self.robot.tool][2])

    def slip(self, seconds: float = 1.0) -> float:
        """Return the distance (m) that the object slides down in the grip under gravity."""
        before = self.height()
        self.model.opt.gravity[2] = -GRAVITY
        self.wait(seconds)
        return before - self.height()

    def forces(self) -> list[float]:
        """Return the normal force (N) on each pad."""
        wrench, found = np.zeros(6), [0.0 for _ in self.robot.pads]
        for index, pair in enumerate(self.data.contact.geom.tolist()):
            for number, pad in enumerate(self.robot.pads):
                if pad in pair:
                    mujoco.mj_contactForce(self.model, self.data, index, wrench)
                    found[number] += float(wrench[0])
        return found


BOUNDS = [
    (PANDA, CUBE, 0.6, 0.6, 15.0),
    (PANDA, CUBE, 0.1, 0.1, 5.0),
    (PANDA, CYLINDER, 0.05, 0.05, 15.0),
    # The pads' own coefficient is the smaller one.
    (PANDA, CUBE, 2.0, 0.9, 10.0),
    (KINOVA, CUBE, 0.6, 0.6, 20.0),
    (KINOVA, BALL, 0.3, 0.3, 10.0),
]


@pytest.mark.parametrize(("agent", "thing", "friction", "smaller", "force"), BOUNDS)
@pytest.mark.parametrize("share", [1 - MARGIN, 1 + MARGIN])
def test_two_fingers_hold_up_to_twice_friction_times_force(
    agent: str, thing: str, friction: float, smaller: float, force: float, share: float
) -> None:
    mass = share * 2 * smaller * force / GRAVITY
    scene = bench(agent, thing, friction=friction, mass=mass)
    slip = Held(Execution(scenario(scene), []).simulation, thing, force).slip()
    assert slip < 1e-3 if share < 1 else slip > 0.05


def with_friction(scene: SceneSpec, one: str, other: str, coefficient: float) -> ScenarioSpec:
    """Return a scenario whose scene instance states the friction of a pair of elements."""
    instance = SceneInstance("x:cell", frictions=(Friction(one, other, coefficient),))
    behaviour = Implementation("x:own", "catalog", "pick-place")
    return replace(scenario(scene), execution=ExecutionSpec("x:run", "x:run", behaviour, instance))


@pytest.mark.parametrize("share", [1 - MARGIN, 1 + MARGIN])
def test_the_stated_friction_of_a_pair_replaces_the_smaller_one_of_both(share: float) -> None:
    scene = bench(PANDA, CUBE, friction=0.6, mass=share * 2 * 0.2 * 10.0 / GRAVITY)
    slip = Held(Execution(with_friction(scene, PANDA, CUBE, 0.2), []).simulation, CUBE, 10.0).slip()
    assert slip < 1e-3 if share < 1 else slip > 0.05


@pytest.mark.parametrize("stated", [0.1, 0.4])
def test_a_part_slides_on_a_board_as_far_as_the_stated_friction_lets_it(stated: float) -> None:
    course = Execution(with_friction(bench(PANDA, CUBE, friction=0.2), BENCH, CUBE, stated), [])
    places = slide(course.simulation, CUBE, 0.5)
    assert places[-1] - places[0] == pytest.approx(0.5**2 / (2 * stated * GRAVITY), rel=0.06)


@pytest.mark.parametrize(("agent", "force"), [(PANDA, 15.0), (KINOVA, 20.0)])
def test_a_gripper_keeps_to_its_documented_force(agent: str, force: float) -> None:
    held = Held(Execution(scenario(bench(agent, CUBE)), []).simulation, CUBE)
    assert held.forces() == pytest.approx([force, force], rel=0.01)


@pytest.mark.parametrize("share", [1 - MARGIN, 1 + MARGIN])
@pytest.mark.parametrize("contact", ['condim="4" friction="0.9', 'priority="7" condim="4" friction="3'])
def test_pads_of_a_users_file_do_not_decide_alone(tmp_path: Path, share: float, contact: str) -> None:
    scene = bench(FIVE, CUBE, friction=0.2, mass=share * 2 * 0.2 * 15.0 / GRAVITY)
    text = MJCF.replace('condim="4" friction="0.9', contact)
    assert contact in text
    held = Held(Execution(own_arm(scene, tmp_path, text), []).simulation, CUBE)
    assert held.forces() == pytest.approx([15.0, 15.0], rel=0.01)
    slip = held.slip()
    assert slip < 1e-3 if share < 1 else slip > 0.05


@pytest.mark.parametrize(
    ("friction", "mass", "carried"),
    [(0.01, 0.03, False), (0.6, 1.0, True), (0.6, 2.0, False), (2.0, 2.0, True), (2.0, 3.0, False)],
)
def test_a_part_that_slips_is_lost(friction: float, mass: float, carried: bool) -> None:
    """The Panda's pads have a friction of 0.9 and press with 15 N: 18 N at 0.6, 27 N at most; moving takes 2 m/s²."""
    config = (ConfigSpec(CUBE, "friction", str(friction)), ConfigSpec(CUBE, "mass", str(mass)))
    run = Execution(scenario(replace(SCENE, config=config)), [pick_place(CUBE, BIN_WS)])
    assert run.run_behaviour(0) is carried
    assert carried or "gripper lost" in run.trace.remark or "gripper missed" in run.trace.remark


def pushed(thing: str, speed: float, *config: ConfigSpec) -> list[float]:
    """Return the positions (m) of an object on the bench, tick by tick, after a push along y."""
    scene = replace(bench(PANDA, thing), config=config)
    return slide(Execution(scenario(scene), []).simulation, thing, speed)


def slide(simulation: Simulation, thing: str, speed: float) -> list[float]:
    """Push an object to the left at a speed (m/s), and return its places (m) until it rests."""
    start = int(simulation.model.body(thing).dofadr[0])
    simulation.data.qvel[start + 1] = speed
    places = [float(simulation.pose(thing)[0][1])]
    for _ in range(200):
        simulation.tick()
        places.append(float(simulation.pose(thing)[0][1]))
    return places


@pytest.mark.parametrize(("part", "board"), [("0.2", "0.6"), ("0.6", "0.2"), ("0.2", "0.2")])
def test_a_part_slides_as_far_as_the_smaller_friction_lets_it(part: str, board: str) -> None:
    config = (ConfigSpec(CUBE, "friction", part), ConfigSpec(BENCH, "friction", board))
    places = pushed(CUBE, 0.5, *config)
    assert places[-1] - places[0] == pytest.approx(0.5**2 / (2 * 0.2 * GRAVITY), rel=0.06)


@pytest.mark.parametrize("board", ["0.05", "0.6", "1.5"])
def test_a_ball_comes_to_rest_on_any_board(board: str) -> None:
    places = pushed(BALL, 0.1, ConfigSpec(BENCH, "friction", board))
    assert abs(places[-1] - places[-6]) < 1e-5


def test_the_smoother_of_two_surfaces_brings_the_rolling_resistance_of_the_other() -> None:
    """A contact of geoms in a file: the engine's resulting parameters."""
    ball = '<body pos="0 0 0.009"><freejoint/><geom size="0.01" friction="0.6 0.005 0.0005" condim="6"/></body>'
    board = '<geom type="box" size="1 1 0.1" pos="0 0 -0.1" friction="0.2 0.001 0.0001" priority="-3"/>'
    spec = mujoco.MjSpec.from_string(f"<mujoco><worldbody>{ball}{board}</worldbody></mujoco>")
    rank_by_friction(spec, [])
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert data.contact.dim.tolist() == [6]
    assert data.contact.friction[0].tolist() == [0.2, 0.2, 0.005, 0.0005, 0.0005]


SLIDE = """<mujoco><worldbody>
<body name="slab" pos="2 0 0.2"><geom name="top" type="box" size="1 .2 .1" friction="0.6"/></body>
<body name="block" pos="1.5 0 0.3201"><freejoint/>
<geom name="side" type="box" size=".02 .02 .02" mass="0.1" friction="0.6"/></body>
</worldbody>{}</mujoco>"""
DECLARED = '<contact><pair geom1="top" geom2="side" friction="0.05 0.05 0.001 0.0001 0.0001" condim="4"/></contact>'


@pytest.mark.parametrize(("declared", "friction"), [("", 0.6), (DECLARED, 0.05)])
@pytest.mark.parametrize("elements", [("env:block",), ("env:block", "env:slab")])
def test_a_pair_that_a_model_of_the_scene_declares_has_its_own_friction(
    tmp_path: Path, declared: str, friction: float, elements: tuple[str, ...]
) -> None:
    """Whether slab and block are elements of the scene, taken out of the model, or parts of the scenery."""
    (tmp_path / "world.xml").write_text(SLIDE.format(declared), encoding="utf-8")
    origin = Origin(str(tmp_path / "cell.scenex"), 3, 7)
    instance = SceneInstance("x:cell", (ModelSource("x:w", "mjcf", "file", "world.xml", origin=origin),))
    scene = replace(SCENE, objects=(*SCENE.objects, *elements))
    simulation = Simulation(build_world(scene, 1, None, instance))
    simulation.settle()
    start = float(simulation.pose("env:block")[0][0])
    body = simulation.model.body("env:block")
    simulation.data.qvel[int(simulation.model.jnt_dofadr[body.jntadr[0]])] = 1.0
    seconds = 0.4
    for _ in range(round(seconds / TICK)):
        simulation.tick()
    stops = min(seconds, 1.0 / (friction * GRAVITY))
    way = stops - friction * GRAVITY * stops**2 / 2
    assert float(simulation.pose("env:block")[0][0]) - start == pytest.approx(way, rel=0.05)
