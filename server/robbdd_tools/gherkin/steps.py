"""Write clauses with their values as Gherkin steps. Every sentence is taken from the catalog."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robbdd_tools.gherkin import text
from robbdd_tools.gherkin.binding import Binder, UnknownElements, Value, Values
from robbdd_tools.gherkin.definition_words import meaning, predicate_words, whenever_words
from robbdd_tools.gherkin.words import filled, word
from robbdd_tools.graph.acceptance_model import (
    AcceptanceModel,
    BehaviourClause,
    Clause,
    DefinedEvent,
    EventClause,
    Exists,
    Fluent,
    ForAll,
    Iri,
    Junction,
    TextFluent,
    every_clause,
)
from robbdd_tools.graph.clause_parts import count_of_parts, is_when_clause, part_numbers
from robbdd_tools.protocol import clauses as stated
from robbdd_tools.protocol.clauses import MEANWHILE
from robbdd_tools.protocol.time_words import time_words

if TYPE_CHECKING:
    from robbdd_tools.catalog.registry import Catalog

Scope = tuple[tuple[Iri, int], ...]
"""Iterations of ``for all``, outermost first. Each one is a quantifier and the index (from 0) of its element.

If a body has several parts, a pair of ``PART`` and the part's number (from 0) precedes the iterations in that part.
"""
PART = Iri("")
Reach = tuple[int, int] | None


@dataclass(frozen=True, slots=True)
class Step:
    """One Gherkin step: its keyword, its text and its clause.

    - ``role``: ``given``, ``when`` or ``then``.
    - ``statement``: the content of the text as data.
    - ``source``: the clause of the model, and the values of its variables.
    - ``scope``: the iterations of ``for all`` that contain the step, outermost first.
    - ``reach``: the first and the last part of the body that the step concerns; ``None`` for all. A Given clause
      concerns the parts after it, and a Then clause the parts before it.
    """

    keyword: str
    text: str
    clause: Iri
    role: str
    statement: stated.Statement = field(compare=False, repr=False)
    source: tuple[Clause, Values] = field(compare=False, repr=False)
    scope: Scope = ()
    reach: Reach = None


class StepWriter:
    """Writes the steps of one model's clauses.

    If ``expanded`` is true, the definitions of named predicates replace their phrases.
    """

    def __init__(self, model: AcceptanceModel, catalog: Catalog, *, expanded: bool = False) -> None:
        self.model = model
        self.expanded = expanded
        self._binder = Binder(model, catalog)

    def curie(self, iri: str) -> str:
        """Return the short form of an IRI."""
        return self._binder.curie(iri)

    def steps(self, clauses: Collection[Clause], values: Values, scope: Scope = ()) -> Iterator[Step]:
        """Yield the steps of some clauses in order.

        The clauses of a ``for all`` are repeated for each element, and an ``and`` is split into several steps.
        """
        numbers = part_numbers(clauses)
        count = count_of_parts(clauses, numbers)
        for clause, number in zip(clauses, numbers, strict=True):
            inner = (*scope, (PART, number)) if count > 1 and is_when_clause(clause) else scope
            match clause:
                case ForAll():
                    for index, element in enumerate(self._binder.elements(clause.in_set, values)):
                        own = {**values, clause.variable: element}
                        yield from self.steps(clause.clauses, own, (*inner, (clause.iri, index)))
                case BehaviourClause() | EventClause():
                    yield self._step("when", clause, values, inner)
                case _:
                    yield from self._conditions(clause, values, scope, _reach(clause.role, number, count))

    def _conditions(self, clause: Clause, values: Values, scope: Scope, reach: Reach) -> Iterator[Step]:
        """Yield the steps of a Given or Then clause."""
        match clause:
            case Exists() if self._binder.is_one_choice(clause, values):
                values, parts = self._binder.some(clause, values), clause.clauses
            case Junction(operator="and"):
                parts = clause.operands
            case ForAll() | BehaviourClause() | EventClause():
                raise TypeError("a When clause cannot be part of a group")
            case _:
                yield self._step(clause.role, clause, values, scope, reach)
                return
        for part in parts:
            yield from self._conditions(part, values, scope, reach)

    def definition(self, event: DefinedEvent, values: Values) -> str:
        """Return the definition of an event as a sentence, or an empty text if its number of seconds is invalid."""
        found = self._binder.defined_event(event, values)
        if found is None:
            return ""
        conditions = " and ".join(
            predicate_words(one.predicate, one.arguments, expanded=self.expanded) for one in found.conditions
        )
        lasting = f" for {found.seconds:g} seconds" if found.seconds else ""
        return f'event "{found.name}" occurs when {conditions}{lasting}'

    def meanings(self, clauses: Collection[Clause], events: Iterable[DefinedEvent], values: Values) -> tuple[str, ...]:
        """Return the meaning of each phrase of a named predicate in some clauses and events, once for each phrase."""
        if not any(_uses_named(clause) for clause in every_clause(clauses)) and not any(
            one.named for event in events for one in event.conditions
        ):
            return ()
        defined = (self._binder.defined_event(event, values) for event in events)
        stated_ones = [fluent for event in defined if event is not None for fluent in event.conditions]
        for step in self._known_steps(clauses, values):
            if not isinstance(step.statement, stated.BehaviourCall | stated.EventOccurrence):
                stated_ones += stated.fluents_of(step.statement)
        found: dict[str, None] = {}
        for fluent in stated_ones:
            conditions = [] if fluent.condition is None else fluent.condition.parts
            for one in (fluent, *conditions):
                found |= dict.fromkeys(meaning(one.predicate, one.arguments, expanded=self.expanded))
        return tuple(found)

    def _known_steps(self, clauses: Collection[Clause], values: Values) -> Iterator[Step]:
        """Yield steps until one needs unknown elements. In a Scenario Outline, a set may vary."""
        with suppress(UnknownElements):
            yield from self.steps(clauses, values)

    def sentence(self, clause: Clause, values: Values) -> str:
        """Return the sentence of one clause with the values of its variables."""
        return sentence(self._binder.bind(clause, values), expanded=self.expanded)

    def word(self, value: Value) -> str:
        """Return a value as written inside the quotes of a sentence."""
        return word(self._binder.filler(value))

    def _step(self, role: str, clause: Clause, values: Values, scope: Scope, reach: Reach = None) -> Step:
        statement = self._binder.bind(clause, values)
        words = sentence(statement, expanded=self.expanded)
        return Step(role.capitalize(), words, clause.iri, role, statement, (clause, values), scope, reach)


def _reach(role: str, number: int, count: int) -> Reach:
    """Return the parts that a clause concerns. ``number`` is the clause's own part, ``count`` the number of parts."""
    if role == "given":
        return (number, count - 1) if 0 < number < count else None
    return (0, number) if number < count - 1 else None


def _uses_named(clause: Clause) -> bool:
    conditions = clause.conditions if isinstance(clause, Fluent | TextFluent) else ()
    return any(one.named is not None for one in conditions) or (isinstance(clause, Fluent) and clause.named is not None)


def sentence(statement: stated.Statement, *, within: bool = False, expanded: bool = False) -> str:
    """Return the sentence of a statement. ``within`` is true if the sentence is a part of a group.

    If ``expanded`` is true, the definitions of named predicates replace their phrases.
    """
    match statement:
        case stated.Fluent(predicate, arguments, time):
            words = predicate_words(predicate, arguments, expanded=expanded)
            return f"{words}{whenever_words(statement.condition, expanded=expanded)} {time_words(time)}"
        case stated.Text(words, time):
            shown = text.in_group(words) if within else words
            shown += whenever_words(statement.condition, expanded=expanded)
            return shown if time is None else f"{shown} {time_words(time)}"
        case stated.Junction("not", operands):
            return f"not ( {sentence(operands[0], within=True, expanded=expanded)} )"
        case stated.Junction(operator, operands):
            parts = (sentence(operand, within=True, expanded=expanded) for operand in operands)
            return f"( {f' {operator} '.join(parts)} )"
        case stated.BehaviourCall(behaviour, arguments):
            return f"{MEANWHILE if statement.is_meanwhile else ''}{filled(behaviour.sentence, arguments)}"
        case stated.EventOccurrence(event):
            return f'event "{event}" occurs'
