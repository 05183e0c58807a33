"""``python -m robbdd_tools.agent.judge_log FOLDER``: judge the scenario of a run folder by a log.

The folder's manifest has one scenario, and its ``LOG_REQUEST`` names the log. The process writes the same messages as
the agent, and keeps the trace and the margins as a simulated execution does.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Generator, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import chain
from pathlib import Path
from time import perf_counter

from robbdd_tools.agent.channel import Reports
from robbdd_tools.agent.log_evidence import LogEvidence, evidence_of
from robbdd_tools.agent.log_following import growing_contents, is_decided
from robbdd_tools.agent.printed_output import Printed, finish_output
from robbdd_tools.agent.stack_dumps import install
from robbdd_tools.agent.standard_streams import reserve_channel
from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import load_text
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.base.plain import from_plain
from robbdd_tools.catalog.coordination import END, EXTERNAL, emitter
from robbdd_tools.judging.decisions import decide, occurred
from robbdd_tools.judging.log_executions import check_one_execution
from robbdd_tools.judging.margin_curves import behaviour_curves, curves, write_curves
from robbdd_tools.judging.margin_ranges import margin_ranges
from robbdd_tools.judging.scenario_clauses import clause_of, iteration_of, iteration_of_event, statement_of
from robbdd_tools.logs.log_contents import LogContents
from robbdd_tools.logs.log_names import check_events
from robbdd_tools.logs.log_period import cut
from robbdd_tools.logs.log_table import read_events
from robbdd_tools.logs.open_log import read_log
from robbdd_tools.monitor.curve import Curve
from robbdd_tools.monitor.time import occurrences
from robbdd_tools.monitor.trace import Trace
from robbdd_tools.monitor.verdict import Cause, Outcome, Verdict, unknown
from robbdd_tools.protocol.clauses import BehaviourCall, EventOccurrence, Fluent, Junction, fluents_of
from robbdd_tools.protocol.event_signals import read_event_signal
from robbdd_tools.protocol.log_request import LOG_REQUEST, LogRequest
from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.protocol.messages import (
    ClauseJudged,
    LogLine,
    RunFinished,
    RunMessage,
    RunStarted,
    ScenarioFinished,
    ScenarioStarted,
    UserCodeFailed,
    judged,
)
from robbdd_tools.protocol.run_folder import curves_file, trace_file
from robbdd_tools.protocol.specs import ClauseSpec, Manifest, ScenarioSpec
from robbdd_tools.traces.codec import Evidence
from robbdd_tools.traces.mcap_file import write_trace
from robbdd_tools.user_code.calls import UserCodeError
from robbdd_tools.world.composition import compile_objects
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.log_views import observed_views, verdict_views


def _messages(manifest: Manifest, request: LogRequest, folder: Path) -> Iterator[RunMessage]:
    spec = _with_reported_events(*manifest.scenarios)
    began = perf_counter()
    whole = _contents(request, spec) if request.quiet is None else None
    yield RunStarted(1, f"log {Path(request.path).name}")
    yield ScenarioStarted(0)
    early: dict[int, ClauseJudged] = {}
    contents = (yield from _follow(request, spec, early)) if whole is None else whole
    try:
        found = evidence_of(spec, contents, request)
    except (SceneError, UserCodeError) as error:
        cause = Cause.SCENE
        if isinstance(error, UserCodeError):
            cause = Cause.USER_CODE
            yield UserCodeFailed(0, error.fault)
        for clause in spec.clauses:
            yield judged(0, clause.line, unknown(str(error), cause))
        yield ScenarioFinished(0, contents.end, perf_counter() - began, 0.0)
        yield RunFinished(True)
        return
    for remark in found.remarks:
        yield LogLine("info", remark)
    faults: set[str] = set()
    verdicts: list[ClauseJudged] = []
    for clause in spec.clauses:
        verdict = verdict_on(clause, found.evidence, spec)
        if verdict.fault is not None and verdict.fault.id not in faults:
            faults.add(verdict.fault.id)
            yield UserCodeFailed(0, verdict.fault)
        verdicts.append(judged(0, clause.line, verdict))
        before = early.get(clause.line)
        if verdicts[-1] != before:
            yield verdicts[-1]
        if before is not None and before.verdict != verdicts[-1].verdict:
            yield LogLine("warning", f"{clause.sentence}: later messages changed the verdict '{before.verdict}'")
        if clause.role != "when":
            trace, regions = found.evidence.trace, found.evidence.regions
            ranges = margin_ranges(0, clause_of(clause, spec), clause, spec, trace, regions)
            if ranges is not None:
                yield ranges
    _keep(folder, spec, found, verdicts)
    finish_output()
    yield ScenarioFinished(0, round(found.evidence.trace.end, 6), perf_counter() - began, 0.0)
    yield RunFinished(True)


def _with_reported_events(spec: ScenarioSpec) -> ScenarioSpec:
    """Return a scenario with the events of its clauses that nothing in it emits: a log may report them."""
    clauses = [one for one in map(statement_of, spec.clauses) if isinstance(one, Fluent | Junction)]
    named = [event for one in clauses for fluent in fluents_of(one) for event, _ in occurrences(fluent.time)]
    return replace(spec, events={**dict.fromkeys(named, EXTERNAL), **spec.events})


def _contents(request: LogRequest, spec: ScenarioSpec) -> LogContents:
    signals = tuple(map(read_event_signal, request.signals))
    check_events([one.event for one in signals], spec)
    return _completed(read_log(Path(request.path), request.columns, request.clocks, signals), request, spec)


def _completed(contents: LogContents, request: LogRequest, spec: ScenarioSpec) -> LogContents:
    """Return the contents of a log with the events that the user adds, in the period that the user chooses."""
    if request.annotations:
        texts = sorted((*contents.texts, *read_events(Path(request.annotations))), key=lambda stamp: stamp.time)
        contents = replace(contents, texts=tuple(texts))
    if request.begin is None and request.end is None:
        check_one_execution(spec, contents.texts)
        return contents
    return cut(contents, request.begin or 0.0, request.end)


def _follow(
    request: LogRequest, spec: ScenarioSpec, early: dict[int, ClauseJudged]
) -> Generator[RunMessage, None, LogContents]:
    """Yield the verdicts that are decided while a log is recorded, and return its contents in the end.

    ``early`` gets these verdicts by line.
    """
    check_events([read_event_signal(one).event for one in request.signals], spec)
    contents = LogContents({})
    for contents in growing_contents(request):
        with suppress(RobbddError, SceneError, UserCodeError):
            # A topic that the user names does not exist before its first message.
            evidence = evidence_of(spec, _completed(contents, request, spec), request).evidence
            for clause in spec.clauses:
                if clause.line not in early and is_decided(clause, spec, evidence.trace):
                    early[clause.line] = judged(0, clause.line, verdict_on(clause, evidence, spec))
                    yield early[clause.line]
    return _completed(contents, request, spec)


def verdict_on(clause: ClauseSpec, evidence: Evidence, spec: ScenarioSpec) -> Verdict:
    """Return the verdict on a clause of a scenario by the evidence of a log."""
    statement, trace = statement_of(clause), evidence.trace
    if isinstance(statement, EventOccurrence):
        return occurred(trace, statement.event, iteration_of_event(statement.event, clause, spec))
    if isinstance(statement, BehaviourCall):
        return _reported(statement, clause, trace, spec)
    return decide(clause_of(clause, spec), trace, evidence.regions, spec.events.keys())


def _reported(call: BehaviourCall, clause: ClauseSpec, trace: Trace, spec: ScenarioSpec) -> Verdict:
    """Return the verdict on a behaviour. It holds if the log reports its last event."""
    last = call.behaviour.events[-1]
    names = [event for event, source in spec.events.items() if source in (last, emitter(spec.node, END))]
    names = [call.end] if call.part else names
    times = [time for name in names if (time := trace.event_time(name, iteration_of(clause))) is not None]
    if not times:
        return unknown(f"the log does not report the end of the behaviour, '{last}'", Cause.NO_EVENT)
    return Verdict(Outcome.HOLDS, at=min(times), reason=f"the log reports '{last}'")


def _keep(folder: Path, spec: ScenarioSpec, found: LogEvidence, verdicts: Sequence[ClauseJudged]) -> None:
    evidence, trace = found.evidence, found.evidence.trace
    seen = observed_views(compile_objects(found.cast), evidence.regions, trace)
    write_trace(trace_file(folder, 0), evidence, chain(seen, verdict_views(spec, verdicts, trace.end)))
    by_line: dict[int, tuple[Curve, ...]] = {}
    for clause in spec.clauses:
        statement = statement_of(clause)
        if isinstance(statement, BehaviourCall):
            by_line[clause.line] = behaviour_curves(statement, trace, spec.events, spec.node, iteration_of(clause))
        elif clause.role != "when":
            by_line[clause.line] = tuple(curves(clause_of(clause, spec), trace, evidence.regions))
    write_curves(curves_file(folder, 0), (spec.variant, spec.variation), by_line, trace)


def _main() -> int:
    channel = Reports(reserve_channel()[1])
    install()
    sys.stdout = Printed(channel, sys.stdout)
    folder = Path(sys.argv[1])
    try:
        request = from_plain(LogRequest, json.loads(load_text(folder / LOG_REQUEST, RESULT_SIZE)))
        for message in _messages(read_manifest(folder), request, folder):
            channel.send(message)
    except (RobbddError, OSError, ValueError, KeyError, TypeError) as error:
        channel.send(LogLine("error", str(error)))
        channel.send(RunFinished(False))
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(_main())
