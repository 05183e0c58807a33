"""Assignment of scenarios to processes, and handling of their messages: scripted agents instead of processes.

A script lists, word by word, what an agent does with a scenario: ``start``, a verdict on the clause of a line
(``holds:5``), ``finish``, ``die`` (its process ends), ``late`` (time passes until its deadline), ``broken`` (it reports
that it cannot work), ``wait:NAME`` and ``go:NAME`` (one waits for the other), or any message as Python code.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from queue import SimpleQueue

import pytest

from robbdd_tools.catalog.coordination import TreeSpec
from robbdd_tools.monitor.fault import Fault
from robbdd_tools.protocol.messages import (
    ClauseJudged,
    ClauseStarted,
    LogLine,
    MarginRanges,
    Output,
    RunFinished,
    RunMessage,
    RunStarted,
    ScenarioFinished,
    ScenarioStarted,
    UserCodeFailed,
)
from robbdd_tools.protocol.specs import ClauseSpec, Manifest, ScenarioSpec
from robbdd_tools.run.agent_log import LIMIT
from robbdd_tools.run.scheduler import CANCELLED, STOPPED, TIMEOUT, Policy, Scheduler, ignore_event
from world.worlds import scenario

CLAUSES = tuple(ClauseSpec(line, f"t:c{line}", f"c{line}", "then", "it is so") for line in (5, 6))
SOUND = "start holds:5 holds:6 finish"
LATE = "still there"
"""What an agent prints before its deadline passes."""
FAULT = Fault("KeyError", "x", "steps:load")


class Stage:
    """The agents of one run and their clock; ``scripts`` has for each scenario what its executions do, in turn."""

    def __init__(self, scripts: Mapping[int, Sequence[str | RunMessage]], greeting: Sequence[RunMessage] = ()) -> None:
        self.scripts = {index: list(lines) for index, lines in scripts.items()}
        self.greeting = greeting
        self.now = 1000.0
        self.agents: list[ScriptedAgent] = []
        self.gates: dict[str, threading.Event] = {}
        self.crash: Fault | None = None

    def monotonic(self) -> float:
        return self.now

    def agent(self, folder: Path, number: int, *, log_limit: int, timeout: float) -> ScriptedAgent:
        self.agents.append(ScriptedAgent(self, folder, number, log_limit, timeout))
        return self.agents[-1]

    def gate(self, name: str) -> threading.Event:
        return self.gates.setdefault(name, threading.Event())

    def script(self, index: int) -> str | RunMessage:
        lines = self.scripts.get(index, [SOUND])
        return lines.pop(0) if len(lines) > 1 else lines[0]


@dataclass(frozen=True)
class ScriptedCrash:
    """Crash data of a process that ended within users' code: here none, or a given fault."""

    left: Fault | None

    def fault(self, ended: str, spec: ScenarioSpec | None, sources: Mapping[str, str]) -> Fault | None:
        assert sources == {}
        where = "" if spec is None else spec.name
        return None if self.left is None else replace(self.left, message=f"{ended} {where}".strip())


@dataclass
class ScriptedAgent:
    """What the scheduler needs of ``launch.Agent``."""

    stage: Stage
    folder: Path
    number: int
    log_limit: int
    timeout: float
    orders: SimpleQueue[int | None] = field(default_factory=SimpleQueue[int | None])
    executed: list[int] = field(default_factory=list[int])
    ended: threading.Event = field(default_factory=threading.Event)

    @property
    def pid(self) -> int:
        return 100 + self.number

    def execute(self, index: int) -> None:
        self.executed.append(index)
        self.orders.put(index)

    def messages(self) -> Iterator[RunMessage]:
        yield from self.stage.greeting
        while (index := self.orders.get()) is not None:
            script = self.stage.script(index)
            for word in script.split() if isinstance(script, str) else ("start", script, "finish"):
                if word == "die":
                    return
                yield from self._act(word, index)

    def _act(self, word: str | RunMessage, index: int) -> Iterator[RunMessage]:
        if not isinstance(word, str):
            yield word
            return
        action, _, more = word.partition(":")
        match action:
            case "start":
                yield ScenarioStarted(index)
            case "finish":
                yield ScenarioFinished(index, 1.0, 0.0, 0.0)
            case "late":
                yield Output(index, LATE)
                self.ended.wait(10)
            case "broken":
                yield LogLine("error", more)
                yield LogLine("warning", "as I said")
                yield RunFinished(False)
            case "wait":
                self.stage.gate(more).wait(10)
            case "go":
                self.stage.gate(more).set()
            case outcome:
                yield ClauseJudged(index, int(more), outcome, 1.0, "m", 1.0, "")

    def terminate(self) -> None:
        self.ended.set()
        self.orders.put(None)

    def kill(self) -> None:
        self.terminate()

    def wait(self, seconds: float) -> None: ...
    def finish(self) -> None: ...

    def ending(self) -> str:
        return f"agent {self.number} crashed"

    def exit(self) -> str:
        return "code 7"

    @property
    def crash(self) -> ScriptedCrash:
        return ScriptedCrash(self.stage.crash)


def manifest_of(count: int, trees: Mapping[int, str] | None = None) -> Manifest:
    """Return a manifest of scenarios with two clauses; those with the same tree share an execution."""

    def spec(index: int) -> ScenarioSpec:
        tree = (trees or {}).get(index)
        return replace(
            scenario(seed=index, clauses=CLAUSES), tree=None if tree is None else TreeSpec(tree, "t:tree", (), 0.0, 0.0)
        )

    return Manifest("m.bdd", 1, tuple(map(spec, range(count))))


def scheduler_of(
    monkeypatch: pytest.MonkeyPatch,
    stage: Stage,
    manifest: Manifest,
    policy: Policy,
    watch: Callable[[RunMessage], None] = ignore_event,
    indices: Sequence[int] | None = None,
    first_agent: int = 1,
) -> Scheduler:
    monkeypatch.setattr("robbdd_tools.run.scheduler.Agent", stage.agent)
    for module in ("scheduler", "agent_worker"):
        monkeypatch.setattr(f"robbdd_tools.run.{module}.monotonic", stage.monotonic)

    def heard(message: RunMessage) -> None:
        if isinstance(message, Output) and message.text == LATE:
            stage.now += 10_000.0
        watch(message)

    return Scheduler(Path("run"), manifest, policy, heard, indices, first_agent)


def shown(message: RunMessage) -> str:
    match message:
        case ScenarioStarted(index):
            return f"{index} starts"
        case ScenarioFinished(index):
            return f"{index} ends"
        case ClauseJudged():
            why = f" ({message.cause}: {message.reason})" if message.reason else ""
            return f"{message.index} {message.line} {message.verdict}{why}"
        case Output(index, text):
            return f"{index} prints {text}"
        case LogLine(level, text):
            return f"{level}: {text}"
        case RunFinished(ok):
            return "complete" if ok else "incomplete"
        case other:
            return type(other).__name__


def told(scheduler: Scheduler) -> list[str]:
    return [shown(message) for message in scheduler.messages()]


def whole(*indices: int) -> list[str]:
    """Return what sound executions of scenarios say."""
    return [line for i in indices for line in (f"{i} starts", f"{i} 5 holds", f"{i} 6 holds", f"{i} ends")]


def test_one_process_executes_everything_in_order(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({})
    assert told(scheduler_of(monkeypatch, stage, manifest_of(3), Policy(1))) == [*whole(0, 1, 2), "complete"]
    (agent,) = stage.agents
    assert (agent.executed, agent.number, agent.folder, agent.log_limit) == ([0, 1, 2], 1, Path("run"), LIMIT)
    assert agent.ended.is_set()


def test_what_watches_hears_everything_at_once_and_the_run_in_order(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["start wait:other holds:5 holds:6 finish"], 1: ["start holds:5 holds:6 finish go:other"]})
    heard: list[RunMessage] = []
    scheduler = scheduler_of(monkeypatch, stage, manifest_of(2), Policy(2), watch=heard.append)
    assert told(scheduler) == [*whole(0, 1), "complete"]
    assert [shown(message) for message in heard if isinstance(message, ScenarioFinished)] == ["1 ends", "0 ends"]
    assert [agent.executed for agent in stage.agents] == [[0], [1]]


def test_only_the_chosen_scenarios_are_executed_by_agents_with_the_next_numbers(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    stage = Stage({})
    policy = Policy(1, log_limit=77)
    scheduler = scheduler_of(monkeypatch, stage, manifest_of(5), policy, indices=[1, 3], first_agent=7)
    assert told(scheduler) == [*whole(1, 3), "complete"]
    assert [(agent.number, agent.log_limit) for agent in stage.agents] == [(7, 77)]


def test_no_more_processes_begin_than_there_is_work(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["start wait:b holds:5 holds:6 finish"], 1: ["start go:b holds:5 holds:6 finish"]})
    assert told(scheduler_of(monkeypatch, stage, manifest_of(2), Policy(8)))[-1] == "complete"
    assert len(stage.agents) == 2


def test_scenarios_of_one_tree_go_to_one_process_at_the_place_of_the_first(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({})
    manifest = manifest_of(5, {1: "a", 2: "b", 3: "a", 4: "b"})
    assert told(scheduler_of(monkeypatch, stage, manifest, Policy(1))) == [*whole(0, 1, 2, 3, 4), "complete"]
    assert stage.agents[0].executed == [0, 1, 3, 2, 4]


def test_a_process_that_dies_leaves_its_open_clauses_unknown_and_another_goes_on(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    stage = Stage({1: ["start holds:5 die"]})
    assert told(scheduler_of(monkeypatch, stage, manifest_of(3), Policy(1))) == [
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
    assert told(scheduler_of(monkeypatch, stage, manifest, Policy(1)))[-1] == "complete"
    assert [agent.executed for agent in stage.agents] == [[0], [2, 3, 1]]


def test_a_scenario_that_takes_too_long_is_ended_however_much_it_says(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["start holds:5 late"]})
    assert told(scheduler_of(monkeypatch, stage, manifest_of(2), Policy(1, timeout=9000.0))) == [
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
    assert told(scheduler) == ["0 starts", "0 prints slow", "0 ends", "complete"]


def test_a_process_that_does_not_begin_is_replaced_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["die", "late", SOUND], 1: ["die", "die", SOUND]})
    found = told(scheduler_of(monkeypatch, stage, manifest_of(2), Policy(1)))
    assert found == [f"0 prints {LATE}", *whole(0, 1), "complete"]
    assert len(stage.agents) == 5


def test_a_run_whose_processes_never_begin_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    for word, ending in (("die", "agent 3 crashed"), ("late", "the agent process did not begin within 120 s")):
        stage = Stage({1: [word]})
        scheduler = scheduler_of(monkeypatch, stage, manifest_of(3), Policy(1))
        found = told(scheduler)
        assert found[:4] == whole(0)
        assert found[-1] == "incomplete"
        assert scheduler.ending == ending
        assert [agent.executed for agent in stage.agents] == [[0, 1], [1], [1]]


def test_an_agent_that_cannot_work_says_why_once(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["broken:no-steps"], 1: ["wait:never"]})
    scheduler = scheduler_of(monkeypatch, stage, manifest_of(2), Policy(1))
    assert told(scheduler) == ["error: no-steps", "warning: as I said", "incomplete"]
    assert scheduler.ending == "no-steps"
    silent = Stage({0: ["wait:never"]}, [RunFinished(False)])
    scheduler = scheduler_of(monkeypatch, silent, manifest_of(1), Policy(1))
    assert told(scheduler) == ["incomplete"]
    assert scheduler.ending == "the agent cannot work"


def test_the_same_complaint_of_every_process_is_shown_once(monkeypatch: pytest.MonkeyPatch) -> None:
    same = [RunStarted(3, "MuJoCo"), LogLine("info", "hello"), UserCodeFailed(None, FAULT), Output(None, "loading")]
    stage = Stage({0: ["start die"], 1: ["start die"]}, same)
    heard: list[RunMessage] = []
    found = told(scheduler_of(monkeypatch, stage, manifest_of(3), Policy(1), watch=heard.append))
    for once in ("RunStarted", "info: hello", "UserCodeFailed", "None prints loading"):
        assert found.count(once) == 1
    assert len(stage.agents) == 3
    assert [shown(message) for message in heard].count("RunStarted") == 1
    assert [shown(message) for message in heard].count("UserCodeFailed") == 1
    assert [shown(message) for message in heard].count("None prints loading") == 1


def test_more_output_of_a_later_process_is_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["start die"]}, [Output(None, "one")])
    stage.scripts[1] = [Output(None, "two")]
    found = told(scheduler_of(monkeypatch, stage, manifest_of(2), Policy(1)))
    assert [line for line in found if line.startswith("None")] == ["None prints one", "None prints two"]


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
    found = told(scheduler_of(monkeypatch, Stage({0: [script]}), manifest_of(1), Policy(1)))
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
    found = told(scheduler_of(monkeypatch, Stage({0: [message]}), manifest_of(2), Policy(1)))
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


def test_a_second_beginning_gives_a_scenario_no_more_time(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["start start holds:5 late"]})
    found = told(scheduler_of(monkeypatch, stage, manifest_of(1), Policy(1)))
    assert found.count("0 starts") == 2
    assert f"0 6 unknown (timed-out: timed out after {TIMEOUT:g} s)" in found


@pytest.mark.parametrize("verdict", ["violated", "unknown"])
def test_the_first_failure_stops_what_comes_after_it(monkeypatch: pytest.MonkeyPatch, verdict: str) -> None:
    stage = Stage({1: [f"start holds:5 {verdict}:6 finish"]})
    scheduler = scheduler_of(monkeypatch, stage, manifest_of(4), Policy(1, stop_on_failure=True))
    assert told(scheduler) == [*whole(0), "1 starts", "1 5 holds", f"1 6 {verdict}", "1 ends", "incomplete"]
    assert scheduler.ending == STOPPED
    assert stage.agents[0].executed == [0, 1]


def test_a_failure_early_in_a_scenario_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["start violated:5 holds:6 finish"]})
    found = told(scheduler_of(monkeypatch, stage, manifest_of(2), Policy(1, stop_on_failure=True)))
    assert found == ["0 starts", "0 5 violated", "0 6 holds", "0 ends", "incomplete"]


def test_a_process_that_dies_is_a_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({0: ["start holds:5 die"]})
    scheduler = scheduler_of(monkeypatch, stage, manifest_of(2), Policy(1, stop_on_failure=True))
    assert told(scheduler)[-3:] == ["0 6 unknown (process-ended: agent 1 crashed)", "0 ends", "incomplete"]
    assert scheduler.ending == STOPPED


def test_a_failure_of_the_last_scenario_leaves_the_run_complete(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({2: ["start violated:5 holds:6 finish"]})
    scheduler = scheduler_of(monkeypatch, stage, manifest_of(5), Policy(1, stop_on_failure=True), indices=[0, 2])
    assert told(scheduler)[-1] == "complete"
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
    found = told(scheduler)
    assert found == [*whole(0), "1 starts", "1 5 violated", "1 6 holds", "1 ends", "incomplete"]
    stage.gate("never").set()


def test_after_a_failure_a_tree_gives_up_its_later_scenarios(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({1: ["start violated:5 holds:6 finish"]})
    manifest = manifest_of(4, {0: "a", 1: "a", 2: "a"})
    assert told(scheduler_of(monkeypatch, stage, manifest, Policy(1, stop_on_failure=True)))[-1] == "incomplete"
    assert stage.agents[0].executed == [0, 1]
    stage = Stage({1: ["start violated:5 holds:6 finish"]})
    manifest = manifest_of(5, {1: "a", 2: "b", 3: "a", 4: "b"})
    assert told(scheduler_of(monkeypatch, stage, manifest, Policy(1, stop_on_failure=True)))[-1] == "incomplete"
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
    assert told(scheduler) == [*whole(0, 1), "2 starts", "2 5 violated", "2 6 holds", "2 ends", "incomplete"]
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
    assert told(scheduler) == ["0 starts", *whole(1), "incomplete"]
    assert scheduler.ending == CANCELLED
    assert all(agent.ended.is_set() for agent in stage.agents)
    stage.gate("never").set()


def test_a_run_that_is_cancelled_when_all_is_done_is_complete(monkeypatch: pytest.MonkeyPatch) -> None:
    def watch(message: RunMessage) -> None:
        if isinstance(message, ScenarioFinished):
            scheduler.cancel()

    scheduler = scheduler_of(monkeypatch, Stage({}), manifest_of(1), Policy(1), watch=watch)
    assert told(scheduler) == [*whole(0), "complete"]
    assert scheduler.ending == ""


def test_busy_processes_are_those_that_have_begun_a_scenario(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage({})
    busy: list[dict[int, int]] = []

    def watch(message: RunMessage) -> None:
        if isinstance(message, ClauseJudged):
            busy.append(scheduler.busy)

    scheduler = scheduler_of(monkeypatch, stage, manifest_of(2), Policy(1), watch=watch)
    told(scheduler)
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
