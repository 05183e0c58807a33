"""One scenario while behave executes it: its simulation, and the verdicts on its clauses."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from itertools import chain
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

from robbdd_tools.agent.clause_debugger import current_pauses
from robbdd_tools.agent.clause_watch import WatchedClauses
from robbdd_tools.agent.execution import Execution
from robbdd_tools.agent.feature_wording import remarks_on_wording
from robbdd_tools.agent.printed_output import finish_output
from robbdd_tools.agent.shared_executions import SharedExecutions, calls_in_order, calls_of, timing_of
from robbdd_tools.judging.decisions import decide, is_closed, no_step, occurred
from robbdd_tools.judging.margin_curves import behaviour_curves, curves, write_curves
from robbdd_tools.judging.margin_ranges import margin_ranges
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.judging.scenario_clauses import (
    clause_of,
    is_free_text,
    iteration_of,
    iteration_of_event,
    judged_clause,
    named_predicates,
    stated_by_step,
)
from robbdd_tools.judging.unnamed_contacts import unnamed_contacts
from robbdd_tools.monitor.verdict import Cause, Outcome, Verdict, unknown
from robbdd_tools.monitor.without_physics import NO_CONTACTS
from robbdd_tools.protocol.clauses import BehaviourCall, EventOccurrence, Fluent, Junction, Text
from robbdd_tools.protocol.messages import (
    VIEWER,
    ClauseJudged,
    ClauseStarted,
    LogLine,
    ScenarioFinished,
    ScenarioStarted,
    UserCodeFailed,
    judged,
)
from robbdd_tools.protocol.run_folder import curves_file, trace_file
from robbdd_tools.protocol.specs import PROBE
from robbdd_tools.protocol.time_words import WORDING
from robbdd_tools.traces.codec import Evidence
from robbdd_tools.traces.mcap_file import write_trace
from robbdd_tools.user_code.calls import fault_of
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.log_views import verdict_views, views
from robbdd_tools.world.mesh_pieces import CUT
from robbdd_tools.world.model_meshes import hollow_scenery
from robbdd_tools.world.space_remarks import space_remarks
from robbdd_tools.world.viewer import NoViewer, Viewer

if TYPE_CHECKING:
    from robbdd_tools.agent.behaviour_calls import Call
    from robbdd_tools.agent.channel import Channel
    from robbdd_tools.agent.violation_states import ViolationStates
    from robbdd_tools.monitor.contact import Contact
    from robbdd_tools.monitor.curve import Curve
    from robbdd_tools.monitor.trace import Trace
    from robbdd_tools.protocol.specs import ScenarioSpec


class ScenarioRun:
    """The current scenario.

    ``texts`` are its steps in order, each with its line, its role (given, when, then) and its sentence. ``keep`` is the
    run folder in which the trace is stored, if the trace is wanted.
    """

    def __init__(
        self,
        index: int,
        spec: ScenarioSpec,
        texts: Sequence[tuple[int, str, str]],
        channel: Channel,
        moments: ViolationStates,
        keep: Path | None = None,
        courses: SharedExecutions | None = None,
        wording: int = WORDING,
    ) -> None:
        self._index = index
        self._spec = spec
        self._channel = channel
        self._moments = moments
        self._open = {clause.line: clause.sentence for clause in spec.clauses}
        self._known = {clause.line: clause for clause in spec.clauses}
        self._wording = wording
        named = named_predicates(clause.statement for clause in spec.clauses)
        steps = {
            line: stated_by_step(role, text, self._known.get(line), wording, named, spec.scene)
            for line, role, text in texts
        }
        self._calls = {line: step for line, step in steps.items() if isinstance(step, BehaviourCall)}
        self._events = {line: step.event for line, step in steps.items() if isinstance(step, EventOccurrence)}
        self._texts = {line for line, _, text in texts if is_free_text(steps[line], text)}
        self._clauses = {
            line: judged_clause(step, self._known.get(line), spec)
            for line, step in steps.items()
            if isinstance(step, Fluent | Text | Junction)
        }
        self._probes = {clause.line: clause_of(clause, spec) for clause in spec.clauses if clause.role == PROBE}
        self._clauses |= self._probes
        self._execution: Execution | None = None
        self._viewer: Viewer | None = None
        self._keep = keep
        self._courses = courses or SharedExecutions()
        self._verdicts: list[ClauseJudged] = []
        self._broken: SceneError | None = None
        self._faults: set[str] = set()
        self._begun_clauses: set[int] = set()
        self._pauses, self._watched = current_pauses(), WatchedClauses(self._clauses, self._calls, self._events)
        self._began = perf_counter()
        channel.send(ScenarioStarted(index))
        edited = [text for line, _, text in texts if text != self._open.get(line)]
        for remark in remarks_on_wording(edited, wording):
            channel.send(LogLine("warning", f"{spec.name}: {remark}"))

    def set_up(self) -> None:
        """Build the scene, unless it is already built. Raises ``SceneError``."""
        if self._broken:
            raise self._broken
        if self._execution is None:
            try:
                calls = self._own_calls() if self._spec.tree is None else calls_of(self._spec)
                timing = timing_of(self._spec, self._clauses.values())
                course = self._courses.course(self._spec, calls, timing)
                self._execution = Execution(self._spec, calls, timing, course)
                again = self._execution.simulation.world.resampled
                if again and not self._execution.simulated:
                    text = f"{self._spec.name}: {again} initial places overlapped and were resampled"
                    self._channel.send(LogLine("info", text))
                self._report_cast(self._execution)
                self._show(self._execution)
                self._pauses.begin(self._index, self._spec, self._watched, self._execution)
            except SceneError as error:
                self._broken = error
                raise

    def _own_calls(self) -> list[Call]:
        """Return the behaviours of the feature's steps. Raises ``SceneError``."""
        steps = {**self._calls, **{line: EventOccurrence(event) for line, event in self._events.items()}}
        return calls_in_order((steps[line], self._known.get(line)) for line in sorted(steps))

    def _report_cast(self, execution: Execution) -> None:
        """Report each element once that is not simulated, that has an unspecific model, or that nothing can touch."""
        world = execution.simulation.world
        cast = world.cast
        remarks = dict.fromkeys(cast.left_out, "not simulated, as no clause uses them and no .scenex places them")
        remarks |= dict.fromkeys(world.no_room, "not simulated, as no clause uses them and there is no room for them")
        for name, model in cast.objects.items():
            if model.unspecific:
                remarks[name] = f"simulated as '{model.name}' of the catalog, as their names say nothing more"
        for name in () if cast.staging is None else cast.staging.untouchable:
            remarks[name] = "no collision shapes in the model of the whole scene, so everything passes through"
        hollow = {} if cast.staging is None else dict(cast.staging.hollow) | hollow_scenery(execution.simulation.model)
        for name, share in hollow.items():
            remarks[name] = f"a hollow mesh, which collides as its convex hull with {share:.1f} times its volume; {CUT}"
        remarks |= dict(space_remarks(self._spec.scene, cast))
        new: dict[str, list[str]] = {}
        for name, remark in remarks.items():
            if name not in self._courses.reported:
                new.setdefault(remark, []).append(name)
        self._courses.reported.update(remarks)
        for remark, names in new.items():
            self._channel.send(LogLine("warning", f"{remark}: {', '.join(names)}"))

    def _show(self, execution: Execution) -> None:
        """Open a viewer window if it is requested. A failure does not affect verdicts."""
        if os.environ.get(VIEWER):
            try:
                self._viewer = Viewer(execution.simulation)
            except NoViewer as error:
                self._channel.send(LogLine("warning", str(error)))

    def clause(self, line: int, text: str) -> Verdict:
        """Simulate as far as is necessary to judge a Given or Then clause, and judge it."""
        clause = self._clauses.get(line) or read_clause(text, self._wording)

        def verdict(execution: Execution) -> Verdict:
            events = self._spec.events.keys()
            trace = execution.advance_until(lambda trace: is_closed(clause, trace, events))
            if execution.broken:
                return _broken(execution)
            return decide(clause, execution.measured(clause, trace), execution.regions, events)

        return self._judged(line, text, verdict)

    def behaviour(self, line: int, text: str) -> Verdict:
        """Simulate to the end of a behaviour. The clause holds if the behaviour has succeeded."""
        index = list(self._calls).index(line) if line in self._calls else None

        def verdict(execution: Execution) -> Verdict:
            if index is None:
                return unknown(no_step(text), Cause.NO_STEP)
            done, place = execution.run_behaviour(index), execution.chosen(index)
            if done and not execution.simulation.has_physics:
                return unknown(f"executed as commanded; {NO_CONTACTS}", Cause.UNOBSERVED)
            if done:
                return Verdict(Outcome.HOLDS, reason=f"placed at {place}" if place else "")
            if execution.broken:
                return _broken(execution)
            if execution.trace.unreached:
                return unknown(execution.trace.unreached, Cause.UNREACHED)
            stopped = execution.cut_short(index)
            if stopped is not None:
                return stopped
            chosen = f" (the chosen place was {place})" if place else ""
            return Verdict(Outcome.VIOLATED, reason=execution.failure(index) + chosen)

        return self._judged(line, text, verdict)

    def event(self, line: int, text: str) -> Verdict:
        """Simulate until the event of a When step has occurred."""
        event = self._events.get(line, text)
        iteration = iteration_of_event(event, self._known.get(line), self._spec)

        def verdict(execution: Execution) -> Verdict:
            if event not in self._spec.events:
                return unknown(f"nothing in the scenario emits event {event}", Cause.NO_EMITTER)
            trace = execution.advance_until(lambda trace: trace.event_time(event, iteration) is not None)
            return occurred(trace, event, iteration)

        return self._judged(line, text, verdict)

    def step_started(self, line: int) -> None:
        """Report that the judgement of a clause begins, unless this is reported already."""
        if line in self._open and line not in self._begun_clauses:
            self._begun_clauses.add(line)
            self._channel.send(ClauseStarted(self._index, line))

    def set_step_verdict(self, line: int, verdict: Verdict) -> None:
        """Record the verdict of a user's step, unless its clause already has a verdict."""
        self._report(line, verdict)

    def finish(self) -> None:
        """Report the scenario as finished.

        First judge probes, and texts with a policy or with the words of a predicate's phrase. Open clauses are unknown.
        """
        for line, sentence in list(self._open.items()):
            # behave has no step for these texts and for probes.
            if line in self._probes or (line in self._texts and isinstance(self._clauses[line], Fluent)):
                self.clause(line, sentence)
        for line, sentence in list(self._open.items()):
            left = unknown(no_step(sentence), Cause.NO_STEP)
            self._report(line, _unknown(self._broken) if self._broken else left)
        execution = self._execution
        if self._viewer is not None:
            self._viewer.close()
        if execution is not None:
            self._report_ranges(execution)
        if execution is not None and self._keep is not None:
            self._write_trace(execution, self._keep)
        simulated = execution.simulated if execution is not None else 0.0
        stepping = execution.stepping if execution is not None else 0.0
        resampled = execution.simulation.world.resampled if execution is not None else 0
        wall = perf_counter() - self._began - self._pauses.waited
        finish_output()
        contacts = () if execution is None else self._contacts(execution)
        self._channel.send(ScenarioFinished(self._index, round(simulated, 6), wall, stepping, resampled, contacts))
        self._pauses.end()

    def _contacts(self, execution: Execution) -> tuple[Contact, ...]:
        trace = execution.complete(execution.trace)
        return unnamed_contacts(self._clauses.values(), trace, execution.regions)

    def _report_ranges(self, execution: Execution) -> None:
        """Report the margin ranges of the whole execution. They are used to find clauses that could not have failed."""
        for line, clause in self._clauses.items():
            known = self._known.get(line)
            if known is None:
                continue
            trace = execution.measured(clause, execution.trace)
            found = margin_ranges(self._index, clause, known, self._spec, trace, execution.regions)
            if found is not None:
                self._channel.send(found)

    def _write_trace(self, execution: Execution, folder: Path) -> None:
        trace = execution.complete(execution.trace)
        seen = chain(views(execution.simulation, trace), verdict_views(self._spec, self._verdicts, trace.end))
        try:
            write_trace(trace_file(folder, self._index), Evidence(trace, execution.regions), seen)
            found = dict(self._curves(execution, trace))
            write_curves(curves_file(folder, self._index), (self._spec.variant, self._spec.variation), found, trace)
        except (OSError, TypeError) as error:
            reason = getattr(error, "strerror", None) or error
            self._channel.send(LogLine("warning", f"{self._spec.name}: the trace is not kept: {reason}"))

    def _curves(self, execution: Execution, trace: Trace) -> Iterator[tuple[int, tuple[Curve, ...]]]:
        for line in (clause.line for clause in self._spec.clauses):
            if line in self._clauses:
                yield line, tuple(curves(self._clauses[line], trace, execution.regions))
            elif line in self._calls:
                iteration = iteration_of(self._known[line])
                yield line, behaviour_curves(self._calls[line], trace, self._spec.events, self._spec.node, iteration)

    def _judged(self, line: int, text: str, verdict: Callable[[Execution], Verdict]) -> Verdict:
        self.step_started(line)
        self._pauses.step(line)
        try:
            self.set_up()
        except SceneError as error:
            found = _unknown(error)
        else:
            assert self._execution is not None
            try:
                found = verdict(self._execution)
            except Exception as error:  # users' code may be called; its failure affects only this clause
                fault = fault_of(error, text)
                found = unknown(f"the step failed: {fault.summary}", Cause.USER_CODE, fault=fault)
        self._report(line, found)
        return found

    def _report(self, line: int, verdict: Verdict) -> None:
        if self._open.pop(line, None) is None:
            return
        if verdict.outcome is Outcome.VIOLATED and self._execution is not None:
            # A failed behaviour has ended just now.
            at = self._execution.trace.end if verdict.at is None and line in self._calls else verdict.at
            if at is not None:
                self._moments.keep(self._index, line, at, self._execution.state_at(at))
        if verdict.fault is not None and verdict.fault.id not in self._faults:
            self._faults.add(verdict.fault.id)
            self._channel.send(UserCodeFailed(self._index, verdict.fault))
        message = judged(self._index, line, verdict)
        self._verdicts.append(message)
        self._channel.send(message)
        self._pauses.judged(message)


def _unknown(error: SceneError) -> Verdict:
    return unknown(str(error), Cause.SCENE if error.fault is None else Cause.USER_CODE, fault=error.fault)


def _broken(execution: Execution) -> Verdict:
    cause = Cause.SCENE if execution.fault is None else Cause.USER_CODE
    return unknown(execution.broken, cause, fault=execution.fault)
