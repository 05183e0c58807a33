"""Replace the variables of a model's clauses by the values of one scenario."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Set
from dataclasses import dataclass, field, replace
from math import isfinite
from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Kind
from robbdd_tools.gherkin import text
from robbdd_tools.gherkin.said_phrases import said_phrase
from robbdd_tools.gherkin.words import Placeholder, condition_words, filled, word
from robbdd_tools.graph.acceptance_model import (
    AcceptanceModel,
    BehaviourClause,
    Cell,
    Clause,
    Condition,
    DefinedEvent,
    EventClause,
    Exists,
    Fluent,
    ForAll,
    Iri,
    Junction,
    TextClause,
    TextFluent,
)
from robbdd_tools.monitor.compound import renamed
from robbdd_tools.monitor.time import After, Before, During, TimeConstraint
from robbdd_tools.protocol import clauses as stated
from robbdd_tools.protocol.specs import plain_name
from robbdd_tools.protocol.time_words import instant_words

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Predicate
    from robbdd_tools.catalog.registry import Catalog

Value = Cell | stated.AnyOf
"""Value of a variable. In a Scenario Outline, it is a ``Placeholder``."""
Values = Mapping[Iri, Value]


class UnknownElements(Exception):
    """A clause needs the elements of a set, or a horizon, but these vary between the rows of the Scenario Outline."""


@dataclass(frozen=True, slots=True)
class Binder:
    """Binds the clauses of one model to values.

    A clause whose IRI is in ``by_code`` also contains its values by name. If ``reads_texts`` is true, a text that is a
    predicate's phrase with fitting values becomes a fluent with this predicate, so that it can be judged.
    """

    model: AcceptanceModel
    catalog: Catalog
    by_code: Set[str] = frozenset()
    reads_texts: bool = False
    _curies: dict[str, str] = field(default_factory=dict[str, str])
    _named_predicates: dict[str, Predicate] = field(default_factory=dict[str, "Predicate"])

    def curie(self, iri: str) -> str:
        """Return the CURIE of an IRI. The result is cached."""
        found = self._curies.get(iri)
        if found is None:
            found = self._curies[iri] = self.model.curie(iri)
        return found

    def bind(self, clause: Clause, values: Values) -> stated.Statement:
        """Return the statement of a clause, in which the values replace the variables."""
        match clause:
            case BehaviourClause():
                behaviour = self.catalog.behaviours[clause.behaviour]
                places = [clause.arguments.get(slot.name) for slot in behaviour.slots if slot.kind is Kind.WORKSPACE]
                any_place = {place: self._any_of(place, values) for place in places if isinstance(place, Iri)}
                slots = (slot.name for slot in behaviour.slots)
                arguments = self._slots(slots, clause.arguments, {**values, **any_place})
                if not clause.has_siblings:
                    return stated.BehaviourCall(behaviour, arguments)
                limits = self.curie(clause.start), self.curie(clause.end)
                return stated.BehaviourCall(behaviour, arguments, clause.iri, *limits, clause.together is not None)
            case EventClause():
                return stated.EventOccurrence(self.curie(clause.event))
            case _:
                return self.clause(clause, values)

    def clause(self, clause: Clause, values: Values) -> stated.Clause:
        """Return the statement of a clause that is not a ``When`` clause."""
        match clause:
            case Fluent():
                predicate = self._predicate(clause)
                slots = self._slots((slot.name for slot in predicate.slots), clause.arguments, values)
                condition, time = self._condition(clause, values), self._time(clause, values)
                if time is None:
                    return self._without_time(filled(predicate.sentence, slots), clause, values)
                return stated.Fluent(predicate, slots, time, clause.iri, self._named(clause, values), condition)
            case TextFluent():
                fillers = self._slots(clause.arguments, clause.arguments, values)
                words = filled(text.free(clause.template), fillers)
                condition, time = self._condition(clause, values), self._time(clause, values)
                if time is None:
                    return self._without_time(words, clause, values)
                said = said_phrase(self.model, clause, values) if self.reads_texts else None
                if said is not None:
                    predicate, cells = said
                    slots = {name: self.filler(cell) for name, cell in cells.items()}
                    return stated.Fluent(predicate, slots, time, clause.iri, self._named(clause, values), condition)
                return stated.Text(words, time, clause.iri, self._named(clause, values), condition)
            case TextClause():
                words, time = text.free(clause.text), self._time(clause, values)
                if time is None:
                    return self._without_time(words, clause, values)
                return stated.Text(words, time, clause.iri, self._named(clause, values))
            case Junction(operator="not"):
                return stated.Junction("not", (self._joined("and", clause.operands, values),))
            case Junction():
                operands = tuple(self.clause(operand, values) for operand in clause.operands)
                return stated.Junction("or" if clause.operator == "or" else "and", operands)
            case Exists() if self.is_one_choice(clause, values):
                return self._joined("and", clause.clauses, self.some(clause, values))
            case Exists():
                each = tuple(self._joined("and", clause.clauses, inner) for inner in self._each(clause, values))
                return each[0] if len(each) == 1 else stated.Junction("or", each)
            case ForAll():
                each = tuple(self._joined("and", clause.clauses, inner) for inner in self._each(clause, values))
                return each[0] if len(each) == 1 else stated.Junction("and", each)
            case BehaviourClause() | EventClause():
                raise TypeError("a When clause cannot be part of a group")

    def elements(self, in_set: Iri, values: Values) -> tuple[Cell, ...]:
        """Return the elements of a set, which is the value of a variable or a constant set.

        Raises ``UnknownElements``.
        """
        match values.get(in_set, self.model.sets.get(in_set, ())):
            case stated.AnyOf(elements):
                return elements
            case Placeholder():
                raise UnknownElements
            case tuple() as several:
                return several
            case one:
                return (one,)

    def some(self, exists: Exists, values: Values) -> Values:
        """Return the values with *any of* the elements of the quantifier's set as the value of its variable."""
        elements = tuple(self._plain(element) for element in self.elements(exists.in_set, values))
        return {**values, exists.variable: stated.AnyOf(elements)}

    def is_one_choice(self, exists: Exists, values: Values) -> bool:
        """Return whether *any of* in a single place can express a quantifier.

        This is possible if the variable occurs only once. Otherwise each choice must be written out and joined by *or*,
        because the same element must satisfy all clauses, and because "some element is not there" differs from "none of
        them is there".
        """
        if not self.elements(exists.in_set, values):
            return True
        about = [clause for clause in exists.clauses if mentions(clause, exists.variable)]
        return not about or (len(about) == 1 and _mentions_once(about[0], exists.variable))

    def filler(self, value: Value) -> stated.Filler:
        """Return a value in the form in which it fills the slot of a phrase."""
        match value:
            case Iri():
                return self.curie(value)
            case str() | stated.AnyOf():
                return value
            case tuple():
                return tuple(map(self._plain, value))
            case _:
                return str(value)

    def _joined(self, operator: str, parts: tuple[Clause, ...], values: Values) -> stated.Clause:
        found = tuple(self.clause(part, values) for part in parts)
        return found[0] if len(found) == 1 else stated.Junction("or" if operator == "or" else "and", found)

    def _any_of(self, place: Iri, values: Values) -> Value:
        """Return the value of a place. For a set, return *any of* its elements, because a behaviour may choose one."""
        value = values.get(place, self.model.sets.get(place, place))
        return stated.AnyOf(tuple(map(self._plain, value))) if isinstance(value, tuple) else value

    def _each(self, quantified: Exists | ForAll, values: Values) -> Iterator[Values]:
        for element in self.elements(quantified.in_set, values):
            yield {**values, quantified.variable: element}

    def _plain(self, value: Value) -> str:
        return self.curie(value) if isinstance(value, Iri) else str(value)

    def _slots(
        self, slots: Iterable[str], arguments: Mapping[str, Iri | str], values: Values
    ) -> dict[str, stated.Filler]:
        return {slot: self._slot(slot, arguments.get(slot), values) for slot in slots}

    def defined_event(self, event: DefinedEvent, values: Values) -> stated.DefinedEvent | None:
        """Return an event that a template defines; ``None`` if its number of seconds is invalid."""
        seconds = event.seconds if event.variable is None else seconds_of(values.get(event.variable))
        name = self.curie(event.iri)
        conditions = (self._one_condition(condition, values) for condition in event.conditions)
        fluents = (stated.Fluent(one.predicate, one.arguments, After(name)) for one in conditions)
        return None if seconds is None else stated.DefinedEvent(name, tuple(fluents), seconds)

    def _predicate(self, clause: Fluent | Condition) -> Predicate:
        """Return the predicate of a clause. The names in a named predicate's definition are shortened."""
        if clause.named is None:
            return self.catalog.predicates[clause.predicate]
        found = self._named_predicates.get(clause.predicate)
        if found is None:
            found = self._named_predicates[clause.predicate] = renamed(clause.named, self.curie)
        return found

    def _condition(self, clause: Fluent | TextFluent, values: Values) -> stated.Condition | None:
        return stated.joint_condition([self._one_condition(one, values) for one in clause.conditions])

    def _one_condition(self, condition: Condition, values: Values) -> stated.Condition:
        predicate = self._predicate(condition)
        slots = (slot.name for slot in predicate.slots)
        return stated.Condition(predicate, self._slots(slots, condition.arguments, values))

    def _slot(self, slot: str, term: Iri | str | None, values: Values) -> stated.Filler:
        # An incomplete graph may leave a slot empty; show its name in braces.
        if term is None:
            return f"{{{slot}}}"
        return self.filler(values.get(term, term) if isinstance(term, Iri) else term)

    def _time(self, clause: Fluent | TextFluent | TextClause, values: Values) -> TimeConstraint | None:
        """Return the time constraint of a clause; ``None`` if the value of its horizon is not a duration."""
        time = clause.time
        if isinstance(time, During):
            return replace(time, start=self.curie(time.start), end=self.curie(time.end))
        if clause.seconds is None:
            return replace(time, event=self.curie(time.event))
        value = values.get(clause.seconds)
        if isinstance(value, Placeholder):
            raise UnknownElements
        seconds = seconds_of(value)
        return None if seconds is None else replace(time, event=self.curie(time.event), horizon=seconds)

    def _without_time(self, words: str, clause: Fluent | TextFluent | TextClause, values: Values) -> stated.Text:
        """Return a clause that has no valid horizon. It becomes a text, so that nothing judges it."""
        condition = None if isinstance(clause, TextClause) else self._condition(clause, values)
        time, value = clause.time, None if clause.seconds is None else values.get(clause.seconds)
        event = self.curie(time.end if isinstance(time, During) else time.event)
        seconds = "?" if value is None else word(self.filler(value))
        relation = "before" if isinstance(time, Before) else "after"
        which = "" if isinstance(time, During) else time.which
        ending = instant_words(relation, event, seconds, time.some_time, which)
        return stated.Text(f"{words}{condition_words(condition)} {ending}", None, clause.iri)

    def _named(self, clause: Fluent | TextFluent | TextClause, values: Values) -> dict[str, object]:
        """Return the values of a clause's variables and slots, by name."""
        if clause.iri not in self.by_code:
            return {}
        slots: Mapping[str, Iri | str] = {} if isinstance(clause, TextClause) else clause.arguments
        own = {name: values.get(term, term) if isinstance(term, Iri) else term for name, term in slots.items()}
        variables = {plain_name(self.curie(variable)): value for variable, value in values.items()}
        return {name: self._value(value) for name, value in {**variables, **own}.items()}

    def _value(self, value: Value) -> object:
        match value:
            case stated.AnyOf(elements):
                return list(elements)
            case tuple():
                return [self._value(one) for one in value]
            case _:
                return self.curie(value) if isinstance(value, Iri) else value


def seconds_of(value: Value | None) -> float | None:
    """Return the value of a horizon's variable in s; ``None`` if it is not a finite number of at least 0."""
    return float(value) if isinstance(value, int | float) and isfinite(value) and value >= 0 else None


def mentions(clause: Clause, variable: Iri) -> bool:
    """Return whether a clause refers to a variable."""
    match clause:
        case Fluent() | TextFluent():
            return variable in _terms(clause) or variable == clause.seconds
        case TextClause():
            return variable == clause.seconds
        case BehaviourClause():
            return variable in clause.arguments.values()
        case Junction():
            return any(mentions(operand, variable) for operand in clause.operands)
        case ForAll() | Exists():
            return clause.in_set == variable or any(mentions(part, variable) for part in clause.clauses)
        case EventClause():
            return False


def _terms(clause: Fluent | TextFluent) -> list[Iri | str]:
    """Return the terms that fill the slots of a clause and of its conditions."""
    conditions = (one for condition in clause.conditions for one in condition.arguments.values())
    return [*clause.arguments.values(), *conditions]


def _mentions_once(clause: Clause, variable: Iri) -> bool:
    if isinstance(clause, Fluent | TextFluent):
        return _terms(clause).count(variable) == 1 and variable != clause.seconds
    return isinstance(clause, Exists) and len(clause.clauses) == 1 and _mentions_once(clause.clauses[0], variable)
