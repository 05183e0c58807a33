"""Clauses with their values filled in, as Gherkin steps; every sentence comes from the catalog."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Kind
from robbdd_tools.gherkin import text
from robbdd_tools.graph.acceptance_model import (
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

if TYPE_CHECKING:
    from robbdd_tools.catalog.registry import Catalog


@dataclass(frozen=True, slots=True)
class Step:
    """One step: keyword, text, and the clause that it states. ``role`` is ``given``, ``when`` or ``then``.

    ``parts`` are the fluents and texts of a group, in the order of the text; nothing for a clause that stands alone.
    ``source`` is what it was written from. ``scope`` is the iterations that it belongs to, outermost first.
    """

    keyword: str
    text: str
    clause: Iri
    role: str
    parts: tuple[Iri, ...] = ()
    source: Bound | None = field(default=None, compare=False, repr=False)
    scope: Scope = ()


@dataclass(frozen=True, slots=True)
class AnyOf:
    """What an existential variable, or a set as a place, stands for: some element of a set."""

    elements: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Placeholder:
    """What a variable stands for in a Scenario Outline: the name of its column."""

    name: str


Filler = Cell | AnyOf | Placeholder
Bound = tuple[Clause, Mapping[Iri, Filler]]
"""A clause with what its variables stand for."""
Scope = tuple[tuple[Iri, int], ...]
"""Iterations of ``for all``, outermost first: the quantifier and the number of its element, from 0."""


class UnknownElements(Exception):
    """A set whose elements a Scenario Outline leaves open would have to be gone through."""


@dataclass(frozen=True, slots=True)
class StepWriter:
    """Writes the steps of clauses of one model."""

    model: AcceptanceModel
    catalog: Catalog
    _curies: dict[str, str] = field(default_factory=dict[str, str])

    def curie(self, iri: str) -> str:
        """Return the short form of an IRI; a model has few and writes them often."""
        found = self._curies.get(iri)
        if found is None:
            found = self._curies[iri] = self.model.curie(iri)
        return found

    def steps(self, clauses: tuple[Clause, ...], values: Mapping[Iri, Filler], scope: Scope = ()) -> Iterator[Step]:
        """Yield the steps of clauses in order; ``for all`` is repeated per element, ``and`` becomes several steps."""
        for clause in clauses:
            match clause:
                case ForAll():
                    for index, element in enumerate(self.elements(clause.in_set, values)):
                        inner = (*scope, (clause.iri, index))
                        yield from self.steps(clause.clauses, {**values, clause.variable: element}, inner)
                case Exists() if self._is_one_choice(clause, values):
                    yield from self.steps(clause.clauses, self._some(clause, values), scope)
                case Junction(operator="and"):
                    yield from self.steps(clause.operands, values, scope)
                case BehaviourClause() | EventClause():
                    yield Step("When", self.sentence(clause, values), clause.iri, "when", (), (clause, values), scope)
                case _:
                    alone = isinstance(clause, Fluent | TextFluent | TextClause)
                    parts = () if alone else tuple(part.iri for part, _ in self.parts(clause, values))
                    sentence, bound = self.sentence(clause, values), (clause, values)
                    yield Step(clause.role.capitalize(), sentence, clause.iri, clause.role, parts, bound, scope)

    def sentence(self, clause: Clause, values: Mapping[Iri, Filler], *, within: bool = False) -> str:
        """Return the sentence of one clause with its values; ``within`` tells that it is a part of a group."""
        match clause:
            case Fluent():
                filled = self._filled(self.catalog.predicates[clause.predicate].sentence, clause.arguments, values)
                return f"{filled} {self.time(clause.time)}"
            case BehaviourClause():
                behaviour = self.catalog.behaviours[clause.behaviour]
                places = [clause.arguments.get(slot.name) for slot in behaviour.slots if slot.kind is Kind.WORKSPACE]
                any_place = {place: self._any_of(place, values) for place in places if isinstance(place, Iri)}
                return self._filled(behaviour.sentence, clause.arguments, {**values, **any_place})
            case TextFluent():
                filled = self._filled(text.free(clause.template), clause.arguments, values)
                return f"{text.guarded(filled) if within else filled} {self.time(clause.time)}"
            case TextClause():
                words = text.free(clause.text)
                return f"{text.guarded(words) if within else words} {self.time(clause.time)}"
            case EventClause():
                return f'event "{self.curie(clause.event)}" occurs'
            case Junction(operator="not"):
                return f"not ( {self._joined('and', clause.operands, values)} )"
            case Junction():
                return f"( {self._joined(clause.operator, clause.operands, values)} )"
            case Exists() if self._is_one_choice(clause, values):
                return self._all_of(clause.clauses, self._some(clause, values))
            case Exists():
                return self._grouped(
                    "or", [self._all_of(clause.clauses, inner) for inner in self._each(clause, values)]
                )
            case ForAll():
                return self._grouped(
                    "and", [self._all_of(clause.clauses, inner) for inner in self._each(clause, values)]
                )

    def parts(self, clause: Clause, values: Mapping[Iri, Filler]) -> Iterator[Bound]:
        """Yield the fluents and texts of a clause as often as its sentence states them."""
        match clause:
            case Junction():
                inner = [(operand, values) for operand in clause.operands]
            case Exists() if self._is_one_choice(clause, values):
                inner = [(part, self._some(clause, values)) for part in clause.clauses]
            case Exists() | ForAll():
                inner = [(part, each) for each in self._each(clause, values) for part in clause.clauses]
            case _:
                yield clause, values
                return
        for part, bound in inner:
            yield from self.parts(part, bound)

    def time(self, constraint: TimeConstraint) -> str:
        """Return the words of a time constraint."""
        match constraint:
            case During(start, end):
                return f'from "{self.curie(start)}" until "{self.curie(end)}"'
            case Before(event, horizon):
                return f'{_within(horizon)}before event "{self.curie(event)}"'
            case After(event, horizon):
                return f'{_within(horizon)}after event "{self.curie(event)}"'

    def word(self, value: Filler) -> str:
        """Return a value as it stands inside the quotes of a sentence."""
        match value:
            case Iri():
                return self.curie(value)
            case str():
                return text.inside_quotes(value)
            case AnyOf(elements):
                return f"any of {text.set_inside_quotes(elements)}"
            case Placeholder(name):
                return f"<{name}>"
            case tuple():
                return text.set_inside_quotes(self._plain(element) for element in value)
            case _:
                return str(value)

    def elements(self, in_set: Iri, values: Mapping[Iri, Filler]) -> tuple[Cell, ...]:
        """Return the elements of a set: the value of a variable, or a constant set; raises ``UnknownElements``."""
        match values.get(in_set, self.model.sets.get(in_set, ())):
            case AnyOf(elements):
                return elements
            case Placeholder():
                raise UnknownElements
            case tuple() as several:
                return several
            case one:
                return (one,)

    def _joined(self, operator: str, parts: tuple[Clause, ...], values: Mapping[Iri, Filler]) -> str:
        return f" {operator} ".join(self.sentence(part, values, within=True) for part in parts)

    def _all_of(self, parts: tuple[Clause, ...], values: Mapping[Iri, Filler]) -> str:
        return self._grouped("and", [self.sentence(part, values, within=True) for part in parts])

    def _grouped(self, operator: str, sentences: list[str]) -> str:
        return sentences[0] if len(sentences) == 1 else f"( {f' {operator} '.join(sentences)} )"

    def _some(self, exists: Exists, values: Mapping[Iri, Filler]) -> Mapping[Iri, Filler]:
        elements = tuple(self._plain(element) for element in self.elements(exists.in_set, values))
        return {**values, exists.variable: AnyOf(elements)}

    def _any_of(self, place: Iri, values: Mapping[Iri, Filler]) -> Filler:
        """Return what a place stands for; of a set, a behaviour chooses any element."""
        value = values.get(place, self.model.sets.get(place, place))
        return AnyOf(tuple(map(self._plain, value))) if isinstance(value, tuple) else value

    def _each(self, quantified: Exists | ForAll, values: Mapping[Iri, Filler]) -> Iterator[Mapping[Iri, Filler]]:
        for element in self.elements(quantified.in_set, values):
            yield {**values, quantified.variable: element}

    def _is_one_choice(self, exists: Exists, values: Mapping[Iri, Filler]) -> bool:
        """Whether *any of* in one place says all: otherwise each choice has to be written out and joined by *or*.

        One element must satisfy all clauses, and "some element is not there" is not "it is not any of them".
        """
        if not self.elements(exists.in_set, values):
            return True
        about = [clause for clause in exists.clauses if mentions(clause, exists.variable)]
        return not about or (len(about) == 1 and _mentions_once(about[0], exists.variable))

    def _plain(self, value: Filler) -> str:
        return self.curie(value) if isinstance(value, Iri) else str(value)

    def _filled(self, sentence: str, arguments: Mapping[str, Iri | str], values: Mapping[Iri, Filler]) -> str:
        parts = _slots(sentence)
        filled = list(parts)
        for index in range(1, len(parts), 2):
            term = arguments.get(parts[index])
            if term is None:
                filled[index] = f"{{{parts[index]}}}"
            else:
                filled[index] = self.word(values.get(term, term) if isinstance(term, Iri) else term)
        return "".join(filled)


def mentions(clause: Clause, variable: Iri) -> bool:
    """Tell whether a clause speaks of a variable."""
    match clause:
        case Fluent() | TextFluent() | BehaviourClause():
            return variable in clause.arguments.values()
        case Junction():
            return any(mentions(operand, variable) for operand in clause.operands)
        case ForAll() | Exists():
            return clause.in_set == variable or any(mentions(part, variable) for part in clause.clauses)
        case TextClause() | EventClause():
            return False


def _mentions_once(clause: Clause, variable: Iri) -> bool:
    if isinstance(clause, Fluent | TextFluent):
        return list(clause.arguments.values()).count(variable) == 1
    return isinstance(clause, Exists) and len(clause.clauses) == 1 and _mentions_once(clause.clauses[0], variable)


# Not str.format: a user's template must not reach attributes or items of our objects.
@cache
def _slots(sentence: str) -> tuple[str, ...]:
    """Split a sentence at its ``{slots}``: words and names of slots in turn."""
    return tuple(re.split(r"\{(\w[\w-]*)\}", sentence))


def _within(horizon: float | None) -> str:
    return "" if horizon is None else f"within {repr(horizon).removesuffix('.0')} seconds "
