"""Describe the verdicts of stored traces on an edited clause: which executions flip, and which must be run again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.features.run_verdicts import Judged, Judgement, RejudgedClause

SIGNS = {"holds": "✔", "violated": "✗", "unknown": "?", "undefined": "?"}
MARK = "(re-judged, not executed)"
BADNESS = ("violated", "undefined", "unknown", "holds")


@dataclass(frozen=True, slots=True)
class RejudgedResult:
    """The result of an edited clause in words.

    - ``outcome``: the worst outcome of all executions.
    - ``reason``: the reason for the worst verdict that does not hold; empty if all hold.
    - ``counts``: how many executions hold, flip, are unknown or must be run again.
    - ``lines``: descriptions of the executions: those that flip first, then the worst.
    - ``usable``: false if no stored trace is evidence for the edited clause.
    """

    outcome: str
    label: str
    reason: str
    counts: str
    lines: tuple[str, ...]
    flipped: int
    usable: bool


def rejudged_result(rejudged: Sequence[RejudgedClause], executed: Sequence[Judged], now: str) -> RejudgedResult:
    """Return the result of a clause.

    ``executed`` are the verdicts of its runs, and ``now`` is the digest of its current text. If a run judged this text,
    its verdict counts, too. The other executions are still to be judged.
    """
    known = {id(one.scenario) for one in rejudged}
    others = [entry for entry in executed if id(entry[0]) not in known]
    fresh = [entry for entry in others if entry[1].digest == now]
    usable = sorted((one for one in rejudged if one.judgement is not None), key=_order)
    verdicts = [*(one.judgement for one in usable if one.judgement is not None), *(verdict for _, verdict in fresh)]
    unusable = [one for one in rejudged if one.judgement is None]
    lines = tuple(_line(one) for one in (*usable, *unusable))
    lines += tuple(f"{scenario.values}: {verdict.said}" for scenario, verdict in fresh)
    if not verdicts:
        reason = unusable[0].reason
        return RejudgedResult("unknown", f"? {reason}", reason, "", lines, 0, usable=False)
    worst = min(verdicts, key=lambda verdict: verdict.rank)
    flipped = sum(map(_flips, usable))
    counts = ", ".join(_counts(verdicts, flipped, len(unusable), len(others) - len(fresh)))
    if len(verdicts) == len(rejudged) + len(others) == 1:
        label = f"{_single(usable[0].before if usable else None, worst)} {MARK}"
    else:
        label = f"{SIGNS[worst.outcome]} {counts} {MARK}" + (f" · worst {worst.margin}" if worst.margin else "")
    reason = "" if worst.outcome == "holds" else worst.failure or worst.said
    return RejudgedResult(worst.outcome, label, reason, counts, lines, flipped, usable=True)


def _counts(verdicts: Sequence[Judgement], flipped: int, unusable: int, left: int) -> list[str]:
    """Return the counts in words, without those that are 0."""
    outcomes = [verdict.outcome for verdict in verdicts]
    unknown = outcomes.count("unknown") + outcomes.count("undefined")
    found = [f"{flipped:,} flipped"] * bool(flipped) + [f"{outcomes.count('holds'):,} of {len(outcomes):,} hold"]
    named = ((unknown, "unknown"), (unusable, "to run again"), (left, "left to judge"))
    return found + [f"{count:,} {name}" for count, name in named if count]


def _single(before: Judgement | None, found: Judgement) -> str:
    """Return the verdict of a single execution, with its reason if it is unknown."""
    shown = found.said if found.outcome == "unknown" else found.said.partition(":")[0]
    return f"{shown} · was {_short(before)}" if before is not None and before.outcome != found.outcome else shown


def _flips(one: RejudgedClause) -> bool:
    """Return whether the edit gives the execution another verdict. *Unknown* is not a verdict of the trace."""
    if one.judgement is None or one.before is None:
        return False
    return one.judgement.outcome in ("holds", "violated") and one.before.outcome != one.judgement.outcome


def _order(one: RejudgedClause) -> tuple[bool, float]:
    return not _flips(one), 0.0 if one.judgement is None else one.judgement.rank


def _short(judgement: Judgement) -> str:
    return f"{SIGNS[judgement.outcome]} {judgement.margin}".strip()


def _line(one: RejudgedClause) -> str:
    values = f"{one.scenario.values}: "
    if one.judgement is None:
        return values + one.reason
    if _flips(one) and one.before is not None:
        return f"{values}{_short(one.before)} → {one.judgement.said}"
    return values + one.judgement.said
