"""``python -m robbdd_tools.agent.rejudge FOLDER RUN``: judge stored traces by other clauses, without simulating.

FOLDER is a run folder. It contains the scenarios to judge and the results of the stored run RUN, which has the traces.
The process writes the same messages as the agent.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.agent.channel import Reports
from robbdd_tools.agent.printed_output import Printed, finish_output
from robbdd_tools.agent.stack_dumps import install
from robbdd_tools.agent.standard_streams import reserve_channel
from robbdd_tools.base.files import load_text
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.catalog.coordination import DEFINED
from robbdd_tools.judging.decisions import decide, occurred
from robbdd_tools.judging.defined_events import with_defined_events
from robbdd_tools.judging.margin_ranges import margin_ranges
from robbdd_tools.judging.scenario_clauses import clause_of, iteration_of_event, statement_of
from robbdd_tools.judging.unnamed_contacts import unnamed_contacts
from robbdd_tools.monitor.contact import Contact
from robbdd_tools.monitor.time import TOLERANCE, After, Before, TimeConstraint, occurrences
from robbdd_tools.monitor.verdict import Cause, Outcome, Verdict, unknown
from robbdd_tools.protocol.clauses import EventOccurrence, fluents_of
from robbdd_tools.protocol.manifest_file import STORED_RESULTS, read_manifest
from robbdd_tools.protocol.messages import (
    LogLine,
    MarginRanges,
    RunFinished,
    RunMessage,
    RunStarted,
    ScenarioFinished,
    ScenarioStarted,
    UserCodeFailed,
    judged,
)
from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.protocol.spec_changes import AGAIN, CHANGED, change_of
from robbdd_tools.protocol.specs import ClauseSpec, Manifest, ScenarioSpec, scenario_key
from robbdd_tools.traces.codec import Evidence
from robbdd_tools.traces.mcap_file import UnreadableTrace, read_trace

if TYPE_CHECKING:
    from robbdd_tools.monitor.trace import Trace

UNKNOWN_SCENARIO = "the stored run has no scenario with these values"


class StoredTraces:
    """The traces of a run, and its verdicts on behaviours. Raises ``OSError``, ``ValueError`` or ``KeyError``."""

    def __init__(self, folder: Path, results: Path) -> None:
        self._folder = folder
        manifest = read_manifest(folder)
        self._specs = {scenario_key(spec): (index, spec) for index, spec in enumerate(manifest.scenarios)}
        self._results: list[Mapping[str, Any]] = json.loads(load_text(results, RESULT_SIZE))["scenarios"]

    def judged(self, spec: ScenarioSpec) -> Iterator[tuple[ClauseSpec, Verdict]]:
        """Yield the verdicts on the clauses of a scenario."""
        index, stored = self._specs.get(scenario_key(spec), (0, None))
        if stored is None:
            yield from ((clause, unknown(UNKNOWN_SCENARIO, Cause.CHANGED)) for clause in spec.clauses)
            return
        found = self._evidence(index, spec, stored)
        for clause in spec.clauses:
            if isinstance(found, Verdict):
                yield clause, found
            elif _is_behaviour(clause):
                yield clause, self._done(clause, index, spec, stored)
            else:
                yield clause, decided_on_trace(clause, found, replace(spec, seed=stored.seed), stored.events)

    def _evidence(self, index: int, spec: ScenarioSpec, stored: ScenarioSpec) -> Evidence | Verdict:
        """Return the trace of an execution. If there is no usable trace, return the verdict on all its clauses."""
        reason = change_of(spec, stored)
        if reason:
            return unknown(reason, Cause.CHANGED)
        try:
            return with_own_events(read_trace(trace_file(self._folder, index)), spec)
        except UnreadableTrace as error:
            return unknown(str(error), Cause.NO_RECORD)

    def duration(self, spec: ScenarioSpec) -> float:
        """Return the simulated time (s) of the stored execution of a scenario; 0 if there is none."""
        index, stored = self._specs.get(scenario_key(spec), (0, None))
        return 0.0 if stored is None else self._results[index].get("duration") or 0.0

    def ranges(self, number: int, spec: ScenarioSpec) -> Iterator[MarginRanges]:
        """Yield the margin ranges in the trace of scenario ``number``.

        They are used to find clauses that prove little.
        """
        index, stored = self._specs.get(scenario_key(spec), (0, None))
        if stored is None or change_of(spec, stored):
            return
        try:
            evidence = with_own_events(read_trace(trace_file(self._folder, index)), spec)
        except UnreadableTrace:
            return
        for clause in (clause for clause in spec.clauses if clause.role != "when"):
            read = clause_of(clause, spec)
            found = margin_ranges(number, read, clause, spec, evidence.trace, evidence.regions)
            if found is not None:
                yield found

    def contacts(self, spec: ScenarioSpec) -> tuple[Contact, ...]:
        """Return the contacts in the trace of a scenario that its clauses do not name."""
        index, stored = self._specs.get(scenario_key(spec), (0, None))
        if stored is None:
            return ()
        try:
            evidence = read_trace(trace_file(self._folder, index))
        except UnreadableTrace:
            return ()
        clauses = [clause_of(clause, spec) for clause in spec.clauses if clause.role != "when"]
        return unnamed_contacts(clauses, evidence.trace, evidence.regions)

    def _done(self, clause: ClauseSpec, index: int, spec: ScenarioSpec, stored: ScenarioSpec) -> Verdict:
        """Return the stored verdict on a behaviour."""
        entry = _stored_behaviour(clause, spec, stored, self._results[index]["clauses"])
        if entry is None:
            return unknown(CHANGED.format("the behaviour"), Cause.CHANGED)
        return Verdict(Outcome(entry["verdict"]), entry["robustness"], entry["unit"], entry["at"], entry["reason"])


def with_own_events(evidence: Evidence, spec: ScenarioSpec) -> Evidence:
    """Return stored evidence with the events that the edited template defines."""
    trace = with_defined_events(evidence.trace, spec.defined, evidence.regions, numbered=not spec.node)
    return replace(evidence, trace=trace)


def _stored_behaviour(
    clause: ClauseSpec, spec: ScenarioSpec, stored: ScenarioSpec, results: Sequence[Mapping[str, Any]]
) -> Mapping[str, Any] | None:
    """Return the stored result of the same behaviour.

    It has the same number in both scenarios, because they execute the same behaviours in the same order.
    """
    then = [entry for one, entry in zip(stored.clauses, results, strict=True) if _is_behaviour(one)]
    now = [one for one in spec.clauses if _is_behaviour(one)]
    return then[now.index(clause)] if len(now) == len(then) else None


def _is_behaviour(clause: ClauseSpec) -> bool:
    return clause.role == "when" and not isinstance(statement_of(clause), EventOccurrence)


def decided_on_trace(
    clause: ClauseSpec, evidence: Evidence, spec: ScenarioSpec, recorded: Mapping[str, str]
) -> Verdict:
    """Return the verdict of a stored trace on a clause that is not a behaviour.

    ``recorded`` are the events of the stored execution with their emitters, as ``events`` of its scenario. ``spec`` is
    the edited scenario. It must have the ``seed`` of the execution, which determines the noise of observations.
    """
    trace, statement = evidence.trace, statement_of(clause)
    if isinstance(statement, EventOccurrence):
        event, iteration = statement.event, iteration_of_event(statement.event, clause, spec)
        return _unrecorded(event, spec, recorded) or occurred(trace, event, iteration)
    read = clause_of(clause, spec)
    for fluent in fluents_of(read):
        for event, iteration in occurrences(fluent.time):
            problem = _unrecorded(event, spec, recorded)
            if problem is not None:
                return problem
            # The run simulated only as far as its own clauses needed.
            if event in spec.events and not trace.finished and trace.event_time(event, iteration) is None:
                reason = f"the stored trace ends at {trace.end:.2f} s, before event {event}: {AGAIN}"
                return unknown(reason, Cause.NO_RECORD)
    found = decide(read, trace, evidence.regions, spec.events.keys())
    # A new run records as long as its clauses need.
    beyond = next(filter(None, (_beyond(fluent.time, trace) for fluent in fluents_of(read))), "")
    return unknown(beyond, Cause.NO_RECORD) if beyond and found.outcome is Outcome.UNKNOWN else found


def _beyond(time: TimeConstraint, trace: Trace) -> str:
    """Return the reason why a window is not within a trace; empty if it is, or if its event did not occur."""
    if not isinstance(time, After | Before) or time.which:
        return ""
    at, horizon = trace.event_time(time.event, time.iteration), time.horizon or 0.0
    if at is None:
        return ""
    if isinstance(time, After) and trace.end < at + horizon - TOLERANCE:
        return (
            f"the stored trace ends at {trace.end:.2f} s, before {at + horizon:.2f} s when the window closes: {AGAIN}"
        )
    if isinstance(time, Before) and at < horizon - TOLERANCE:
        return f"the stored trace begins {at:.2f} s before event {time.event}, not {horizon:g} s: {AGAIN}"
    return ""


def _unrecorded(event: str, spec: ScenarioSpec, recorded: Mapping[str, str]) -> Verdict | None:
    """Return the verdict on a clause if the stored execution did not record its event; otherwise ``None``."""
    own = spec.events.get(event)
    if own is not None and own != DEFINED and own != recorded.get(event):
        return unknown(f"the stored trace has no record of event {event}: {AGAIN}", Cause.NO_RECORD)
    return None


def _messages(manifest: Manifest, traces: StoredTraces) -> Iterator[RunMessage]:
    yield RunStarted(len(manifest.scenarios), "stored traces")
    for index, spec in enumerate(manifest.scenarios):
        yield ScenarioStarted(index)
        faults: set[str] = set()
        for clause, verdict in traces.judged(spec):
            if verdict.fault is not None and verdict.fault.id not in faults:
                faults.add(verdict.fault.id)
                yield UserCodeFailed(index, verdict.fault)
            yield judged(index, clause.line, verdict)
        yield from traces.ranges(index, spec)
        finish_output()
        yield ScenarioFinished(index, traces.duration(spec), 0.0, 0.0, contacts=traces.contacts(spec))
    yield RunFinished(True)


def _main() -> int:
    channel = Reports(reserve_channel()[1])
    install()
    sys.stdout = Printed(channel, sys.stdout)
    folder, run = map(Path, sys.argv[1:])
    try:
        for message in _messages(read_manifest(folder), StoredTraces(run, folder / STORED_RESULTS)):
            channel.send(message)
    except (OSError, ValueError, KeyError, TypeError) as error:
        channel.send(LogLine("error", f"{run} cannot be judged: {error}"))
        channel.send(RunFinished(False))
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(_main())
