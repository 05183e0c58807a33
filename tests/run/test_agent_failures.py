"""Processes that die, take too long or cannot begin: another one goes on, and each open clause is unknown."""

from __future__ import annotations

import pytest

from robbdd_tools.protocol.messages import (
    ClauseJudged,
    LogLine,
    Output,
    RunFinished,
    RunMessage,
    RunStarted,
    UserCodeFailed,
)
from robbdd_tools.run.run_policy import TIMEOUT, Policy
from run.scripted_agents import (
    FAULT,
    LATE,
    SOUND,
    Stage,
    manifest_of,
    messages_of,
    scheduler_of,
    shown,
    whole,
)


def test_a_process_that_dies_leaves_its_open_clauses_unknown_and_another_goes_on(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    stage = Stage({1: ["start holds:5 die"]})
    assert messages_of(scheduler_of(monkeypatch, stage, manifest_of(3), Policy(1))) == [
        *whole(0),
        "1 starts",
        "1 5 holds",
        "1 6 unknown (process-ended: agent 1 crashed)",
        "1 ends",
        *whole(2),
        "complete",
    ]
    assert [(agent.number, agent.executed) for agent in stage.agents] == [(1, [0, 1]), (2, [2])]


def test_the_rest_of_a_tree_goes_to_the_next_process(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["start die"]})
    manifest = manifest_of(4, {0: "a", 2: "a", 3: "a"})
    assert messages_of(scheduler_of(monkeypatch, stage, manifest, Policy(1)))[-1] == "complete"
    assert [agent.executed for agent in stage.agents] == [[0], [2, 3, 1]]


def test_a_scenario_that_takes_too_long_is_ended_however_much_it_says(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["start holds:5 late"]})
    assert messages_of(scheduler_of(monkeypatch, stage, manifest_of(2), Policy(1, timeout=9000.0))) == [
        "0 starts",
        "0 5 holds",
        f"0 prints {LATE}",
        "0 6 unknown (timed-out: timed out after 9000 s)",
        "0 ends",
        *whole(1),
        "complete",
    ]


def test_without_a_limit_a_scenario_may_take_any_time(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({})
    output = Output(0, "slow")

    def hours(message: RunMessage) -> None:
        if message == output:
            stage.now += 1e6

    stage.scripts[0] = [output]
    scheduler = scheduler_of(monkeypatch, stage, manifest_of(1), Policy(1, timeout=0.0), watch=hours)
    assert messages_of(scheduler) == ["0 starts", "0 prints slow", "0 ends", "complete"]


def test_a_process_that_does_not_begin_is_replaced_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["die", "late", SOUND], 1: ["die", "die", SOUND]})
    found = messages_of(scheduler_of(monkeypatch, stage, manifest_of(2), Policy(1)))
    assert found == [f"0 prints {LATE}", *whole(0, 1), "complete"]
    assert len(stage.agents) == 5


def test_a_run_whose_processes_never_begin_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    for word, ending in (("die", "agent 3 crashed"), ("late", "the agent process did not begin within 120 s")):
        stage = Stage({1: [word]})
        scheduler = scheduler_of(monkeypatch, stage, manifest_of(3), Policy(1))
        found = messages_of(scheduler)
        assert found[:4] == whole(0)
        assert found[-1] == "incomplete"
        assert scheduler.ending == ending
        assert [agent.executed for agent in stage.agents] == [[0, 1], [1], [1]]


def test_an_agent_that_cannot_work_says_why_once(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["broken:no-steps"], 1: ["wait:never"]})
    scheduler = scheduler_of(monkeypatch, stage, manifest_of(2), Policy(1))
    assert messages_of(scheduler) == ["error: no-steps", "warning: as I said", "incomplete"]
    assert scheduler.ending == "no-steps"
    silent = Stage({0: ["wait:never"]}, [RunFinished(False)])
    scheduler = scheduler_of(monkeypatch, silent, manifest_of(1), Policy(1))
    assert messages_of(scheduler) == ["incomplete"]
    assert scheduler.ending == "the agent cannot work"


def test_the_same_complaint_of_every_process_is_shown_once(monkeypatch: pytest.MonkeyPatch) -> None:
    same = [RunStarted(3, "MuJoCo"), LogLine("info", "hello"), UserCodeFailed(None, FAULT), Output(None, "loading")]
    stage = Stage({0: ["start die"], 1: ["start die"]}, same)
    heard: list[RunMessage] = []
    found = messages_of(scheduler_of(monkeypatch, stage, manifest_of(3), Policy(1), watch=heard.append))
    for once in ("RunStarted", "info: hello", "UserCodeFailed", "None prints loading"):
        assert found.count(once) == 1
    assert len(stage.agents) == 3
    assert [shown(message) for message in heard].count("RunStarted") == 1
    assert [shown(message) for message in heard].count("UserCodeFailed") == 1
    assert [shown(message) for message in heard].count("None prints loading") == 1


def test_more_output_of_a_later_process_is_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["start die"]}, [Output(None, "one")])
    stage.scripts[1] = [Output(None, "two")]
    found = messages_of(scheduler_of(monkeypatch, stage, manifest_of(2), Policy(1)))
    assert [line for line in found if line.startswith("None")] == ["None prints one", "None prints two"]


def test_a_second_beginning_gives_a_scenario_no_more_time(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["start start holds:5 late"]})
    found = messages_of(scheduler_of(monkeypatch, stage, manifest_of(1), Policy(1)))
    assert found.count("0 starts") == 2
    assert f"0 6 unknown (timed-out: timed out after {TIMEOUT:g} s)" in found


def test_users_code_that_ends_or_blocks_its_process_is_the_fault_of_the_open_clauses(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for script, ended in (
        ("start holds:5 die", "the process ended with code 7"),
        ("start holds:5 late", "timed out after 300 s"),
    ):
        stage = Stage({0: [script]})
        stage.crash = FAULT
        messages = list(scheduler_of(monkeypatch, stage, manifest_of(1), Policy(1)).messages())
        (failed,) = (message for message in messages if isinstance(message, UserCodeFailed))
        (open_clause,) = (m for m in messages if isinstance(m, ClauseJudged) and m.line == 6)
        assert (failed.index, failed.fault.message) == (0, f"{ended} {manifest_of(1).scenarios[0].name}")
        assert (open_clause.fault, open_clause.reason) == (failed.fault.id, failed.fault.words)
        assert messages.index(failed) < messages.index(open_clause)


def test_users_code_that_keeps_processes_from_beginning_is_the_fault_of_the_run(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    stage = Stage({0: ["die"]})
    stage.crash = FAULT
    heard: list[RunMessage] = []
    scheduler = scheduler_of(monkeypatch, stage, manifest_of(1), Policy(1), heard.append)
    (failed, finished) = scheduler.messages()
    assert isinstance(failed, UserCodeFailed)
    assert (failed.index, failed.fault.message) == (None, "the process ended with code 7")
    assert (finished, scheduler.ending) == (RunFinished(False), failed.fault.words)
    assert heard == [failed]
