"""Runs that end early: at the first failure, or because someone cancels them."""

from __future__ import annotations

import pytest

from robbdd_tools.protocol.messages import (
    RunMessage,
    ScenarioFinished,
    ScenarioStarted,
)
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.run.scheduler import CANCELLED, STOPPED
from run.scripted_agents import (
    Stage,
    manifest_of,
    messages_of,
    scheduler_of,
    whole,
)


@pytest.mark.parametrize("verdict", ["violated", "unknown"])
def test_the_first_failure_stops_what_comes_after_it(monkeypatch: pytest.MonkeyPatch, verdict: str) -> None:
    stage = Stage({1: [f"start holds:5 {verdict}:6 finish"]})
    scheduler = scheduler_of(monkeypatch, stage, manifest_of(4), Policy(1, stop_on_failure=True))
    assert messages_of(scheduler) == [*whole(0), "1 starts", "1 5 holds", f"1 6 {verdict}", "1 ends", "incomplete"]
    assert scheduler.ending == STOPPED
    assert stage.agents[0].executed == [0, 1]


def test_a_failure_early_in_a_scenario_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["start violated:5 holds:6 finish"]})
    found = messages_of(scheduler_of(monkeypatch, stage, manifest_of(2), Policy(1, stop_on_failure=True)))
    assert found == ["0 starts", "0 5 violated", "0 6 holds", "0 ends", "incomplete"]


def test_a_process_that_dies_is_a_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["start holds:5 die"]})
    scheduler = scheduler_of(monkeypatch, stage, manifest_of(2), Policy(1, stop_on_failure=True))
    assert messages_of(scheduler)[-3:] == ["0 6 unknown (process-ended: agent 1 crashed)", "0 ends", "incomplete"]
    assert scheduler.ending == STOPPED


def test_a_failure_of_the_last_scenario_leaves_the_run_complete(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({2: ["start violated:5 holds:6 finish"]})
    scheduler = scheduler_of(monkeypatch, stage, manifest_of(5), Policy(1, stop_on_failure=True), indices=[0, 2])
    assert messages_of(scheduler)[-1] == "complete"
    assert scheduler.ending == ""


def test_after_a_failure_earlier_scenarios_go_on_and_later_ones_are_dropped(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage(
        {
            0: ["start wait:failed holds:5 holds:6 finish"],
            1: ["start wait:third violated:5 holds:6 finish"],
            2: ["start holds:5 go:third wait:failed wait:never"],
        }
    )

    def watch(message: RunMessage) -> None:
        if message == ScenarioFinished(1, 1.0, 0.0, 0.0):
            stage.gate("failed").set()

    policy = Policy(3, stop_on_failure=True)
    scheduler = scheduler_of(monkeypatch, stage, manifest_of(5), policy, watch=watch)
    found = messages_of(scheduler)
    assert found == [*whole(0), "1 starts", "1 5 violated", "1 6 holds", "1 ends", "incomplete"]
    stage.gate("never").set()


def test_after_a_failure_a_tree_gives_up_its_later_scenarios(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({1: ["start violated:5 holds:6 finish"]})
    manifest = manifest_of(4, {0: "a", 1: "a", 2: "a"})
    assert messages_of(scheduler_of(monkeypatch, stage, manifest, Policy(1, stop_on_failure=True)))[-1] == "incomplete"
    assert stage.agents[0].executed == [0, 1]
    stage = Stage({1: ["start violated:5 holds:6 finish"]})
    manifest = manifest_of(5, {1: "a", 2: "b", 3: "a", 4: "b"})
    assert messages_of(scheduler_of(monkeypatch, stage, manifest, Policy(1, stop_on_failure=True)))[-1] == "incomplete"
    assert stage.agents[0].executed == [0, 1]


def test_an_earlier_scenario_of_a_waiting_tree_is_still_executed(monkeypatch: pytest.MonkeyPatch) -> None:
    # The scenarios 1 and 3 wait for each other's process while 2 fails.
    stage = Stage(
        {0: ["start wait:failed holds:5 holds:6 finish"], 2: ["start violated:5 holds:6 finish"]},
    )

    def watch(message: RunMessage) -> None:
        if message == ScenarioFinished(2, 1.0, 0.0, 0.0):
            stage.gate("failed").set()

    manifest = manifest_of(4, {0: "a", 1: "a", 3: "a"})
    scheduler = scheduler_of(monkeypatch, stage, manifest, Policy(2, stop_on_failure=True), watch=watch)
    assert messages_of(scheduler) == [*whole(0, 1), "2 starts", "2 5 violated", "2 6 holds", "2 ends", "incomplete"]
    assert [agent.executed for agent in stage.agents] == [[0, 1], [2]]


def test_a_cancelled_run_keeps_what_is_finished(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["start wait:never"], 1: ["start holds:5 holds:6 finish"], 2: ["start wait:never"]})

    started: set[int] = set()

    def watch(message: RunMessage) -> None:
        if isinstance(message, ScenarioStarted):
            started.add(message.index)
            if {0, 2} <= started:
                scheduler.cancel()

    scheduler = scheduler_of(monkeypatch, stage, manifest_of(3), Policy(2), watch=watch)
    assert messages_of(scheduler) == ["0 starts", *whole(1), "incomplete"]
    assert scheduler.ending == CANCELLED
    assert all(agent.ended.is_set() for agent in stage.agents)
    stage.gate("never").set()


def test_a_run_that_is_cancelled_when_all_is_done_is_complete(monkeypatch: pytest.MonkeyPatch) -> None:
    def watch(message: RunMessage) -> None:
        if isinstance(message, ScenarioFinished):
            scheduler.cancel()

    scheduler = scheduler_of(monkeypatch, Stage({}), manifest_of(1), Policy(1), watch=watch)
    assert messages_of(scheduler) == [*whole(0), "complete"]
    assert scheduler.ending == ""
