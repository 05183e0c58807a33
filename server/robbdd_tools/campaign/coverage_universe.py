"""Everything that a study could exercise: levels, pairs of levels, clauses, events and predicates of its models.

It is recorded when the study begins, so that its coverage does not depend on later edits of the models.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from itertools import combinations, islice
from typing import TYPE_CHECKING

from robbdd_tools.base.plain import from_plain
from robbdd_tools.gherkin.select import Selected, Wanted
from robbdd_tools.graph.acceptance_model import Fluent, ForAll, Iri, every_clause
from robbdd_tools.graph.clause_parts import named_events

if TYPE_CHECKING:
    from robbdd_tools.campaign.study_file import Study
    from robbdd_tools.graph.acceptance_model import AcceptanceModel, Cell, Clause, Variant
    from robbdd_tools.run.prepare import RunRequest

MOST_SCENARIOS = 200_000
"""Pairs are collected from at most this many scenarios of a variant."""
Level = tuple[str, str]
"""The name of a factor or variable, and a level as JSON."""


@dataclass(frozen=True, slots=True)
class CoverableClause:
    """A clause of a scenario variant, with the events and the predicates that it names."""

    variant: str
    name: str
    events: tuple[str, ...]
    predicates: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class CoverageUniverse:
    """All that a study could exercise.

    ``levels`` are pairs of a name and a level as JSON, and ``pairs`` the numbers (from 0) of two levels of different
    factors or variables that occur together in a scenario.
    """

    levels: tuple[Level, ...]
    pairs: tuple[tuple[int, int], ...]
    clauses: tuple[CoverableClause, ...]


def level_of(name: str, value: object) -> Level:
    """Return a level as it is compared."""
    return name, json.dumps(value, sort_keys=True)


def coverage_universe(study: Study) -> CoverageUniverse:
    """Return what a study could exercise: all scenarios that ``scenarios`` and ``where`` select, in all cells.

    ``first``, ``sample``, ``pairwise`` and ``stop`` make it exercise less. Variables with a range have no levels.
    """
    levels: dict[Level, int] = {}
    pairs: dict[tuple[int, int], None] = {}
    clauses: dict[tuple[str, str], CoverableClause] = {}
    ranged = {word.variable.text.rpartition(".")[2] for word in study.content.ranges}
    where = None if study.content.where is None else study.content.where.text
    cells = [[level_of(name, value) for name, value in cell.levels.items()] for cell in study.cells]
    for request in study.cells[0].plan.requests:
        for variant in (one for story in request.stories() for one in story.variants):
            for found in _clauses(request.model, variant):
                clauses.setdefault((found.variant, found.name), found)
            for values in _scenarios(request, variant, where):
                own = [level_of(name, value) for name, value in values if _local(name) not in ranged]
                for cell in cells:
                    numbers = sorted(levels.setdefault(one, len(levels)) for one in (*cell, *own))
                    pairs.update(dict.fromkeys(combinations(numbers, 2)))
    return CoverageUniverse(tuple(levels), tuple(sorted(pairs)), tuple(clauses.values()))


def universe_text(universe: CoverageUniverse) -> str:
    """Return a universe as JSON."""
    return json.dumps(asdict(universe), separators=(",", ":"))


def universe_from(text: str | None) -> CoverageUniverse | None:
    """Return the universe in a text of ``universe_text``; ``None`` if there is none."""
    if text is None:
        return None
    try:
        return from_plain(CoverageUniverse, json.loads(text))
    except (ValueError, KeyError, TypeError):
        return None


def _scenarios(request: RunRequest, variant: Variant, where: str | None) -> Iterator[Iterable[tuple[str, object]]]:
    """Yield the values of the scenarios of a variant, reduced by nothing but ``where``."""
    model = request.model
    for _, values in islice(Selected(model, [variant], Wanted(where)).scenarios(variant), MOST_SCENARIOS):
        yield [(model.curie(variable), _plain(model, cell)) for variable, cell in values.items()]


def _plain(model: AcceptanceModel, cell: Cell) -> object:
    if isinstance(cell, tuple):
        return [_plain(model, value) for value in cell]
    return model.curie(cell) if isinstance(cell, Iri) else cell


def _clauses(model: AcceptanceModel, variant: Variant) -> Iterator[CoverableClause]:
    for clause in _judged((*variant.template.clauses, *variant.clauses)):
        parts = list(every_clause([clause]))
        events = dict.fromkeys(_local(model.curie(event)) for part in parts for event in named_events(part))
        predicates = dict.fromkeys(name for part in parts for name in _predicates(model, part))
        yield CoverableClause(variant.iri, _local(model.curie(clause.iri)), tuple(events), tuple(predicates))


def _predicates(model: AcceptanceModel, clause: Clause) -> Iterator[str]:
    """Yield the predicates of a clause, each by its name in the catalog or the local name of a named predicate."""
    if isinstance(clause, Fluent):
        for one in (clause, *clause.conditions):
            yield _local(model.curie(one.predicate)) if one.named is not None else one.predicate


def _judged(clauses: Iterable[Clause]) -> Iterator[Clause]:
    """Yield the clauses that are judged by themselves: those in loops, but not the parts of groups."""
    for clause in clauses:
        if isinstance(clause, ForAll):
            yield from _judged(clause.clauses)
        else:
            yield clause


def _local(name: str) -> str:
    return name.rsplit(":", 1)[-1]
