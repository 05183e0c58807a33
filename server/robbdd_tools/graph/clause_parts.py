"""The parts of a body (a When or a ``for all``, and the Given and Then around it), and the events of clauses."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from robbdd_tools.graph.acceptance_model import BehaviourClause, Clause, EventClause, ForAll, Iri, behaviour_clauses


def part_numbers(clauses: Iterable[Clause]) -> tuple[int, ...]:
    """Return the number of the part (from 0) to which each clause of a body belongs.

    A Given clause belongs to the part after it, and a Then clause to the part before it. The behaviours of a When and
    the events before them are one part. A Given clause after the last part gets the next number,
    although there is no such part.
    """
    return tuple(_numbers(clauses))


def _numbers(clauses: Iterable[Clause]) -> Iterator[int]:
    number, is_when, has_behaviour = -1, False, False
    for clause in clauses:
        match clause:
            case ForAll():
                number, is_when, has_behaviour = number + 1, False, True
                yield number
            case BehaviourClause() | EventClause():
                if not is_when:
                    number, is_when, has_behaviour = number + 1, True, False
                has_behaviour = has_behaviour or isinstance(clause, BehaviourClause)
                yield number
            case _:
                is_when = is_when and not has_behaviour
                yield number + 1 if clause.role == "given" and not is_when else max(number, 0)


def count_of_parts(clauses: Iterable[Clause], numbers: Iterable[int]) -> int:
    """Return the number of parts of a body. ``numbers`` are the part numbers of its clauses."""
    whens = (number for clause, number in zip(clauses, numbers, strict=True) if is_when_clause(clause))
    return max(whens, default=-1) + 1


def is_when_clause(clause: Clause) -> bool:
    """Return whether a clause is a behaviour, an event of a When, or a loop. All other clauses are conditions."""
    return isinstance(clause, BehaviourClause | EventClause | ForAll)


def with_siblings(clauses: Sequence[Clause]) -> tuple[Clause, ...]:
    """Return the clauses of a template. If there are several behaviours, they are marked."""
    several = len(list(behaviour_clauses(clauses))) > 1
    return tuple(map(_marked, clauses)) if several else tuple(clauses)


def whens_of(clauses: Iterable[Clause]) -> Iterator[tuple[BehaviourClause, ...]]:
    """Yield the behaviours of each When of a body and of the bodies in its loops, in written order."""
    clauses = tuple(clauses)
    found: dict[int, tuple[BehaviourClause, ...]] = {}
    for clause, number in zip(clauses, part_numbers(clauses), strict=True):
        if isinstance(clause, BehaviourClause):
            found[number] = (*found.get(number, ()), clause)
    yield from found.values()
    for clause in clauses:
        if isinstance(clause, ForAll):
            yield from whens_of(clause.clauses)


def _marked(clause: Clause) -> Clause:
    match clause:
        case BehaviourClause():
            return replace(clause, has_siblings=True)
        case ForAll():
            return replace(clause, clauses=tuple(map(_marked, clause.clauses)))
        case _:
            return clause


def named_events(clause: Clause) -> Iterator[Iri]:
    """Yield the events of a clause's time constraint, or the event of an event clause."""
    if isinstance(clause, EventClause):
        yield clause.event
    time = getattr(clause, "time", None)
    for name in ("event", "start", "end"):
        event = getattr(time, name, None)
        if event is not None:
            yield Iri(event)
