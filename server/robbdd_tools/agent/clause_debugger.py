"""Pause an execution at moments of its clauses, and report its state while it waits.

A pause only makes the process wait: the execution that continues is the same as without it.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass, field
from queue import SimpleQueue
from time import perf_counter
from typing import TYPE_CHECKING

from robbdd_tools.agent.channel import current_channel
from robbdd_tools.agent.clause_watch import ClauseWatch
from robbdd_tools.agent.paused_scene import write_scene
from robbdd_tools.agent.paused_state import paused_state
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.messages import LogLine
from robbdd_tools.protocol.pauses import (
    DebugOrder,
    Hit,
    Pause,
    Reason,
    Resume,
    SceneWritten,
    SetBreakpoints,
    Until,
    WriteScene,
    decode_order,
)
from robbdd_tools.protocol.run_folder import PAUSING

if TYPE_CHECKING:
    from robbdd_tools.agent.clause_watch import WatchedClauses
    from robbdd_tools.agent.execution import Execution
    from robbdd_tools.protocol.messages import ClauseJudged
    from robbdd_tools.protocol.specs import ScenarioSpec


class Pauses:
    """The pauses of a process that no debugger controls: there are none."""

    def take(self, line: str) -> bool:
        """Accept a debugger's order; return false for any other order."""
        del line
        return False

    @property
    def waited(self) -> float:
        """The wall time of the pauses of the current scenario, s."""
        return 0.0

    def begin(self, index: int, spec: ScenarioSpec, watched: WatchedClauses, execution: Execution) -> None:
        """Watch the execution of scenario number ``index``, which has been set up."""

    def step(self, line: int) -> None:
        """Note the step that is executed next: the step of the clause on a feature line."""

    def judged(self, message: ClauseJudged) -> None:
        """Note the verdict on a clause."""

    def end(self) -> None:
        """Forget the execution."""


@dataclass(slots=True)
class _Scenario:
    """The current scenario: its number, its execution, and its verdicts by feature line."""

    index: int
    execution: Execution
    watch: ClauseWatch
    verdicts: dict[int, ClauseJudged] = field(default_factory=dict[int, "ClauseJudged"])


class ClauseDebugger(Pauses):
    """Pauses executions as a debugger orders. ``take`` is called by the thread that reads orders."""

    def __init__(self) -> None:
        self._orders: SimpleQueue[DebugOrder] = SimpleQueue()
        self._breakpoints = SetBreakpoints()
        self._until = Until.BREAKPOINT
        self._awaited: set[tuple[int, int]] = set()
        self._is_pause_wanted = False
        self._waited = 0.0
        self._line: int | None = None
        self._subject: int | None = None
        self._scenario: _Scenario | None = None

    @property
    def waited(self) -> float:
        """The wall time of the pauses of the current scenario, s."""
        return self._waited

    def take(self, line: str) -> bool:
        """Accept a debugger's order; return false for any other order."""
        try:
            order = decode_order(line)
        except ValueError as error:
            current_channel().send(LogLine("warning", str(error)))
            return True
        if order is not None:
            self._orders.put(order)
        return order is not None

    def begin(self, index: int, spec: ScenarioSpec, watched: WatchedClauses, execution: Execution) -> None:
        """Watch the execution of scenario number ``index``, which has been set up, and pause before it begins."""
        self._scenario = scenario = _Scenario(index, execution, ClauseWatch(spec, watched, execution))
        execution.course.observers.append(self._observe)
        self._wait(scenario, Reason.ENTRY)

    def step(self, line: int) -> None:
        """Note the step that is executed next: the step of the clause on a feature line."""
        self._line = line

    def judged(self, message: ClauseJudged) -> None:
        """Note the verdict on a clause, and pause if the verdict is a moment of the clause."""
        scenario = self._scenario
        if scenario is None:
            return
        scenario.verdicts[message.line] = message
        reached = list(scenario.watch.judged(message.line, violated=message.verdict == Outcome.VIOLATED))
        if reached:
            self._pause_at(scenario, reached)

    def end(self) -> None:
        """Forget the execution."""
        if self._scenario is not None:
            self._scenario.execution.course.observers.remove(self._observe)
        self._scenario = self._line = None
        self._waited = 0.0

    def _observe(self) -> None:
        """Pause if there is a reason in the sample that was just recorded."""
        scenario = self._scenario
        assert scenario is not None
        while not self._orders.empty():
            self._obey(scenario, self._orders.get())
        self._pause_at(scenario, list(scenario.watch.moments()))

    def _pause_at(self, scenario: _Scenario, reached: list[Hit]) -> None:
        """Pause if any of the moments ``reached``, the last order to continue or an order to pause is a reason."""
        hits = [hit for hit in reached if self._is_stopped_at(hit)]
        if hits:
            self._wait(scenario, Reason.BREAKPOINT, hits)
        elif self._is_pause_wanted:
            self._wait(scenario, Reason.PAUSE)
        elif self._is_reached(scenario, reached):
            self._wait(scenario, Reason.STEP, reached)

    def _is_reached(self, scenario: _Scenario, reached: list[Hit]) -> bool:
        match self._until:
            case Until.BREAKPOINT:
                return False
            case Until.MOMENT:
                return bool(reached)
            case Until.SAMPLE:
                return True
            case Until.CLOSED:
                return self._awaited.isdisjoint(scenario.watch.open_parts())

    def _is_stopped_at(self, hit: Hit) -> bool:
        """Return whether a breakpoint is set on a moment of a fluent."""
        return hit.moment in self._breakpoints.everywhere or any(
            one.line == hit.line and one.part in (None, hit.part) and hit.moment in one.moments
            for one in self._breakpoints.breakpoints
        )

    def _wait(self, scenario: _Scenario, reason: Reason, hits: Iterable[Hit] = ()) -> None:
        """Report the state of the scenario, and obey orders until one of them is to continue."""
        began = perf_counter()
        self._is_pause_wanted = False
        stopped = tuple(hits)
        self._subject = line = stopped[0].line if stopped else self._line
        state = paused_state(
            scenario.index, scenario.execution, scenario.watch, scenario.verdicts, reason, line, stopped
        )
        current_channel().send(state)
        while not self._obey(scenario, self._orders.get()):
            pass
        self._waited += perf_counter() - began

    def _obey(self, scenario: _Scenario, order: DebugOrder) -> bool:
        """Carry out an order. Return whether it is to continue."""
        match order:
            case SetBreakpoints():
                self._breakpoints = order
            case Pause():
                self._is_pause_wanted = True
            case WriteScene(path):
                problem = write_scene(path, scenario.execution, scenario.watch)
                current_channel().send(SceneWritten(scenario.index, path, problem))
            case Resume(until):
                self._awaited = {part for part in scenario.watch.open_parts() if part[0] == self._subject}
                self._until = Until.MOMENT if until == Until.CLOSED and not self._awaited else Until(until)
                return True
        return False


_current = Pauses()


def current_pauses() -> Pauses:
    """Return the pauses of this process."""
    return _current


def use_pauses(pauses: Pauses) -> None:
    """Set the pauses of this process."""
    global _current
    _current = pauses


def begin_pauses() -> Pauses:
    """Return the pauses of this process, after its environment has stated whether a debugger controls them."""
    if os.environ.pop(PAUSING, ""):
        use_pauses(ClauseDebugger())
    return _current
