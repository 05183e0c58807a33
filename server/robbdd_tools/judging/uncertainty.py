"""Decide which verdicts are certain, although positions were measured with a stated uncertainty."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import si_factor
from robbdd_tools.catalog.api import Kind
from robbdd_tools.monitor.compound import CompoundEvaluator, changed
from robbdd_tools.monitor.joint_condition import joint_arguments, joint_predicate, parts_of
from robbdd_tools.monitor.judge import WindowEvidence, judge, unit_of
from robbdd_tools.monitor.time import Window
from robbdd_tools.monitor.trace import OTHERS
from robbdd_tools.monitor.verdict import Cause, Outcome, Verdict, unknown

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from robbdd_tools.catalog.api import Arguments, Evidence, FloatArray, Predicate
    from robbdd_tools.monitor.judge import Regions
    from robbdd_tools.monitor.time import TimeConstraint
    from robbdd_tools.monitor.trace import Trace

Condition = tuple["Predicate", "Arguments"]
SETS = (Kind.OBJECT_SET, Kind.WORKSPACE_SET)
ELEMENTS = (Kind.OBJECT, Kind.WORKSPACE, Kind.AGENT, Kind.ANY)
EXAMPLES = {
    "angle": "an angle is not stated: add --uncertainty '2 deg'",
    "speed": "a speed is not stated: add --uncertainty '0.05 m/s'",
}


def certain(
    predicate: Predicate,
    arguments: Arguments,
    constraint: TimeConstraint,
    trace: Trace,
    regions: Regions,
    condition: Condition | None,
) -> Verdict:
    """Judge like ``monitor.judge``, but *unknown* where the uncertainty of the measurements could change the verdict.

    A condition of ``whenever`` certainly applies where its margin exceeds its uncertainty, and possibly applies where
    its margin exceeds the negative uncertainty. So the clause certainly holds if it holds wherever its condition
    possibly applies. It is certainly violated if it is violated where its condition certainly applies.
    """
    if any(isinstance(one.evaluate, CompoundEvaluator) for one, _ in ((predicate, arguments), *_parts(condition))):
        return _certain_definition(predicate, arguments, constraint, trace, regions, condition)
    if condition is None:
        verdict = judge(predicate, arguments, constraint, trace, regions)
        return _narrowed(verdict, bound_of(predicate, arguments, trace, regions))
    doubts: list[tuple[Condition, float]] = []
    for part in parts_of(*condition):
        doubt = bound_of(*part, trace, regions)
        if isinstance(doubt, str):
            return unknown(doubt, Cause.UNOBSERVED)
        doubts.append((part, doubt))
    margin = bound_of(predicate, arguments, trace, regions)
    perhaps, surely = (
        judge(predicate, arguments, constraint, trace, regions, _all_raised(doubts, sign, trace, regions))
        for sign in (1, -1)
    )
    if surely.outcome is Outcome.VIOLATED:
        return _narrowed(surely, margin)
    if perhaps.outcome is not Outcome.VIOLATED:
        return _narrowed(perhaps, margin)
    if surely.outcome is Outcome.UNKNOWN:
        return surely
    return unknown("whether its condition held is within the uncertainty of the measurements", Cause.UNOBSERVED)


def _parts(condition: Condition | None) -> Sequence[Condition]:
    return () if condition is None else parts_of(*condition)


def _certain_definition(
    predicate: Predicate,
    arguments: Arguments,
    constraint: TimeConstraint,
    trace: Trace,
    regions: Regions,
    condition: Condition | None,
) -> Verdict:
    """Judge a clause with a named predicate: a verdict is certain if no margin error within the doubts changes it."""
    doubts: list[str] = []

    def raised(one: Predicate, own: Arguments, by: int) -> Predicate:
        bound = bound_of(one, own, trace, regions)
        if isinstance(bound, str):
            doubts.append(bound)
            return one
        return _raised((one, own), by * bound, trace, regions)[0]

    def verdict(sign: int) -> Verdict:
        """Judge with all margins raised (``sign`` 1) or lowered (-1), and the margins of conditions the other way."""
        own = changed(predicate, arguments, lambda one, given, inner: raised(one, given, inner * sign))
        if condition is None:
            return judge(own, arguments, constraint, trace, regions)
        parts = parts_of(*condition)
        whole = [changed(one, given, lambda part, its, inner: raised(part, its, -inner * sign)) for one, given in parts]
        joined = joint_predicate(whole), joint_arguments([given for _, given in parts])
        return judge(own, arguments, constraint, trace, regions, joined)

    plain = judge(predicate, arguments, constraint, trace, regions, condition)
    least, most = verdict(-1), verdict(1)
    if doubts:
        return unknown(doubts[0], Cause.UNOBSERVED)
    if plain.outcome is Outcome.UNKNOWN or (least.outcome is plain.outcome and most.outcome is plain.outcome):
        return plain
    return unknown("its margin is within the uncertainty of the measurements", Cause.UNOBSERVED)


def bound_of(predicate: Predicate, arguments: Arguments, trace: Trace, regions: Regions) -> float | str:
    """Return the largest error of a predicate's margin in the SI unit, or the reason why the error is unknown.

    A length changes by at most the sum of the errors of two positions. If the predicate names fewer than two elements,
    the largest error of any element counts for the missing ones.
    """
    if not trace.uncertain and not predicate.error:
        return 0.0
    match predicate.measured:
        case "nothing":
            return 0.0
        case "otherwise":
            words = f" of '{predicate.name}'" if predicate.phrase else ""
            return f"how uncertain the margin{words} is cannot be computed from the uncertainty of the measurements"
        case "angle" | "speed" as kind:
            return trace.uncertain.get(kind, f"the uncertainty of {EXAMPLES[kind]}")
        case "length":
            return _length(predicate, arguments, trace, regions) + predicate.error
        case "path":
            return _path(predicate, arguments, trace, regions)


def _length(predicate: Predicate, arguments: Arguments, trace: Trace, regions: Regions) -> float:
    found: list[float] = []
    for slot in predicate.slots:
        if slot.kind in (*ELEMENTS, *SETS):
            filler = arguments[slot.name]
            words = (filler,) if isinstance(filler, str) else filler
            carriers = [carrier for word in words for carrier in _carriers(word, regions)]
            found.append(max((trace.position_error(name) for name in carriers), default=0.0))
    largest = max(trace.uncertain.get(OTHERS, 0.0), *(trace.position_error(name) for name in trace.names), 0.0)
    return sum((*found, largest, largest)[: max(len(found), 2)])


def _path(predicate: Predicate, arguments: Arguments, trace: Trace, regions: Regions) -> float:
    """Return the error of the length of a target's path, as ``monitor.paths.length_beyond_errors`` measures it."""
    target = next(slot.name for slot in reversed(predicate.slots))
    return 4 * max(trace.position_error(name) for name in _carriers(str(arguments[target]), regions))


def _carriers(name: str, regions: Regions) -> list[str]:
    """Return the objects that carry a workspace, or else the element itself."""
    return [carrier for carrier, _ in regions.get(name, ())] or [name]


def _narrowed(verdict: Verdict, bound: float | str) -> Verdict:
    if verdict.outcome is Outcome.UNKNOWN or verdict.robustness is None:
        return verdict
    if isinstance(bound, str):
        return unknown(bound, Cause.UNOBSERVED)
    margin = verdict.robustness * si_factor(verdict.unit)
    if margin >= bound or margin < -bound:
        return verdict
    limit = f"{bound / si_factor(verdict.unit):.3g} {verdict.unit}"
    stated = f"its margin of {verdict.robustness:+.3g} {verdict.unit}"
    return unknown(f"{stated} is within the uncertainty of the measurements, ±{limit}", Cause.UNOBSERVED)


def _all_raised(doubts: Sequence[tuple[Condition, float]], sign: int, trace: Trace, regions: Regions) -> Condition:
    """Return the conjunction of conditions, each with margins that are larger (``sign`` 1) or smaller (-1) by its
    doubt."""
    raised = [_raised(condition, sign * doubt, trace, regions) for condition, doubt in doubts]
    return joint_predicate([predicate for predicate, _ in raised]), joint_arguments([own for _, own in raised])


def _raised(condition: Condition, by: float, trace: Trace, regions: Regions) -> Condition:
    """Return a condition whose margins are larger ``by`` a number in the SI unit."""
    predicate, arguments = condition
    if predicate.evaluate is None or not by:
        return condition
    unit = unit_of(predicate, WindowEvidence(trace, Window(0, 0), regions), arguments)
    return replace(predicate, evaluate=_Raised(predicate.evaluate, by / si_factor(unit))), arguments


class _Raised:
    """An evaluator that adds a number to the margins of another evaluator."""

    def __init__(self, evaluate: Callable[[Evidence, Arguments], FloatArray], by: float) -> None:
        self._evaluate = evaluate
        self._by = by

    def __call__(self, evidence: Evidence, arguments: Arguments) -> FloatArray:
        return self._evaluate(evidence, arguments) + self._by
