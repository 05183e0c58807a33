"""One execution of a scenario. It is simulated lazily, only as far as its clauses need."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from time import perf_counter
from typing import TYPE_CHECKING

from robbdd_tools.agent.behaviour_run import BehaviourRun
from robbdd_tools.catalog.coordination import each_emitter
from robbdd_tools.catalog.object_settings import can_move
from robbdd_tools.judging.defined_events import with_defined_events
from robbdd_tools.monitor.trace import Trace
from robbdd_tools.world.engine import TICK
from robbdd_tools.world.joint_clearance import joint_clearances
from robbdd_tools.world.passive_joints import opening_records

if TYPE_CHECKING:
    from robbdd_tools.agent.behaviour_calls import Call, Timing
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.monitor.fault import Fault
    from robbdd_tools.monitor.judge import Regions
    from robbdd_tools.monitor.verdict import Verdict
    from robbdd_tools.protocol.clauses import Clause
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.world.simulation import Simulation


class Execution:
    """The execution of a scenario, which uses a ``BehaviourRun`` under the scenario's own event names.

    Without ``course``, a new ``BehaviourRun`` is created. Scenarios that are linked to one behaviour tree share it.
    Raises ``SceneError`` if the scene cannot be set up.
    """

    def __init__(
        self,
        spec: ScenarioSpec,
        calls: Sequence[Call],
        timing: Timing | None = None,
        course: BehaviourRun | None = None,
    ) -> None:
        self.course = course or BehaviourRun(spec, calls, timing)
        self._events = spec.events
        self._names = _names_of(spec.events)
        self._node = spec.node
        self._defined = spec.defined
        self._found: tuple[tuple[int, int, bool], Trace] | None = None
        if spec.defined:
            self.course.has_occurred = lambda event, iteration: self.trace.event_time(event, iteration) is not None

    @property
    def simulation(self) -> Simulation:
        """The simulation."""
        return self.course.simulation

    @property
    def regions(self) -> Regions:
        """The regions of the scene's workspaces."""
        return self.course.regions

    @property
    def completed(self) -> int:
        """The number of behaviours that have succeeded."""
        return len(self.course.succeeded)

    @property
    def broken(self) -> str:
        """The error in the user's code or model that prevents any verdict; empty if there is none."""
        return self.course.broken

    @property
    def fault(self) -> Fault | None:
        """The error in the user's code that caused ``broken``."""
        return self.course.fault

    @property
    def simulated(self) -> float:
        """The simulated time so far, s."""
        return self.simulation.time

    @property
    def wall(self) -> float:
        """The wall time spent so far, s."""
        return self.course.wall

    @property
    def stepping(self) -> float:
        """The wall time that the steps of the physics engine have taken so far, s."""
        return self.simulation.stepping

    @property
    def trace(self) -> Trace:
        """The trace so far."""
        course = self.course
        events = tuple(replace(stamp, name=name) for stamp in course.stamps for name in self._names.get(stamp.name, ()))
        trace = course.simulation.trace(events, course.finished, course.remark)
        trace = replace(
            trace, unreached=self._unreached(), contents=course.contents, correct_places=course.correct_places
        )
        if self._defined:
            trace = self._with_defined_events(trace)
        if course.tree is None:
            return trace
        executions, pending = course.tree.executions, course.tree.pending
        return replace(
            trace,
            executions={event: executions[emitter] for event, emitter in self._events.items() if emitter in executions},
            pending=tuple(event for event, emitter in self._events.items() if emitter in pending),
        )

    def _with_defined_events(self, trace: Trace) -> Trace:
        """Return a trace with the events that the template defines by conditions. The last result is cached."""
        course = self.course
        state = len(trace.times), len(course.stamps), course.finished
        if self._found is None or self._found[0] != state:
            conditions = [condition for event in self._defined for condition in event.conditions]
            for condition in conditions:
                course.quantities.measure(condition, trace, range(len(trace.times)))
            complete = self.complete(trace)
            found = with_defined_events(complete, self._defined, course.regions, numbered=not self._node)
            self._found = state, found
        found = self._found[1]
        return replace(trace, events=found.events, defined=found.defined, doubts=found.doubts)

    def state_at(self, time: float) -> FloatArray:
        """Return the joint positions of the engine at the last sample at or before a time (s)."""
        return self.simulation.recorder.states[self.trace.last_at_or_before(time + TICK / 2)]

    def advance_until(self, satisfied: Callable[[Trace], bool]) -> Trace:
        """Simulate until the trace satisfies a condition or the execution is finished; return the trace.

        The condition is evaluated after each event, after each behaviour, and every few control ticks. If the scenario
        is linked to a part of a behaviour tree, the condition is first evaluated when that part starts.
        """
        course = self.course
        while not (course.finished or self._begun):
            course.go_on()
        trace = self.trace
        while not (course.finished or satisfied(trace)):
            course.go_on()
            trace = self.trace
        return trace

    def measured(self, clause: Clause, trace: Trace) -> Trace:
        """Return a trace with the configuration and the costly quantities that are needed to judge a clause."""
        began = perf_counter()
        self.course.quantities.measure(clause, trace)
        self.course.wall += perf_counter() - began
        return self.complete(trace)

    def complete(self, trace: Trace) -> Trace:
        """Return a trace with all data added to its samples."""
        size, forces, cast = len(trace.times), self.simulation.forces, self.simulation.world.cast
        touches = self.simulation.touches
        return replace(
            self.course.quantities.added_to(trace),
            joint_clearances=joint_clearances(self.simulation.robots.values(), self.simulation.recorder.states[:size]),
            settings=self.course.settings,
            forces=forces.peaks(size),
            impulses=forces.impulses(size),
            watched=forces.agents,
            touches={} if touches is None else touches.peaks(size),
            touch_watched=() if touches is None else touches.watched,
            contacts=forces.contacts(trace.times),
            immovable=(*(name for name, model in cast.objects.items() if not can_move(model)), *cast.agents),
            outlines=self.course.outlines,
            openings=opening_records(self.simulation.model, cast.openings, self.simulation.recorder.states[:size]),
        )

    def run_behaviour(self, index: int) -> bool:
        """Simulate until behaviour number ``index`` is over; return whether it succeeded.

        If the scenario is linked to a node of a behaviour tree, simulate until that node is over.
        """
        tree = self.course.tree
        if tree is None or not self._node:
            self.advance_until(lambda _: index in self.course.succeeded or index in self.course.failures)
            return index in self.course.succeeded
        self.advance_until(lambda _: tree.is_over(self._node))
        return tree.has_succeeded(self._node)

    def chosen(self, index: int) -> str:
        """Return the places that behaviour number ``index`` chose from a set, as text; empty if it had no choice."""
        course = self.course
        found = [
            choice.place
            for choice in course.choices
            if (self._node in choice.nodes if self._node else choice.number == index + 1)
        ]
        return ", ".join(dict.fromkeys(found))

    def failure(self, index: int) -> str:
        """Return the reason why behaviour number ``index`` failed; empty if it has not failed."""
        tree, course = self.course.tree, self.course
        return (tree.failure(self._node) if tree is not None and self._node else "") or course.failures.get(
            index, course.remark
        )

    def cut_short(self, index: int) -> Verdict | None:
        """Return the verdict on behaviour number ``index`` if it had not ended when the execution was stopped."""
        tree, course = self.course.tree, self.course
        if tree is not None and self._node:
            return None if tree.is_over(self._node) else course.cut_short
        over = index in course.failures or (course.failed and index not in course.begun)
        return None if over else course.cut_short

    @property
    def _begun(self) -> bool:
        tree = self.course.tree
        return tree is None or not self._node or tree.has_begun(self._node)

    def _unreached(self) -> str:
        tree = self.course.tree
        if tree is None or self._begun or not self.course.finished:
            return ""
        return tree.unreached(self._node, self.course.remark)


def _names_of(events: Mapping[str, str]) -> dict[str, list[str]]:
    """Invert event → emitter to emitter → events."""
    names: dict[str, list[str]] = {}
    for event, emitters in events.items():
        for emitter in each_emitter(emitters):
            names.setdefault(emitter, []).append(event)
    return names
