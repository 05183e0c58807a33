"""Three-valued verdicts with signed robustness, and how they combine."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import StrEnum

from robbdd_tools.monitor.fault import Fault

EMPTY_WINDOW = "its window holds no sample"
EMPTY_SET = "a set that it quantifies over is empty"
"""Why a clause could not have been violated."""


class Outcome(StrEnum):
    """What is known of a clause."""

    HOLDS = "holds"
    VIOLATED = "violated"
    UNKNOWN = "unknown"


@dataclass(frozen=True, slots=True)
class Verdict:
    """The judgement of one clause on one trace.

    ``robustness`` is the signed margin in ``unit`` (positive: holds), ``None`` when unknown. ``at`` (s) is the
    instant of violation (the first sample with a negative margin), of the worst margin when it holds, ``None``
    when unknown; ``worst_at`` (s) is that of the worst margin in any case. ``reason`` says in words why it is
    violated or unknown; ``vacuous`` why it could not have been violated, nothing where it could. ``fault`` is the error
    in users' code that kept the evidence away.
    """

    outcome: Outcome
    robustness: float | None = None
    unit: str = ""
    at: float | None = None
    reason: str = ""
    worst_at: float | None = None
    vacuous: str = ""
    fault: Fault | None = None


def unknown(reason: str, vacuous: str = "", fault: Fault | None = None) -> Verdict:
    """Return the verdict for missing evidence; it never passes."""
    return Verdict(Outcome.UNKNOWN, reason=reason, vacuous=vacuous, fault=fault)


def negation(verdict: Verdict) -> Verdict:
    """Strong Kleene negation; the margin changes its sign, the instant is that of the worst one."""
    if verdict.robustness is None:
        return verdict
    outcome = Outcome.VIOLATED if verdict.outcome is Outcome.HOLDS else Outcome.HOLDS
    return replace(verdict, outcome=outcome, robustness=-verdict.robustness, at=verdict.worst_at, reason="")


def conjunction(verdicts: Iterable[Verdict]) -> Verdict:
    """Strong Kleene *and*: violated wins over unknown, unknown over holds; the margin is the smallest."""
    return _combine(list(verdicts), decisive=Outcome.VIOLATED, sign=1.0)


def disjunction(verdicts: Iterable[Verdict]) -> Verdict:
    """Strong Kleene *or*: holds wins over unknown, unknown over violated; the margin is the largest."""
    return _combine(list(verdicts), decisive=Outcome.HOLDS, sign=-1.0)


def _combine(verdicts: list[Verdict], decisive: Outcome, sign: float) -> Verdict:
    if not verdicts:
        return unknown("there is nothing to judge: the set is empty", EMPTY_SET)
    deciding = [verdict for verdict in verdicts if verdict.outcome is decisive]
    if not deciding:
        open_ones = [verdict for verdict in verdicts if verdict.outcome is Outcome.UNKNOWN]
        if open_ones:
            return open_ones[0]
        deciding = verdicts
    return min(deciding, key=lambda verdict: sign * (verdict.robustness or 0.0))
