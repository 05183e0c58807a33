"""A behave step simulates only as far as its own window, and judges there."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from robbdd_tools.agent.channel import Channel
from robbdd_tools.agent.scenario_run import ScenarioRun
from robbdd_tools.agent.violation_states import ViolationStates
from robbdd_tools.catalog.executable import Implementation, SceneInstance
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.messages import RunMessage, ScenarioFinished
from robbdd_tools.protocol.specs import ConfigSpec, ExecutionSpec, SceneSpec
from world.worlds import BIN_WS, CUBE, PANDA, SCENE, scenario

pytestmark = pytest.mark.physics
GIVEN = (5, "given", f'"{CUBE}" is located at "env:bench_ws" before event "t:pick-start"')
WHEN = (6, "when", f'"{PANDA}" picks "{CUBE}" and places it at "{BIN_WS}"')
HELD = (7, "then", f'"{CUBE}" is held by "{PANDA}" after event "t:pick-end"')
RESTS = (8, "then", f'"{CUBE}" is located at "{BIN_WS}" for 2 seconds after event "t:end"')
THERE = (9, "then", f'"{CUBE}" is located at "{BIN_WS}" after event "t:place-end"')


class Sent(Channel):
    """Keeps the messages of a scenario."""

    def __init__(self) -> None:
        self.messages: list[RunMessage] = []

    def send(self, message: RunMessage) -> None:
        self.messages.append(message)

    @property
    def simulated(self) -> float:
        """How far the world had run when the scenario was finished, s."""
        return next(message.simulated for message in self.messages if isinstance(message, ScenarioFinished))


def began(folder: Path, *steps: tuple[int, str, str], scene: SceneSpec = SCENE) -> tuple[ScenarioRun, Sent]:
    sent = Sent()
    return ScenarioRun(0, scenario(scene), steps, sent, ViolationStates(folder)), sent


def test_a_given_runs_the_world_to_its_event_and_no_further(tmp_path: Path) -> None:
    run, sent = began(tmp_path, GIVEN, WHEN)
    assert run.clause(GIVEN[0], GIVEN[2]).outcome is Outcome.HOLDS
    run.finish()
    assert 0.5 <= sent.simulated < 0.7


def test_a_when_runs_to_the_end_of_the_behaviour(tmp_path: Path) -> None:
    run, sent = began(tmp_path, GIVEN, WHEN)
    run.clause(GIVEN[0], GIVEN[2])
    assert run.behaviour(WHEN[0], WHEN[2]).outcome is Outcome.HOLDS
    found = run.clause(HELD[0], HELD[2])
    assert found.outcome is Outcome.HOLDS
    run.finish()
    assert found.at is not None
    assert found.at < sent.simulated


def limited(folder: Path, timeout: float, friction: str = "0.6") -> ScenarioRun:
    config = (ConfigSpec(CUBE, "friction", friction), ConfigSpec(CUBE, "mass", "0.1"))
    instance = SceneInstance("x:cell")
    how = ExecutionSpec("x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), instance, timeout=timeout)
    spec = replace(scenario(replace(SCENE, config=config)), execution=how)
    return ScenarioRun(0, spec, (WHEN,), Sent(), ViolationStates(folder))


def test_a_behaviour_that_the_time_limit_stops_is_unknown(tmp_path: Path) -> None:
    found = limited(tmp_path, 2.0).behaviour(WHEN[0], WHEN[2])
    assert found.outcome is Outcome.UNKNOWN
    assert found.reason == "the execution was stopped after 2 s of simulated time"


def test_a_behaviour_that_failed_before_the_time_limit_is_violated(tmp_path: Path) -> None:
    """A slippery part is lost after about four seconds; the arm is still on its way back at the limit."""
    found = limited(tmp_path, 4.5, "0.01").behaviour(WHEN[0], WHEN[2])
    assert found.outcome is Outcome.VIOLATED
    assert found.reason.startswith("gripper lost")


def test_a_then_that_looks_back_does_not_run_on_and_one_with_a_horizon_does(tmp_path: Path) -> None:
    spans: list[float] = []
    for thens in ((THERE,), (THERE, RESTS)):
        run, sent = began(tmp_path, WHEN, THERE, RESTS)
        run.behaviour(WHEN[0], WHEN[2])
        assert all(run.clause(line, text).outcome is Outcome.HOLDS for line, _, text in thens)
        run.finish()
        spans.append(sent.simulated)
    # The scenario ends one second after its behaviour; the horizon adds two seconds.
    assert spans[1] - spans[0] == pytest.approx(3.0, abs=0.2)


def test_a_clause_whose_window_never_closes_is_unknown_and_tells_the_cause(tmp_path: Path) -> None:
    # Friction of two fingers that press with 15 N each cannot carry 20 kg.
    too_heavy = replace(SCENE, config=(ConfigSpec(CUBE, "mass", "20"),))
    run, _ = began(tmp_path, GIVEN, WHEN, THERE, scene=too_heavy)
    run.clause(GIVEN[0], GIVEN[2])
    failed = run.behaviour(WHEN[0], WHEN[2])
    assert failed.outcome is Outcome.VIOLATED
    found = run.clause(THERE[0], THERE[2])
    assert found.outcome is Outcome.UNKNOWN
    assert found.reason == f"event t:place-end never occurred: {failed.reason}"
    assert failed.reason.startswith(f"gripper lost {CUBE} at ")
