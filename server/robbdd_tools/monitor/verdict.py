"""Three-valued verdicts with signed robustness, and their logical connectives."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import StrEnum

from robbdd_tools.base.quantity_units import si_factor
from robbdd_tools.monitor.fault import Fault

EMPTY_WINDOW = "its window contains no sample"
EMPTY_SET = "a set that it quantifies over is empty"
NEVER_APPLIED = "its condition never holds in the window"
"""Why a clause could not have been violated."""


class Outcome(StrEnum):
    """The judgement on a clause."""

    HOLDS = "holds"
    VIOLATED = "violated"
    UNKNOWN = "unknown"


class Cause(StrEnum):
    """The type of the reason why a clause is unknown. The verdict's ``reason`` says it in words."""

    CANCELLED = "cancelled"
    """The run was cancelled before the clause was judged."""
    STOPPED = "stopped"
    """The run ended at its first failure before the clause was judged."""
    NOT_EXECUTED = "not-executed"
    """The run ended, or could not begin, before the clause was judged."""
    TIMED_OUT = "timed-out"
    """The execution exceeded its wall-time limit."""
    PROCESS_ENDED = "process-ended"
    """The process that executed the scenario ended by itself."""
    TIME_LIMIT = "time-limit"
    """The execution exceeded its limit of simulated time."""
    SIMULATION = "simulation"
    """The simulation failed."""
    SCENE = "scene"
    """The scene cannot be set up."""
    USER_CODE = "user-code"
    """Code of the user failed."""
    NO_STEP = "no-step"
    """No step and no evaluator judges the clause."""
    SKIPPED = "skipped"
    """behave did not execute the step."""
    UNREACHED = "unreached"
    """The execution never reached the clause's subject."""
    NO_EMITTER = "no-emitter"
    """Nothing in the scenario emits an event that the clause names."""
    NO_EVENT = "no-event"
    """An event that the clause names did not occur."""
    NO_RECORD = "no-record"
    """The trace lacks the data that the clause is judged on."""
    UNOBSERVED = "unobserved"
    """The simulation does not provide the clause's observations."""
    EMPTY = "empty"
    """The clause quantifies over an empty set, or its window contains no sample."""
    CHANGED = "changed"
    """The model has changed since the trace was recorded."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """The judgement of one clause on one trace.

    - ``robustness``: the signed margin in ``unit``; positive if the clause holds; ``None`` if unknown, or if the
      condition of ``whenever`` never held.
    - ``at``: the instant (s) of the violation, which is the first sample with a negative margin. If the clause holds,
      it is the instant of the smallest margin; if it is unknown, ``None``. A predicate that must hold at some time only
      is violated at the last sample of the window, and holds at the first sample with a margin of at least 0.
    - ``worst_at``: the instant (s) of the margin, also for a violation.
    - ``reason``: why the clause is violated or unknown, in words. For a predicate that must hold at some time only,
      when it first held.
    - ``cause``: the type of the reason of an unknown verdict.
    - ``vacuous``: why the clause could not have been violated; empty if it could.
    - ``fault``: the error in users' code that prevented the evidence.
    - ``operand``: the number (from 0, in the order of the sentence) of the fluent that decides the clause.
    """

    outcome: Outcome
    robustness: float | None = None
    unit: str = ""
    at: float | None = None
    reason: str = ""
    worst_at: float | None = None
    vacuous: str = ""
    fault: Fault | None = None
    cause: Cause | None = None
    operand: int | None = None


def unknown(reason: str, cause: Cause, vacuous: str = "", fault: Fault | None = None) -> Verdict:
    """Return the verdict for missing evidence; it never passes."""
    return Verdict(Outcome.UNKNOWN, reason=reason, vacuous=vacuous, fault=fault, cause=cause)


def negation(verdict: Verdict) -> Verdict:
    """Return the strong Kleene negation of a verdict.

    The margin changes its sign, and the instant is the instant of the smallest margin.
    """
    if verdict.outcome is Outcome.UNKNOWN:
        return verdict
    outcome = Outcome.VIOLATED if verdict.outcome is Outcome.HOLDS else Outcome.HOLDS
    if verdict.robustness is None:
        return replace(verdict, outcome=outcome)
    return replace(verdict, outcome=outcome, robustness=-verdict.robustness, at=verdict.worst_at, reason="")


def conjunction(verdicts: Iterable[Verdict]) -> Verdict:
    """Return the strong Kleene *and* of verdicts, with the smallest margin.

    Violated takes precedence over unknown, and unknown over holds.
    """
    return _combine(list(verdicts), decisive=Outcome.VIOLATED, sign=1.0)


def disjunction(verdicts: Iterable[Verdict]) -> Verdict:
    """Return the strong Kleene *or* of verdicts, with the largest margin.

    Holds takes precedence over unknown, and unknown over violated.
    """
    return _combine(list(verdicts), decisive=Outcome.HOLDS, sign=-1.0)


def _combine(verdicts: list[Verdict], decisive: Outcome, sign: float) -> Verdict:
    if not verdicts:
        return unknown("there is nothing to judge: the set is empty", Cause.EMPTY, EMPTY_SET)
    deciding = [verdict for verdict in verdicts if verdict.outcome is decisive]
    if not deciding:
        open_ones = [verdict for verdict in verdicts if verdict.outcome is Outcome.UNKNOWN]
        if open_ones:
            return open_ones[0]
        deciding = verdicts
    measured = [verdict for verdict in deciding if verdict.robustness is not None]
    return min(measured or deciding, key=lambda verdict: sign * (verdict.robustness or 0.0) * si_factor(verdict.unit))
