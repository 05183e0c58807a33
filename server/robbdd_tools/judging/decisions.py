"""Judge clauses on a trace. The monitor judges fluents, and strong Kleene logic combines them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace
from itertools import combinations, count, product
from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import QuantityError
from robbdd_tools.catalog.api import Kind
from robbdd_tools.catalog.settings import SettingError
from robbdd_tools.judging.uncertainty import certain
from robbdd_tools.monitor.judge import judge, margin_range
from robbdd_tools.monitor.time import NoWindow, never_occurred, occurrences, window
from robbdd_tools.monitor.vacuity import Range, joined
from robbdd_tools.monitor.verdict import Cause, Outcome, Verdict, conjunction, disjunction, negation, unknown
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
_OF_CONDITION = "whenever "


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


def occurred(trace: Trace, event: str, iteration: int) -> Verdict:
    """Judge a When clause that waits for an event. ``iteration`` selects the occurrence, as in ``Trace.event_time``."""
    time = trace.event_time(event, iteration)
    if trace.unreached:
        return unknown(trace.unreached, Cause.UNREACHED)
    if time is None:
        doubt = trace.doubt(event, (iteration, iteration))
        return unknown(never_occurred(trace, event, iteration) if doubt is None else str(doubt), Cause.NO_EVENT)
    return Verdict(Outcome.HOLDS, at=time)


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


@dataclass(frozen=True, slots=True)
class Instance:
    """The arguments of a fluent's predicate and, if it has one, of its condition, in the form for evaluators."""

    arguments: Arguments
    condition: Arguments | None = None


def alternatives(fluent: Fluent) -> Iterator[Iterator[Instance]]:
    """Yield the alternatives of a fluent. The fluent holds if one alternative does.

    All instances of an alternative must hold. If a set fills a slot of the predicate and a slot of the condition, or
    slots of two conditions, both slots have the same element.
    """
    slots, arguments = fluent.predicate.slots, dict(fluent.arguments)
    condition = fluent.condition
    if condition is not None:
        renamed = {slot.name: f"{_OF_CONDITION}{slot.name}" for slot in condition.predicate.slots}
        slots += tuple(replace(slot, name=renamed[slot.name]) for slot in condition.predicate.slots)
        arguments |= {renamed[name]: filler for name, filler in condition.arguments.items()}
    some = [slot for slot in slots if isinstance(arguments[slot.name], AnyOf)]
    return (_split_instances(fluent, slots, chosen) for chosen in _choices(arguments, some))


def _split_instances(fluent: Fluent, slots: tuple[Slot, ...], arguments: Mapping[str, Filler]) -> Iterator[Instance]:
    """Yield the instances of a fluent. The names of the slots of its condition begin with ``_OF_CONDITION``."""
    single = [slot.name for slot in slots if slot.kind not in SETS and not isinstance(arguments[slot.name], str)]
    own = [name for name in single if not name.startswith(_OF_CONDITION)]
    same = [
        (name, other)
        for name in single
        if name.startswith(_OF_CONDITION)
        for other in own
        if arguments[name] == arguments[other]
    ]
    of_condition = [name for name in single if name.startswith(_OF_CONDITION)]
    same += [
        (name, other)
        for name, other in combinations(of_condition, 2)
        if arguments[name] == arguments[other] and name.partition("-")[2] != other.partition("-")[2]
    ]
    for words in _instances(slots, arguments):
        if any(words[name] != words[other] for name, other in same):
            continue
        own_words = {name: word for name, word in words.items() if not name.startswith(_OF_CONDITION)}
        others = {name.removeprefix(_OF_CONDITION): word for name, word in words.items() if name not in own_words}
        yield Instance(own_words, None if fluent.condition is None else others)


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
        conjunction(_judged(fluent, instance, trace, regions) for instance in group) for group in alternatives(fluent)
    )


def _judged(fluent: Fluent, instance: Instance, trace: Trace, regions: Regions) -> Verdict:
    condition = None
    if fluent.condition is not None and instance.condition is not None:
        condition = fluent.condition.predicate, instance.condition
    try:
        judged = certain if trace.uncertain or fluent.predicate.error else judge
        return judged(fluent.predicate, instance.arguments, fluent.time, trace, regions, condition)
    except (SettingError, QuantityError) as error:
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
