"""Write clauses with their values as Gherkin steps. Every sentence is taken from the catalog."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robbdd_tools.gherkin import text
from robbdd_tools.gherkin.binding import Binder, Value, Values
from robbdd_tools.gherkin.words import condition_words, filled, word
from robbdd_tools.graph.acceptance_model import (
    AcceptanceModel,
    BehaviourClause,
    Clause,
    DefinedEvent,
    EventClause,
    Exists,
    ForAll,
    Iri,
    Junction,
)
from robbdd_tools.protocol import clauses as stated
from robbdd_tools.protocol.clauses import MEANWHILE
from robbdd_tools.protocol.time_words import time_words

if TYPE_CHECKING:
    from robbdd_tools.catalog.registry import Catalog

Scope = tuple[tuple[Iri, int], ...]
"""Iterations of ``for all``, outermost first: the quantifier and the index of its element, from 0."""


@dataclass(frozen=True, slots=True)
class Step:
    """One Gherkin step: its keyword, its text and its clause.

    - ``role``: ``given``, ``when`` or ``then``.
    - ``statement``: the content of the text as data.
    - ``source``: the clause of the model, and the values of its variables.
    - ``scope``: the iterations of ``for all`` that contain the step, outermost first.
    """

    keyword: str
    text: str
    clause: Iri
    role: str
    statement: stated.Statement = field(compare=False, repr=False)
    source: tuple[Clause, Values] = field(compare=False, repr=False)
    scope: Scope = ()


class StepWriter:
    """Writes the steps of one model's clauses."""

    def __init__(self, model: AcceptanceModel, catalog: Catalog) -> None:
        self.model = model
        self._binder = Binder(model, catalog)

    def curie(self, iri: str) -> str:
        """Return the short form of an IRI."""
        return self._binder.curie(iri)

    def steps(self, clauses: Collection[Clause], values: Values, scope: Scope = ()) -> Iterator[Step]:
        """Yield the steps of some clauses in order.

        The clauses of a ``for all`` are repeated for each element, and an ``and`` is split into several steps.
        """
        for clause in clauses:
            match clause:
                case ForAll():
                    for index, element in enumerate(self._binder.elements(clause.in_set, values)):
                        inner = (*scope, (clause.iri, index))
                        yield from self.steps(clause.clauses, {**values, clause.variable: element}, inner)
                case Exists() if self._binder.is_one_choice(clause, values):
                    yield from self.steps(clause.clauses, self._binder.some(clause, values), scope)
                case Junction(operator="and"):
                    yield from self.steps(clause.operands, values, scope)
                case BehaviourClause() | EventClause():
                    yield self._step("when", clause, values, scope)
                case _:
                    yield self._step(clause.role, clause, values, scope)

    def definition(self, event: DefinedEvent, values: Values) -> str:
        """Return the definition of an event as a sentence; empty if its number of seconds has no valid value."""
        found = self._binder.defined_event(event, values)
        if found is None:
            return ""
        conditions = " and ".join(filled(one.predicate.sentence, one.arguments) for one in found.conditions)
        lasting = f" for {found.seconds:g} seconds" if found.seconds else ""
        return f'event "{found.name}" occurs when {conditions}{lasting}'

    def sentence(self, clause: Clause, values: Values) -> str:
        """Return the sentence of one clause with the values of its variables."""
        return sentence(self._binder.bind(clause, values))

    def word(self, value: Value) -> str:
        """Return a value as written inside the quotes of a sentence."""
        return word(self._binder.filler(value))

    def _step(self, role: str, clause: Clause, values: Values, scope: Scope) -> Step:
        statement = self._binder.bind(clause, values)
        return Step(role.capitalize(), sentence(statement), clause.iri, role, statement, (clause, values), scope)


def sentence(statement: stated.Statement, *, within: bool = False) -> str:
    """Return the sentence of a statement. ``within`` is true if the sentence is a part of a group."""
    match statement:
        case stated.Fluent(predicate, arguments, time):
            return f"{filled(predicate.sentence, arguments)}{condition_words(statement.condition)} {time_words(time)}"
        case stated.Text(words, time):
            shown = (text.in_group(words) if within else words) + condition_words(statement.condition)
            return shown if time is None else f"{shown} {time_words(time)}"
        case stated.Junction("not", operands):
            return f"not ( {sentence(operands[0], within=True)} )"
        case stated.Junction(operator, operands):
            return f"( {f' {operator} '.join(sentence(operand, within=True) for operand in operands)} )"
        case stated.BehaviourCall(behaviour, arguments):
            return f"{MEANWHILE if statement.is_meanwhile else ''}{filled(behaviour.sentence, arguments)}"
        case stated.EventOccurrence(event):
            return f'event "{event}" occurs'
