"""Arms push objects over a table, and hand objects over to each other."""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, sin
from pathlib import Path

import numpy as np
import pytest

from robbdd_tools.agent.behaviour_calls import Call
from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import Implementation, ModelSource, Origin, Realisation
from robbdd_tools.protocol.specs import ExecutionSpec, SceneSpec
from robbdd_tools.world.errors import SceneError
from world.test_staging import instance, link
from world.worlds import CUBE, OTHER_WS, PANDA, SCENE, scenario

pytestmark = pytest.mark.physics
PLATE, BOX, ZONE = "env:plate", "env:carton", "env:zone"
EVENTS = {
    "t:laid-down": "t:a laid-down",
    "t:end": "t:a hand-over-end",
    "t:placed": "t:b place-end",
    "t:pushed": "t:a push-end",
}
ZONE_XML = """<mujoco><worldbody><body name="plate">
  <geom type="box" size=".1 .1 .01" pos="0 0 -.01" friction=".6"/>
  <site name="workspace" type="box" size=".1 .1 .1" pos="0 0 .1" euler="0 0 0"/>
</body></worldbody></mujoco>"""


def pushed(folder: Path, x: float, y: float, thing: str, seed: int, plate: str = ZONE_XML) -> Execution:
    """Return an execution in which the Panda pushes a thing to a plate that is let into the table."""
    (folder / "plate.xml").write_text(plate, encoding="utf-8")
    source = ModelSource(
        "x:m", "mjcf", "file", "plate.xml", bodies=(("x:g.plate", ""),), origin=Origin(str(folder / "c.scenex"), 7, 11)
    )
    staged = instance(link("x:g.plate.foot", (x, y, 0.1)), elements=(Realisation(PLATE, (source,)),))
    how = ExecutionSpec("x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), staged)
    workspaces = {ZONE: (PLATE,), "env:bench_ws": ("env:bench",)}
    scene = SceneSpec(objects=(thing, PLATE, "env:bench"), agents=(PANDA,), workspaces=workspaces)
    spec = replace(scenario(scene, seed, events=EVENTS), execution=how)
    run = Execution(spec, [Call("push", {"agent": PANDA, "object": thing, "workspace": ZONE}, "t:a", iteration=1)])
    run.advance_until(lambda _: False)
    return run


@pytest.mark.parametrize(("thing", "seed"), [(BOX, 1), (BOX, 2), (CUBE, 3)])
def test_an_arm_pushes_an_object_into_a_zone(tmp_path: Path, thing: str, seed: int) -> None:
    run = pushed(tmp_path, 0.45, -0.25, thing, seed)
    assert run.completed == 1, run.course.failures
    trace = run.trace
    path = trace.positions[:, trace.column(thing)]
    assert (np.abs(path[-1, :2] - [0.45, -0.25]) < 0.1).all()
    assert np.abs(path[0, :2] - [0.45, -0.25]).max() > 0.1
    assert np.ptp(path[:, 2]) < 0.005


def test_an_arm_pushes_an_object_into_a_turned_zone(tmp_path: Path) -> None:
    narrow = ZONE_XML.replace('".1 .1 .1" pos="0 0 .1" euler="0 0 0"', '".12 .04 .1" pos="0 0 .1" euler="0 0 60"')
    run = pushed(tmp_path, 0.45, -0.25, BOX, 8, narrow)
    assert run.completed == 1, run.course.failures
    way = run.trace.positions[:, run.trace.column(BOX), :2] - [0.45, -0.25]
    along = way @ [cos(pi / 3), sin(pi / 3)], way @ [-sin(pi / 3), cos(pi / 3)]
    assert abs(along[0][-1]) < 0.12
    assert abs(along[1][-1]) < 0.04 < abs(along[1][0])


def test_an_arm_that_does_not_reach_behind_an_object_fails(tmp_path: Path) -> None:
    run = pushed(tmp_path, 0.75, 0.6, BOX, 1)
    assert run.completed == 0
    assert run.failure(0)
    assert run.trace.finished


@pytest.mark.parametrize("agents", [(PANDA, "env:kinova"), ("env:ur10", PANDA)])
def test_one_arm_hands_over_to_another_one_which_places(agents: tuple[str, str]) -> None:
    giver, receiver = agents
    give = Call("hand-over", {"agent": giver, "object": CUBE, "receiver": receiver}, "t:a", iteration=1)
    place = Call("place", {"agent": receiver, "object": CUBE, "workspace": OTHER_WS}, "t:b", iteration=1)
    run = Execution(scenario(replace(SCENE, agents=agents), 1, events=EVENTS), [give, place])
    run.advance_until(lambda _: False)
    assert run.completed == 2, run.course.failures
    trace = run.complete(run.trace)
    after = trace.last_at_or_before(trace.event_time("t:end") or 0.0)
    assert trace.grips[receiver][after, trace.column(CUBE)] == 1.0
    assert not trace.grips[giver][after].any()
    assert not [one for one in trace.contacts if one.other in agents]


def test_an_arm_cannot_hand_over_to_itself() -> None:
    give = Call("hand-over", {"agent": PANDA, "object": CUBE, "receiver": PANDA}, "t:a", iteration=1)
    with pytest.raises(SceneError, match="'env:panda' cannot hand over to itself"):
        Execution(scenario(SCENE, 1, events=EVENTS), [give])
