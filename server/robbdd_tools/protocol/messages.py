"""The messages between a run and its agent processes. Each message is one line of JSON.

The agent reads orders (``Execute``) from its standard input, and exits when the input ends. It writes ``RunMessage``
objects. Every message is a frozen dataclass. ``decode`` is the inverse of ``encode``.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass

from robbdd_tools.base.plain import finite, from_plain
from robbdd_tools.monitor.contact import Contact
from robbdd_tools.monitor.fault import Fault
from robbdd_tools.monitor.verdict import Cause, Outcome, Verdict, unknown
from robbdd_tools.protocol.pauses import Paused, SceneWritten

VIEWER = "ROBBDD_VIEWER"
"""Environment variable of the agent: if set, a window shows each scenario in real time."""


@dataclass(frozen=True, slots=True)
class Execute:
    """The order of the parent to execute scenario number ``index`` of the manifest."""

    index: int


@dataclass(frozen=True, slots=True)
class RunStarted:
    """The agent is ready. The manifest has ``total`` scenarios."""

    total: int
    simulator: str


@dataclass(frozen=True, slots=True)
class ScenarioStarted:
    """Scenario number ``index`` (from 0, in manifest order) begins."""

    index: int


@dataclass(frozen=True, slots=True)
class ClauseStarted:
    """The clause on the feature line ``line`` is waiting for the end of its window."""

    index: int
    line: int


@dataclass(frozen=True, slots=True)
class ClauseJudged:
    """A clause has its verdict (``holds``, ``violated`` or ``unknown``); see ``monitor.verdict.Verdict``.

    ``fault`` is the ``id`` of the error in users' code that makes the clause unknown, as in ``UserCodeFailed``.
    ``cause`` is a ``monitor.verdict.Cause``; empty if the verdict is known.
    """

    index: int
    line: int
    verdict: str
    robustness: float | None
    unit: str
    at: float | None
    reason: str
    worst_at: float | None = None
    vacuous: str = ""
    fault: str = ""
    cause: str = ""
    operand: int | None = None


@dataclass(frozen=True, slots=True)
class MarginRanges:
    """The smallest and the largest margin of each fluent of the clause on ``line`` in the whole execution.

    ``held_before`` states whether a Then clause holds and its predicates also held before the behaviour began; ``None``
    if unknown.
    """

    index: int
    line: int
    ranges: tuple[tuple[float, float], ...]
    held_before: bool | None = None


@dataclass(frozen=True, slots=True)
class ScenarioFinished:
    """All clauses of scenario ``index`` are judged. Times are in s (simulated, wall, and wall inside mj_step).

    ``resampled`` is the number of random places that were sampled again because of an overlap or because they were out
    of reach. ``contacts`` are contacts of agents that no clause names as a target, except those with gripped objects
    and the supports of these.
    """

    index: int
    simulated: float
    wall: float
    stepping: float
    resampled: int = 0
    contacts: tuple[Contact, ...] = ()


@dataclass(frozen=True, slots=True)
class UserCodeFailed:
    """Users' code failed in scenario ``index`` or, if ``index`` is ``None``, before any scenario.

    The message is sent once for each scenario, before the verdicts that name ``fault``.
    """

    index: int | None
    fault: Fault


@dataclass(frozen=True, slots=True)
class Output:
    """Lines that users' code printed during scenario ``index`` or, if ``index`` is ``None``, before any scenario."""

    index: int | None
    text: str


@dataclass(frozen=True, slots=True)
class DebuggerAwaited:
    """The agent waits for a debugger that connects to this port of the machine (Debug Adapter Protocol)."""

    port: int


@dataclass(frozen=True, slots=True)
class LogLine:
    """A line for the log. ``level`` is ``info``, ``warning`` or ``error``."""

    level: str
    text: str


@dataclass(frozen=True, slots=True)
class RunFinished:
    """The agent exits regularly. ``ok`` is false if it cannot work. Without this message, the agent has crashed."""

    ok: bool


RunMessage = (
    RunStarted
    | ScenarioStarted
    | ClauseStarted
    | ClauseJudged
    | MarginRanges
    | ScenarioFinished
    | UserCodeFailed
    | Output
    | DebuggerAwaited
    | Paused
    | SceneWritten
    | LogLine
    | RunFinished
)
_TYPES: dict[str, type[RunMessage]] = {
    kind.__name__: kind
    for kind in (
        RunStarted,
        ScenarioStarted,
        ClauseStarted,
        ClauseJudged,
        MarginRanges,
        ScenarioFinished,
        UserCodeFailed,
        Output,
        DebuggerAwaited,
        Paused,
        SceneWritten,
        LogLine,
        RunFinished,
    )
}


def judged(index: int, line: int, verdict: Verdict) -> ClauseJudged:
    """Return the message of a clause's verdict."""
    return ClauseJudged(
        index,
        line,
        str(verdict.outcome),
        verdict.robustness,
        verdict.unit,
        verdict.at,
        verdict.reason,
        verdict.worst_at,
        verdict.vacuous,
        "" if verdict.fault is None else verdict.fault.id,
        verdict.cause or "",
        verdict.operand,
    )


def never_judged(index: int, line: int, reason: str, cause: Cause, fault: Fault | None = None) -> ClauseJudged:
    """Return the verdict *unknown* for a clause that nothing judged.

    ``fault`` is the error that caused it, if known.
    """
    return judged(index, line, unknown(reason, cause, fault=fault))


def encode(message: RunMessage | Execute) -> str:
    """Return a message as one line of JSON in ASCII, without the line break."""
    return json.dumps({"type": type(message).__name__, **asdict(message)})


def decode(line: str) -> RunMessage:
    """Return the message that a line contains. Raises ``ValueError`` if any field is invalid."""
    try:
        fields = json.loads(line, parse_float=finite, parse_constant=finite)
        message = from_plain(_TYPES[fields.pop("type")], fields)
        if isinstance(message, ClauseJudged):
            Outcome(message.verdict)
            if message.cause:
                Cause(message.cause)
        if isinstance(message, LogLine) and message.level not in ("info", "warning", "error"):
            raise ValueError(message.level)
        return message
    except (KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
        raise ValueError(f"not a run message: {line[:200]!r}") from error


def decode_request(line: str) -> Execute:
    """Return the order that a line contains. Raises ``ValueError`` if it is invalid."""
    match json.loads(line):
        case {"type": "Execute", "index": int(index)}:
            return Execute(index)
        case _:
            raise ValueError(f"not an order: {line[:200]!r}")
