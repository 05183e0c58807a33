"""A person is in the scene as an object or as an agent, takes no place of a table or a robot, and executes nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.judging.decisions import decide
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.protocol.specs import SceneSpec
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.placement import mounts
from robbdd_tools.world.scene import cast_scene
from robbdd_tools.world.staging import Staging
from world.scene_instances import catalog, instance, link
from world.worlds import CUBE, EVENTS, OTHER_WS, PANDA, SCENE, execution, pick_place

pytestmark = pytest.mark.physics
OPERATOR = "env:operator"
AS_AGENT = replace(SCENE, agents=(PANDA, OPERATOR))
AS_OBJECT = replace(SCENE, objects=(*SCENE.objects, OPERATOR))


def settled(run: Execution) -> None:
    for _ in range(20):
        run.simulation.tick()


@pytest.mark.parametrize("scene", [AS_AGENT, AS_OBJECT])
def test_a_person_stands_on_the_floor_beside_the_table_and_touches_nothing(scene: SceneSpec) -> None:
    run = execution(scene=scene)
    settled(run)
    model, data = run.simulation.model, run.simulation.data
    body = model.body(OPERATOR)
    shapes = range(body.geomadr[0], body.geomadr[0] + body.geomnum[0])
    lowest = min(data.geom_xpos[shape][2] - model.geom_size[shape][1] for shape in shapes)
    floor = next(shape for shape in range(model.ngeom) if model.geom_type[shape] == 0)
    assert lowest == pytest.approx(data.geom_xpos[floor][2], abs=1e-6)
    touching = {int(model.geom_bodyid[geom]) for geom in data.contact.geom.ravel()}
    assert body.id not in touching


def test_a_person_takes_neither_the_place_of_a_table_nor_that_of_a_robot() -> None:
    alone, beside = cast_scene(SCENE), cast_scene(AS_AGENT)
    assert beside.tables == alone.tables
    assert mounts(beside) == mounts(alone)


def test_a_scene_with_a_person_and_no_furniture_still_has_a_table() -> None:
    scene = replace(SCENE, objects=(CUBE,), workspaces={}, contains={}, agents=(PANDA, OPERATOR))
    assert len(cast_scene(scene).tables) == 1


def test_a_person_does_not_change_what_the_robot_does() -> None:
    alone, beside = (execution([pick_place()], scene) for scene in (SCENE, AS_AGENT))
    one, other = (run.complete(run.advance_until(lambda _: False)) for run in (alone, beside))
    assert np.array_equal(one.positions[:, one.names.index(CUBE)], other.positions[:, other.names.index(CUBE)])


def test_nearness_to_a_person_depends_on_where_the_robot_works() -> None:
    run = execution([pick_place(workspace=OTHER_WS)], AS_AGENT)
    trace = run.complete(run.advance_until(lambda _: False))
    place = trace.positions[0, trace.names.index(OPERATOR)]
    gaps = np.linalg.norm(trace.positions[:, trace.names.index(PANDA)] - place, axis=1)
    clause = read_clause(f'"{PANDA}" is farther than "0.2 m" from "{OPERATOR}" from "t:pick-start" until "t:place-end"')
    found = decide(clause, trace, run.regions, EVENTS.keys())
    start, end = trace.event_time("t:pick-start"), trace.event_time("t:place-end")
    assert start is not None
    assert end is not None
    inside = (trace.times >= start) & (trace.times <= end)
    assert found.robustness == pytest.approx(gaps[inside].min() - 0.2, abs=1e-6)


def test_a_person_executes_nothing() -> None:
    with pytest.raises(SceneError, match="'env:operator' is a bystander: it executes no behaviour"):
        execution([pick_place(agent=OPERATOR)], AS_AGENT)


def test_an_executable_scene_places_a_person_who_is_an_agent() -> None:
    feet = link("x:g.feet.here", (1.2, 0.3, -0.65))
    placed = instance(feet, elements=(replace(catalog("e:visitor", "person", "x:g.feet"), is_agent=True),))
    scene = SceneSpec(objects=("e:table",), agents=("e:panda", "e:visitor"))
    cast = cast_scene(scene, Staging(placed, 1))
    assert list(cast.agents) == ["e:panda"]
    pose = cast.pose("e:visitor")
    assert pose is not None
    assert pose.position == pytest.approx((1.2, 0.3, -0.65 + 1.75 / 2))
