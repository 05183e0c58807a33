"""Judge the clauses of a log during its recording, each when its window has closed."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.judging.scenario_clauses import clause_of, iteration_of, statement_of
from robbdd_tools.logs.growing_mcap import GrowingMcap
from robbdd_tools.logs.log_contents import LogContents, UnreadableLog
from robbdd_tools.monitor.time import After, Before, closing_time, occurrences
from robbdd_tools.protocol.clauses import BehaviourCall, EventOccurrence, Fluent, leaves_of
from robbdd_tools.protocol.event_signals import read_event_signal

if TYPE_CHECKING:
    from robbdd_tools.monitor.time import TimeConstraint
    from robbdd_tools.monitor.trace import Trace
    from robbdd_tools.protocol.log_request import LogRequest
    from robbdd_tools.protocol.specs import ClauseSpec, ScenarioSpec

LATE = 1.0
"""Messages of a window may arrive up to this time (s) after its end."""
OWN_EVALUATORS = "robbdd_tools.catalog."
PERIOD = 0.25
"""The file is read again after this time (s)."""


def growing_contents(request: LogRequest) -> Iterator[LogContents]:
    """Yield the contents of a log whenever it has grown, and finally the contents of the whole log.

    The log ends when the recorder has closed its file or has written nothing for ``request.quiet`` seconds. Raises
    ``UnreadableLog``, also for logs of other kinds than MCAP and rosbag2.
    """
    path = Path(request.path)
    if not path.is_dir() and path.suffix.lower() not in (".mcap", ".db3"):
        raise UnreadableLog(f"{path} cannot be followed: name the folder of a rosbag2, or an MCAP file")
    log = GrowingMcap(path, request.clocks, tuple(map(read_event_signal, request.signals)))
    last = time.monotonic()
    while not log.complete and time.monotonic() - last < (request.quiet or 0.0):
        if log.read():
            last = time.monotonic()
            yield replace(log.contents(), unfinished=True)
        time.sleep(PERIOD)
    log.read()
    if log.empty:
        raise UnreadableLog(f"{path} has no message yet: start the recorder first, or wait longer (--follow SECONDS)")
    log.check()
    found = log.contents()
    words = f"nothing was recorded for {request.quiet:g} s: the log is judged as far as it was written"
    yield found if log.complete else replace(found, unfinished=True, remarks=(words, *found.remarks))


def is_decided(known: ClauseSpec, spec: ScenarioSpec, trace: Trace) -> bool:
    """Return whether nothing that is recorded later can change the verdict of a clause.

    Only the end of the log decides a behaviour, a clause on all occurrences of an event or on the last one, and a
    clause that an observation policy judges.
    """
    statement = statement_of(known)
    if isinstance(statement, EventOccurrence):
        found = trace.event_time(statement.event, iteration_of(known))
        return found is not None and found + LATE <= trace.end
    if statement is None or isinstance(statement, BehaviourCall):
        return False
    leaves = list(leaves_of(clause_of(known, spec)))
    return all(isinstance(one, Fluent) and _is_ours(one) and _is_past(one.time, trace) for one in leaves)


def _is_ours(fluent: Fluent) -> bool:
    """Return whether only this package's evaluators judge a fluent: users' code must be called only once."""
    conditions = () if fluent.condition is None else (fluent.condition.predicate,)
    evaluators = [one.evaluate for one in (fluent.predicate, *conditions)]
    return all(getattr(one, "__module__", "").startswith(OWN_EVALUATORS) for one in evaluators)


def _is_past(constraint: TimeConstraint, trace: Trace) -> bool:
    if isinstance(constraint, Before | After) and constraint.which not in ("", "first"):
        return False
    if any(iteration < 0 for _, iteration in occurrences(constraint)):
        return False
    closed = closing_time(constraint, trace)
    return closed is not None and closed + LATE <= trace.end
