"""Clauses with their values filled in, as Gherkin steps; every sentence comes from the catalog."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from robbdd_tools.catalog.registry import Catalog
from robbdd_tools.graph.model import (
    AcceptanceModel,
    BehaviourClause,
    Cell,
    Clause,
    EventClause,
    Exists,
    Fluent,
    ForAll,
    Iri,
    Junction,
    TextClause,
    TextFluent,
)
from robbdd_tools.monitor.time import After, Before, During, TimeConstraint


@dataclass(frozen=True, slots=True)
class Step:
    """One step: keyword, text, and the clause that it states. ``role`` is ``given``, ``when`` or ``then``."""

    keyword: str
    text: str
    clause: Iri
    role: str


@dataclass(frozen=True, slots=True)
class AnyOf:
    """What an existential variable stands for: some element of a set."""

    elements: tuple[str, ...]


Filler = Cell | AnyOf


@dataclass(frozen=True, slots=True)
class StepWriter:
    """Writes the steps of clauses of one model."""

    model: AcceptanceModel
    catalog: Catalog

    def steps(self, clauses: tuple[Clause, ...], values: Mapping[Iri, Filler]) -> Iterator[Step]:
        """Yield the steps of clauses in order; ``for all`` is repeated per element, ``and`` becomes several steps."""
        for clause in clauses:
            match clause:
                case ForAll():
                    for element in self._elements(clause.in_set, values):
                        yield from self.steps(clause.clauses, {**values, clause.variable: element})
                case Exists():
                    some = AnyOf(tuple(self.word(element) for element in self._elements(clause.in_set, values)))
                    yield from self.steps(clause.clauses, {**values, clause.variable: some})
                case Junction(operator="and"):
                    yield from self.steps(clause.operands, values)
                case BehaviourClause():
                    yield Step("When", self.sentence(clause, values), clause.iri, "when")
                case EventClause():
                    yield Step("When", f'event "{self.model.curie(clause.event)}" occurs', clause.iri, "when")
                case _:
                    yield Step(clause.role.capitalize(), self.sentence(clause, values), clause.iri, clause.role)

    def sentence(self, clause: Clause, values: Mapping[Iri, Filler]) -> str:
        """Return the sentence of one clause with its values."""
        match clause:
            case Fluent():
                text = self._filled(self.catalog.predicates[clause.predicate].sentence, clause.arguments, values)
                return f"{text} {self.time(clause.time)}"
            case BehaviourClause():
                return self._filled(self.catalog.behaviours[clause.behaviour].sentence, clause.arguments, values)
            case TextFluent():
                return f"{self._filled(clause.template, clause.arguments, values)} {self.time(clause.time)}"
            case TextClause():
                return f"{_one_line(clause.text)} {self.time(clause.time)}"
            case Junction(operator="not"):
                return f"not ( {self.sentence(clause.operands[0], values)} )"
            case Junction():
                operands = f" {clause.operator} ".join(self.sentence(part, values) for part in clause.operands)
                return f"( {operands} )"
            case Exists():
                some = AnyOf(tuple(self.word(element) for element in self._elements(clause.in_set, values)))
                inner = {**values, clause.variable: some}
                return " and ".join(self.sentence(part, inner) for part in clause.clauses)
            case ForAll():
                each = ({**values, clause.variable: element} for element in self._elements(clause.in_set, values))
                return " and ".join(self.sentence(part, inner) for inner in each for part in clause.clauses)
            case EventClause():
                return f'event "{self.model.curie(clause.event)}" occurs'

    def time(self, constraint: TimeConstraint) -> str:
        """Return the words of a time constraint."""
        match constraint:
            case During(start, end):
                return f'from "{self.model.curie(start)}" until "{self.model.curie(end)}"'
            case Before(event, horizon):
                return f'{_within(horizon)}before event "{self.model.curie(event)}"'
            case After(event, horizon):
                return f'{_within(horizon)}after event "{self.model.curie(event)}"'

    def word(self, value: Filler) -> str:
        """Return a value as it stands inside the quotes of a sentence."""
        match value:
            case AnyOf(elements):
                return f"any of {list(elements)}"
            case Iri():
                return self.model.curie(value)
            case tuple():
                return str([self.word(element) for element in value])
            case _:
                return _one_line(str(value)).replace('"', "'")

    def _filled(self, sentence: str, arguments: Mapping[str, Iri | str], values: Mapping[Iri, Filler]) -> str:
        words = {
            slot: self.word(values.get(term, term) if isinstance(term, Iri) else term)
            for slot, term in arguments.items()
        }
        # Not str.format: a user's template must not reach attributes or items of our objects.
        return re.sub(r"\{(\w[\w-]*)\}", lambda match: words.get(match[1], match[0]), _one_line(sentence))

    def _elements(self, in_set: Iri, values: Mapping[Iri, Filler]) -> tuple[Cell, ...]:
        value = values.get(in_set, self.model.sets.get(in_set, ()))
        if isinstance(value, AnyOf):
            return value.elements
        return value if isinstance(value, tuple) else (value,)


def _within(horizon: float | None) -> str:
    return "" if horizon is None else f"within {horizon:g} seconds "


def _one_line(text: str) -> str:
    return " ".join(text.split())
