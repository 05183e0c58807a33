"""Scripted agents, which take the place of processes in tests of the scheduler.

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
    LogLine,
    Output,
    RunFinished,
    RunMessage,
    ScenarioFinished,
    ScenarioStarted,
)
from robbdd_tools.protocol.specs import ClauseSpec, Manifest, ScenarioSpec
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.run.scheduler import Scheduler, ignore_event
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

    def agent(
        self, folder: Path, number: int, *, log_limit: int, timeout: float, debug: int | None, pausing: bool
    ) -> ScriptedAgent:
        assert not pausing
        self.agents.append(ScriptedAgent(self, folder, number, log_limit, timeout, debug))
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
    debug: int | None
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


def messages_of(scheduler: Scheduler) -> list[str]:
    return [shown(message) for message in scheduler.messages()]


def whole(*indices: int) -> list[str]:
    """Return what sound executions of scenarios say."""
    return [line for i in indices for line in (f"{i} starts", f"{i} 5 holds", f"{i} 6 holds", f"{i} ends")]
