"""Write a stored run as Cucumber Messages, one JSON object per line, for reports of the Cucumber world."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from datetime import datetime
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

from robbdd_tools import __version__
from robbdd_tools.base.printable import printable
from robbdd_tools.campaign.message_features import MessageCase, MessageFeature, message_types
from robbdd_tools.campaign.report_moments import Moments, first_violation
from robbdd_tools.campaign.report_source import run_report
from robbdd_tools.monitor.verdict import Cause, Outcome
from robbdd_tools.run.plot import plot
from robbdd_tools.run.report import margin
from robbdd_tools.run.stored_results import execution_ends, starts

if TYPE_CHECKING:
    from robbdd_tools.campaign.report_moments import Moment
    from robbdd_tools.campaign.report_source import ReportSource
    from robbdd_tools.workbench.execution_rows import ClauseResult, ExecutionResult
    from robbdd_tools.workbench.stored import PastRun

LOG = "text/x.cucumber.log+plain"
"""The media type of text that Cucumber's reports show below a step."""
NOT_RECORDED = "not recorded"
_NANOSECONDS = 1_000_000_000


def write_messages(run: PastRun) -> tuple[str, int, str]:
    """Return a run as Cucumber Messages, the number of executions, and the reason why there are no pictures.

    All times are those that the run has recorded, so the same run gives the same text. An execution is a test case, a
    clause a step with its margin, its reason, its picture and the plot of its margin as attachments. Raises
    ``NoMessages`` and ``NoSuchRun``.
    """
    messages = message_types()
    source = run_report(run)
    moments = Moments()
    seen = moments.add(run.place, [one for one in source.results if one.verdict is Outcome.VIOLATED])
    export = _Export(run, source, seen)
    lines = (json.dumps(messages.message_converter.to_dict(one), ensure_ascii=False) for one in export.envelopes())
    return "".join(f"{line}\n" for line in lines), len(source.results), moments.problem


@dataclass(frozen=True, slots=True)
class _Times:
    """The recorded times of an execution in ns since 1970."""

    start: int
    end: int


class _Export:
    def __init__(self, run: PastRun, source: ReportSource, moments: Mapping[int, Moment]) -> None:
        from gherkin.stream.id_generator import IdGenerator

        self._run = run
        self._source = source
        self._moments = moments
        self._specs = run.place.manifest().scenarios
        self._ids = IdGenerator()
        self._began = _nanoseconds(starts(run.place.database).get(run.number, ""))
        self._ends = execution_ends(run.place.database, run.number)

    def envelopes(self) -> Iterator[Any]:
        """Yield the messages of the run in the order that the protocol demands."""
        messages = message_types()
        record = self._run.record
        yield messages.Envelope(
            meta=messages.Meta(
                cpu=messages.Product(NOT_RECORDED),
                implementation=messages.Product("robbdd", record.version or __version__),
                os=messages.Product(NOT_RECORDED),
                protocol_version=version("cucumber-messages"),
                runtime=messages.Product(record.simulator or NOT_RECORDED),
            )
        )
        cases: dict[int, MessageCase] = {}
        for name in dict.fromkeys(spec.feature for spec in self._specs):
            chosen = [number for number, spec in enumerate(self._specs) if spec.feature == name]
            feature = MessageFeature(self._run.folder, name, [self._specs[number] for number in chosen], self._ids)
            yield from feature.envelopes()
            cases.update(zip(chosen, feature.cases, strict=True))
        ordered = [cases[number] for number in sorted(cases)]
        for case in ordered:
            yield {"pickle": case.pickle}
        started = self._ids.get_next_id()
        yield messages.Envelope(test_run_started=messages.TestRunStarted(_timestamp(self._began), id=started))
        for case in ordered:
            yield messages.Envelope(test_case=case.test_case(started))
        last = self._began
        for case, result in zip(ordered, self._source.results, strict=True):
            times = self._times(result)
            last = max(last, times.end)
            yield from self._executed(case, result, times)
        success = all(one.verdict is Outcome.HOLDS for one in self._source.results)
        finished = messages.TestRunFinished(success, _timestamp(last), test_run_started_id=started)
        yield messages.Envelope(test_run_finished=finished)

    def _times(self, result: ExecutionResult) -> _Times:
        ended, wall = self._ends.get(result.index, ("", 0.0))
        end = _nanoseconds(ended) or self._began
        return _Times(end - round(wall * _NANOSECONDS), end)

    def _executed(self, case: MessageCase, result: ExecutionResult, times: _Times) -> Iterator[Any]:
        messages = message_types()
        attempt = self._ids.get_next_id()
        start = messages.TestCaseStarted(0, attempt, case.identifier, _timestamp(times.start))
        yield messages.Envelope(test_case_started=start)
        by_line = dict(zip((one.line for one in case.spec.clauses), result.clauses, strict=False))
        moment, violation = self._moments.get(result.index), first_violation(result)
        curves, _ = self._source.curves(result)
        codings = messages.AttachmentContentEncoding
        for step, line in case.steps:
            clause = by_line.get(line)
            began = messages.TestStepStarted(attempt, step, _timestamp(times.start))
            yield messages.Envelope(test_step_started=began)
            for body, name, kind in _attachments(
                clause,
                moment if violation is not None and clause is violation[1] else None,
                plot(curves, line, clause.operand)
                if curves and clause and clause.verdict is Outcome.VIOLATED
                else None,
            ):
                coding = codings.base64 if name else codings.identity
                found = messages.Attachment(
                    body, coding, kind, name or None, test_case_started_id=attempt, test_step_id=step
                )
                yield messages.Envelope(attachment=found)
            done = messages.TestStepFinished(attempt, step, _result(clause, result), _timestamp(times.start))
            yield messages.Envelope(test_step_finished=done)
        end = messages.TestCaseFinished(attempt, _timestamp(times.end), will_be_retried=False)
        yield messages.Envelope(test_case_finished=end)


def _result(clause: ClauseResult | None, result: ExecutionResult) -> Any:
    """Return the result of a step. A step without a clause sets up the scene: it passed if the execution finished."""
    messages = message_types()
    status = messages.TestStepResultStatus
    none = messages.Duration(0, 0)
    if clause is None:
        return messages.TestStepResult(none, status.passed if result.duration is not None else status.unknown)
    if clause.verdict is Outcome.HOLDS:
        return messages.TestStepResult(none, status.passed)
    words = f"{clause.verdict}{f' by {shown}' if (shown := margin(clause.margin, clause.unit)) else ''}"
    words = f"{words}: {clause.reason}" if clause.reason else words
    is_open = status.undefined if clause.cause is Cause.NO_STEP else status.unknown
    found = status.failed if clause.verdict is Outcome.VIOLATED else is_open
    return messages.TestStepResult(none, found, message=printable(words))


def _attachments(
    clause: ClauseResult | None, moment: Moment | None, drawn: str | None
) -> Iterator[tuple[str, str, str]]:
    """Yield the attachments of a step: content, file name and media type. Only files have a name, and are in Base64."""
    if clause is None:
        return
    instant = clause.at if clause.worst_at is None else clause.worst_at
    at = f" at {instant:.2f} s" if instant is not None else ""
    measured = margin(clause.margin, clause.unit)
    words = [f"margin {measured}{at}"] if measured else []
    words += [clause.reason] if clause.reason else []
    words += [f"proves little: {clause.vacuous}"] if clause.vacuous else []
    if words:
        yield printable("; ".join(words)), "", LOG
    if moment is not None and moment.picture:
        yield moment.picture.partition(",")[2], "violation.png", "image/png"
    if drawn:
        yield b64encode(drawn.encode()).decode("ascii"), "margin.svg", "image/svg+xml"


def _timestamp(nanoseconds: int) -> Any:
    messages = message_types()
    seconds, rest = divmod(nanoseconds, _NANOSECONDS)
    return messages.Timestamp(rest, seconds)


def _nanoseconds(time: str) -> int:
    """Return a time (ISO 8601) in ns since 1970; 0 if there is none."""
    try:
        return round(datetime.fromisoformat(time).timestamp() * 1_000_000) * 1000
    except ValueError:
        return 0
