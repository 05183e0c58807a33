"""Behaviours one after the other and at the same time, by two arms in one world."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from robbdd_tools.agent.behaviour_calls import Call, groups_of
from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.coordination import DEFINED
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.time import After
from robbdd_tools.monitor.verdict import Cause
from robbdd_tools.protocol.clauses import DefinedEvent, Fluent
from robbdd_tools.world.engine import TICK
from robbdd_tools.world.errors import SceneError
from world.worlds import BALL, BIN_WS, CUBE, OTHER_WS, PANDA, SCENE, scenario

pytestmark = pytest.mark.physics
ARM = "env:ur10"
TWO = replace(SCENE, agents=(PANDA, ARM))
EVENTS = {
    "t:start": "scenario-start",
    "t:end": "scenario-end",
    "t:a-start": "t:a pick-start",
    "t:a-lifted": "t:a pick-end",
    "t:a-end": "t:a place-end",
    "t:b-start": "t:b pick-start",
    "t:b-end": "t:b place-end",
    "t:button": "external",
}
A = Call("pick-place", {"agent": PANDA, "object": CUBE, "workspace": BIN_WS}, "t:a", iteration=1)
B = Call("pick-place", {"agent": ARM, "object": BALL, "workspace": OTHER_WS}, "t:b", iteration=1)


def executed(*calls: Call) -> tuple[Execution, dict[str, float]]:
    run = Execution(scenario(TWO, seed=2, events=EVENTS), calls)
    trace = run.advance_until(lambda _: False)
    return run, {stamp.name: stamp.time for stamp in trace.events}


def test_then_begins_when_everything_before_it_has_ended() -> None:
    run, times = executed(A, B)
    assert run.completed == 2
    assert times["t:a-start"] < times["t:a-end"] < times["t:b-start"] < times["t:b-end"]
    again, times = executed(A, replace(A, part="t:b", arguments={**A.arguments, "workspace": OTHER_WS}))
    assert again.completed == 2
    assert times["t:a-end"] == times["t:b-start"]
    assert {stamp.iteration for stamp in run.trace.events if stamp.name[:4] in ("t:a-", "t:b-")} == {1}


def test_meanwhile_both_arms_move_at_the_same_time() -> None:
    run, times = executed(A, replace(B, is_meanwhile=True))
    assert run.completed == 2
    assert times["t:a-start"] == times["t:b-start"]
    assert times["t:end"] == pytest.approx(max(times["t:a-end"], times["t:b-end"]) + 1.0, abs=0.02)
    _, sequence = executed(A, B)
    assert times["t:end"] < sequence["t:end"] - 3.0


def test_a_behaviour_waits_for_an_event_of_the_other_one() -> None:
    _, times = executed(A, replace(B, is_meanwhile=True, awaited=("t:a-lifted",)))
    assert times["t:a-start"] < times["t:a-lifted"] == times["t:b-start"] < times["t:a-end"]


def test_a_behaviour_waits_for_an_event_that_its_template_defines() -> None:
    held = Fluent(load_catalog().predicates["held-by"], {"object": CUBE, "agent": PANDA}, After("t:taken"))
    spec = scenario(TWO, seed=2, events={**EVENTS, "t:taken": DEFINED})
    spec = replace(spec, defined=(DefinedEvent("t:taken", (held,), 0.2),))
    run = Execution(spec, (A, replace(B, is_meanwhile=True, awaited=("t:taken",))))
    trace = run.advance_until(lambda _: False)
    assert run.completed == 2
    taken, begun = trace.event_time("t:taken", 1), trace.event_time("t:b-start")
    assert begun == taken
    gripped = trace.grips[PANDA][:, trace.column(CUBE)] > 0
    assert taken is not None
    assert 0.2 <= taken - float(trace.times[int(np.argmax(gripped))]) < 0.2 + 2 * TICK


def test_own_events_are_not_awaited() -> None:
    run, _ = executed(replace(A, awaited=("t:a-start",)), B)
    assert run.completed == 2


@pytest.mark.parametrize(
    ("event", "reason"),
    [("t:button", "nothing in the simulation emits it"), ("t:b-end", "no behaviour that could emit it is executed")],
)
def test_an_event_that_cannot_occur_stops_the_execution(event: str, reason: str) -> None:
    run, times = executed(A, replace(B, part="t:c", awaited=(event,)))
    assert "t:b-start" not in times
    stopped = run.cut_short(1)
    assert stopped is not None
    assert stopped.cause is Cause.SIMULATION
    time = re.fullmatch(rf"the next behaviour waits for event {event} at ([\d.]+) s: {reason}", stopped.reason)
    assert time is not None
    assert float(time[1]) > times["t:a-end"]
    assert run.run_behaviour(0)


def test_the_other_behaviour_of_a_group_continues_after_a_failure_and_no_further_group_begins() -> None:
    failing = Call("juggle", {"agent": PANDA}, "t:c", iteration=1)
    run, times = executed(failing, replace(B, is_meanwhile=True), A)
    assert run.run_behaviour(1)
    assert "t:b-end" in times
    assert "t:a-start" not in times
    for index in (0, 2):
        assert not run.run_behaviour(index)
        assert run.cut_short(index) is None
        assert run.failure(index) == "no agent of this installation can execute the behaviour 'juggle'"


def test_one_agent_cannot_execute_two_behaviours_at_the_same_time() -> None:
    with pytest.raises(SceneError, match=r"'env:panda' cannot execute two behaviours at the same time"):
        executed(A, replace(B, arguments={**B.arguments, "agent": PANDA}, is_meanwhile=True))


def test_meanwhile_adds_to_the_group_before_it() -> None:
    other = replace(B, is_meanwhile=True)
    assert groups_of([A, other, A, B, other.__class__("pick", {"agent": "x"}, is_meanwhile=True)]) == [
        [0, 1],
        [2],
        [3, 4],
    ]
