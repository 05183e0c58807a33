"""Assignment of scenarios to processes, and handling of their messages."""

from __future__ import annotations

from math import inf
from pathlib import Path
from typing import cast

import pytest

from robbdd_tools.protocol.messages import (
    ClauseJudged,
    ClauseStarted,
    MarginRanges,
    Output,
    RunFinished,
    RunMessage,
    ScenarioFinished,
    ScenarioStarted,
    UserCodeFailed,
)
from robbdd_tools.run.agent_log import LIMIT
from robbdd_tools.run.agent_worker import AgentWorker
from robbdd_tools.run.debugging import debugged
from robbdd_tools.run.launch import Agent
from robbdd_tools.run.run_policy import TIMEOUT, Policy
from run.scripted_agents import (
    FAULT,
    Stage,
    manifest_of,
    messages_of,
    scheduler_of,
    shown,
    whole,
)


def test_one_process_executes_everything_in_order(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({})
    assert messages_of(scheduler_of(monkeypatch, stage, manifest_of(3), Policy(1))) == [*whole(0, 1, 2), "complete"]
    (agent,) = stage.agents
    assert (agent.executed, agent.number, agent.folder, agent.log_limit) == ([0, 1, 2], 1, Path("run"), LIMIT)
    assert agent.ended.is_set()


def test_what_watches_hears_everything_at_once_and_the_run_in_order(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["start wait:other holds:5 holds:6 finish"], 1: ["start holds:5 holds:6 finish go:other"]})
    heard: list[RunMessage] = []
    scheduler = scheduler_of(monkeypatch, stage, manifest_of(2), Policy(2), watch=heard.append)
    assert messages_of(scheduler) == [*whole(0, 1), "complete"]
    assert [shown(message) for message in heard if isinstance(message, ScenarioFinished)] == ["1 ends", "0 ends"]
    assert [agent.executed for agent in stage.agents] == [[0], [1]]


def test_only_the_chosen_scenarios_are_executed_by_agents_with_the_next_numbers(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    stage = Stage({})
    policy = Policy(1, log_limit=77)
    scheduler = scheduler_of(monkeypatch, stage, manifest_of(5), policy, indices=[1, 3], first_agent=7)
    assert messages_of(scheduler) == [*whole(1, 3), "complete"]
    assert [(agent.number, agent.log_limit) for agent in stage.agents] == [(7, 77)]


def test_a_debugged_process_has_no_time_limit_while_it_waits(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({})
    scheduler = scheduler_of(monkeypatch, stage, manifest_of(2), debugged(Policy(8), 5678))
    assert messages_of(scheduler) == [*whole(0, 1), "complete"]
    assert [(agent.debug, agent.timeout) for agent in stage.agents] == [(5678, 0.0)]
    limited, waiting = (AgentWorker(cast(Agent, stage.agents[0]), debugged=flag) for flag in (False, True))
    for worker in (limited, waiting):
        worker.assign([0])
    assert limited.deadline < waiting.deadline == inf


def test_no_more_processes_begin_than_there_is_work(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["start wait:b holds:5 holds:6 finish"], 1: ["start go:b holds:5 holds:6 finish"]})
    assert messages_of(scheduler_of(monkeypatch, stage, manifest_of(2), Policy(8)))[-1] == "complete"
    assert len(stage.agents) == 2


def test_scenarios_of_one_tree_go_to_one_process_at_the_place_of_the_first(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({})
    manifest = manifest_of(5, {1: "a", 2: "b", 3: "a", 4: "b"})
    assert messages_of(scheduler_of(monkeypatch, stage, manifest, Policy(1))) == [*whole(0, 1, 2, 3, 4), "complete"]
    assert stage.agents[0].executed == [0, 1, 3, 2, 4]


@pytest.mark.parametrize(
    ("script", "warning"),
    [
        ("holds:5 start holds:5 holds:6 finish", "warning: ignored ClauseJudged before the beginning of a scenario"),
        ("finish start holds:5 holds:6 finish", "warning: ignored ScenarioFinished before the beginning of a scenario"),
        ("start holds:5 violated:5 holds:6 finish", "warning: ignored another verdict on the clause of line 5"),
        ("start holds:5 holds:99 holds:6 finish", "warning: ignored ClauseJudged of line 99, where scenario 0 has"),
    ],
)
def test_what_an_agent_cannot_have_sent_is_ignored_with_a_warning(
    monkeypatch: pytest.MonkeyPatch, script: str, warning: str
) -> None:
    found = messages_of(scheduler_of(monkeypatch, Stage({0: [script]}), manifest_of(1), Policy(1)))
    assert [line for line in found if not line.startswith("warning")] == [*whole(0), "complete"]
    assert [line.startswith(warning) for line in found if line.startswith("warning")] == [True]


@pytest.mark.parametrize(
    ("message", "warning"),
    [
        (RunFinished(True), "warning: ignored RunFinished within a scenario"),
        (ScenarioFinished(1, 1.0, 1.0, 1.0), "warning: ignored ScenarioFinished of scenario 1, which the agent"),
        (ScenarioStarted(-1), "warning: ignored ScenarioStarted of scenario -1, which the agent"),
        (ScenarioStarted(2), "warning: ignored ScenarioStarted of scenario 2, which the agent"),
    ],
)
def test_messages_of_other_scenarios_are_ignored_with_a_warning(
    monkeypatch: pytest.MonkeyPatch, message: RunMessage, warning: str
) -> None:
    found = messages_of(scheduler_of(monkeypatch, Stage({0: [message]}), manifest_of(2), Policy(1)))
    assert found[0] == "0 starts"
    assert found[1].startswith(warning)
    assert found[2:] == ["0 ends", *whole(1), "complete"]


@pytest.mark.parametrize(
    "message", [ClauseStarted(0, 5), MarginRanges(0, 5, ((0.0, 1.0),)), UserCodeFailed(0, FAULT), Output(0, "hello")]
)
def test_what_an_agent_says_within_a_scenario_is_passed_on(
    monkeypatch: pytest.MonkeyPatch, message: RunMessage
) -> None:
    heard: list[RunMessage] = []
    scheduler = scheduler_of(monkeypatch, Stage({0: [message]}), manifest_of(1), Policy(1), watch=heard.append)
    assert list(scheduler.messages())[1] == heard[1] == message


def test_busy_processes_are_those_that_have_begun_a_scenario(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({})
    busy: list[dict[int, int]] = []

    def watch(message: RunMessage) -> None:
        if isinstance(message, ClauseJudged):
            busy.append(scheduler.busy)

    scheduler = scheduler_of(monkeypatch, stage, manifest_of(2), Policy(1), watch=watch)
    messages_of(scheduler)
    assert busy == [{101: 0}, {101: 0}, {101: 1}, {101: 1}]
    assert scheduler.busy == {}


def test_single_scenarios_are_executed_in_any_order_by_one_process_that_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({1: ["start die"]})
    scheduler = scheduler_of(monkeypatch, stage, manifest_of(3), Policy(1))
    assert [shown(message) for message in scheduler.execute(2)] == whole(2)
    assert [shown(message) for message in scheduler.execute(0)] == whole(0)
    assert not stage.agents[0].ended.is_set()
    assert [shown(message) for message in scheduler.execute(1)][-2:] == [
        "1 6 unknown (process-ended: agent 1 crashed)",
        "1 ends",
    ]
    assert [shown(message) for message in scheduler.execute(2)] == whole(2)
    assert [agent.executed for agent in stage.agents] == [[2, 0, 1], [2]]
    scheduler.close()
    assert stage.agents[1].ended.is_set()


def test_a_policy_has_defaults_for_what_is_not_given() -> None:
    assert Policy.of() == Policy()
    assert Policy.of(jobs=3, timeout=7.0, stop_on_failure=True) == Policy(3, 7.0, True)
    assert Policy.of(jobs=0).jobs == 0
    assert Policy.of(timeout=0.0).timeout == 0.0
    assert (Policy().timeout, Policy().stop_on_failure, Policy().log_limit) == (TIMEOUT, False, LIMIT)
