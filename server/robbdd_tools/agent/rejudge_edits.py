"""``python -m robbdd_tools.agent.rejudge_edits FOLDER``: judge edited clauses on stored traces, as ordered.

The process reads ``JudgeOrder`` objects from standard input. For each trace, it writes the verdicts on the clauses and
then ``ScenarioFinished``, both with the number that the order gives the trace. It keeps traces in memory, so that the
next edit is judged without reading them again. FOLDER is an empty folder for the files of the process.
"""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.agent.channel import Lines
from robbdd_tools.agent.execute_requests import read_requests
from robbdd_tools.agent.rejudge import decided_on_trace, with_own_events
from robbdd_tools.agent.standard_streams import reserve_channel
from robbdd_tools.monitor.verdict import Cause, Verdict, unknown
from robbdd_tools.protocol.judge_orders import JudgeOrder, StoredTrace, decode_order
from robbdd_tools.protocol.messages import LogLine, RunStarted, ScenarioFinished, judged
from robbdd_tools.traces.mcap_file import UnreadableTrace, read_trace

if TYPE_CHECKING:
    from robbdd_tools.agent.channel import Channel
    from robbdd_tools.traces.codec import Evidence

KEPT = 512 * 1024 * 1024
"""At most this many bytes of uncompressed trace files are kept in memory; other traces are read each time."""


@dataclass(frozen=True, slots=True)
class _Kept:
    """A trace in memory, with the state of its file when it was read and its size in bytes."""

    state: tuple[int, int]
    size: int
    evidence: Evidence


class Traces:
    """Stored traces. Traces of earlier runs are dropped when a later run needs the space."""

    def __init__(self, limit: int = KEPT) -> None:
        self._limit = limit
        self._kept: dict[Path, _Kept] = {}
        self._size = 0

    def read(self, path: Path) -> Evidence:
        """Return a trace. Raises ``UnreadableTrace``."""
        state = _state(path)
        known = self._kept.get(path)
        if known is not None and known.state == state:
            return known.evidence
        self._drop(path)
        evidence = read_trace(path)
        size = _size(evidence)
        for other in [one for one in self._kept if one.parent != path.parent]:
            if self._size + size > self._limit:
                self._drop(other)
        if self._size + size <= self._limit:
            self._kept[path] = _Kept(state, size, evidence)
            self._size += size
        return evidence

    def _drop(self, path: Path) -> None:
        known = self._kept.pop(path, None)
        self._size -= 0 if known is None else known.size


def _state(path: Path) -> tuple[int, int]:
    """Return the time of the last change and the size of a file; a new run may have the number of a deleted one."""
    try:
        found = path.stat()
    except OSError:
        return 0, 0
    return found.st_mtime_ns, found.st_size


def _size(evidence: Evidence) -> int:
    """Return the bytes of the large arrays of a trace."""
    trace = evidence.trace
    sampled = (trace.grips, trace.forces, trace.impulses, trace.reaches, trace.gaps, trace.joint_clearances)
    series = (array for record in sampled for array in record.values())
    return sum(array.nbytes for array in (trace.times, trace.positions, trace.orientations, *series))


def obey(order: JudgeOrder, traces: Traces, channel: Channel) -> None:
    """Judge the clauses of an order on its traces, and send the verdicts."""
    for stored in order.traces:
        for line, verdict in _verdicts(order, stored, traces):
            channel.send(judged(stored.index, line, verdict))
        channel.send(ScenarioFinished(stored.index, 0.0, 0.0, 0.0))


def _verdicts(order: JudgeOrder, stored: StoredTrace, traces: Traces) -> list[tuple[int, Verdict]]:
    clauses = order.spec.clauses
    try:
        spec = replace(order.spec, seed=stored.seed)
        evidence = with_own_events(traces.read(Path(stored.path)), spec)
        return [(clause.line, decided_on_trace(clause, evidence, spec, order.recorded)) for clause in clauses]
    except UnreadableTrace as error:
        problem = str(error)
    except (ValueError, KeyError, TypeError, AttributeError) as error:  # the trace or the manifest is damaged
        problem = f"the stored execution cannot be judged: {error}"
    return [(clause.line, unknown(problem, Cause.NO_RECORD)) for clause in clauses]


def main() -> None:
    """Obey orders until the input ends."""
    orders, messages = reserve_channel()
    channel, traces = Lines(messages), Traces()
    channel.send(RunStarted(0, "stored traces"))
    with os.fdopen(orders, encoding="utf-8") as stream:
        for line in read_requests(stream):
            try:
                order = decode_order(line)
            except (ValueError, KeyError, TypeError) as error:
                channel.send(LogLine("error", f"not an order: {error}"))
            else:
                obey(order, traces, channel)


if __name__ == "__main__":
    sys.exit(main())
