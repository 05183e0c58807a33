"""Judge clauses on a trace. The monitor judges fluents, and strong Kleene logic combines them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import replace
from itertools import count, product
from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Kind
from robbdd_tools.judging.observation_streams import Unobserved
from robbdd_tools.monitor.judge import judge, margin_range
from robbdd_tools.monitor.time import NoWindow, occurrences, window
from robbdd_tools.monitor.vacuity import Range, joined
from robbdd_tools.monitor.verdict import Cause, Verdict, conjunction, disjunction, negation, unknown
from robbdd_tools.protocol.clauses import AnyOf, Clause, Filler, Fluent, Junction, Text, fluents_of
from robbdd_tools.protocol.time_words import AMBIGUOUS
from robbdd_tools.user_code.calls import UserCodeError, fault_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Arguments, Slot
    from robbdd_tools.monitor.judge import Regions
    from robbdd_tools.monitor.trace import Trace

NO_STEP = "no step definition"
"""Prefix of the reason for a clause that no step judges."""
SETS = (Kind.OBJECT_SET, Kind.WORKSPACE_SET)


def decide(clause: Clause, trace: Trace, regions: Regions, events: AbstractSet[str]) -> Verdict:
    """Judge a clause on a trace. ``events`` are the events that have an emitter in the scenario."""
    if trace.unreached:
        return unknown(trace.unreached, Cause.UNREACHED)
    numbers = count()

    def decided(clause: Clause) -> Verdict:
        match clause:
            case Fluent():
                return replace(_fluent(clause, trace, regions, events), operand=next(numbers))
            case Junction("not", (operand,)):
                return negation(decided(operand))
            case Junction(operator, operands):
                verdicts = [decided(operand) for operand in operands]
                return conjunction(verdicts) if operator == "and" else disjunction(verdicts)
            case Text(words):
                return unknown(no_step(words), Cause.NO_STEP)

    return decided(clause)


def no_step(words: str) -> str:
    """Return the reason why a sentence that no step judges is unknown."""
    found = AMBIGUOUS.search(words)
    if found is None:
        return f"{NO_STEP} for '{words}'"
    seconds = found["horizon"]
    meant = f"write 'for {seconds} seconds', or 'at some time within {seconds} seconds'"
    return f"{NO_STEP} for '{words}': {meant}"


def ranges(clause: Clause, trace: Trace, regions: Regions) -> tuple[Range, ...]:
    """Return the range of the margin of each fluent over a whole trace, if known."""
    found: list[Range] = []
    for fluent in fluents_of(clause):
        slots = fluent.predicate.slots
        try:
            each = [
                margin_range(fluent.predicate, words, trace, regions) for words in _instances(slots, fluent.arguments)
            ]
        except Exception:  # the same failure has already made the clause unknown, with this reason
            return ()
        found += [joined(known)] if (known := [one for one in each if one is not None]) else []
    return tuple(found)


def is_closed(clause: Clause, trace: Trace, events: AbstractSet[str]) -> bool:
    """Return whether the verdict on a clause is final, so that a longer trace cannot change it."""
    return all(_closed(fluent, trace, events) for fluent in fluents_of(clause))


def alternatives(fluent: Fluent) -> Iterator[Iterator[Arguments]]:
    """Yield the alternatives of a fluent. The fluent holds if one alternative does.

    An alternative is a list of arguments, all of which must satisfy the predicate.
    """
    slots = fluent.predicate.slots
    some = [slot for slot in slots if isinstance(fluent.arguments[slot.name], AnyOf)]
    return (_instances(slots, chosen) for chosen in _choices(fluent.arguments, some))


def _closed(fluent: Fluent, trace: Trace, events: AbstractSet[str]) -> bool:
    if fluent.predicate.evaluate is None or not events >= {event for event, _ in occurrences(fluent.time)}:
        return True
    selected = window(fluent.time, trace)
    return not (isinstance(selected, NoWindow) and selected.open)


def _fluent(fluent: Fluent, trace: Trace, regions: Regions, events: AbstractSet[str]) -> Verdict:
    silent = [event for event, _ in occurrences(fluent.time) if event not in events]
    if silent and fluent.predicate.evaluate is not None:
        return unknown(f"nothing in the scenario emits event {silent[0]}", Cause.NO_EMITTER)
    return disjunction(
        conjunction(_judged(fluent, arguments, trace, regions) for arguments in group) for group in alternatives(fluent)
    )


def _judged(fluent: Fluent, arguments: Arguments, trace: Trace, regions: Regions) -> Verdict:
    try:
        return judge(fluent.predicate, arguments, fluent.time, trace, regions)
    except Unobserved as error:
        return unknown(str(error), Cause.UNOBSERVED)
    except UserCodeError as error:
        return unknown(str(error), Cause.USER_CODE, fault=error.fault)
    except Exception as error:  # an evaluator may be third-party code; its failure is missing evidence
        fault = fault_of(error, fluent.predicate.name, fluent.predicate.evaluate)
        return unknown(
            f"the evaluator of '{fluent.predicate.name}' failed: {fault.summary}", Cause.USER_CODE, fault=fault
        )


def _choices(arguments: Mapping[str, Filler], some: list[Slot]) -> Iterator[Mapping[str, Filler]]:
    """Yield every choice of one element for each existential slot."""
    options = [filler.elements for slot in some if isinstance(filler := arguments[slot.name], AnyOf)]
    for chosen in product(*options):
        yield {**arguments, **{slot.name: element for slot, element in zip(some, chosen, strict=True)}}


def _instances(slots: tuple[Slot, ...], arguments: Mapping[str, Filler]) -> Iterator[Arguments]:
    """Yield the arguments of a fluent in the form that the evaluator needs.

    A set in a slot for a single element is expanded to its elements.
    """
    options = [_options(slot.kind, arguments[slot.name]) for slot in slots]
    for values in product(*options):
        yield {slot.name: value for slot, value in zip(slots, values, strict=True)}


def _options(kind: Kind, filler: Filler) -> tuple[str | tuple[str, ...], ...]:
    elements = filler.elements if isinstance(filler, AnyOf) else filler
    if kind in SETS:
        return ((elements,) if isinstance(elements, str) else elements,)
    return (elements,) if isinstance(elements, str) else elements
