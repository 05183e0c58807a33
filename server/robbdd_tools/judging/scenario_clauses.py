"""Prepare the clauses of a scenario for judgement, with its policies and the iterations of ``for all``."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from robbdd_tools.catalog.coordination import each_emitter
from robbdd_tools.judging.parsed_sentences import fluent_pattern, read_step
from robbdd_tools.judging.phrases_by_kind import with_fitting_predicates
from robbdd_tools.judging.policies import with_policies
from robbdd_tools.monitor.compound import definition_of
from robbdd_tools.monitor.time import in_iterations
from robbdd_tools.protocol.clauses import BehaviourCall, EventOccurrence, Fluent, Junction, Text, leaves_of
from robbdd_tools.protocol.specs import SceneSpec
from robbdd_tools.protocol.time_words import FIRST_WORDING, WORDING

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Predicate
    from robbdd_tools.protocol.clauses import Clause, Statement
    from robbdd_tools.protocol.specs import ClauseSpec, ScenarioSpec

NO_SCENE = SceneSpec()


def statement_of(known: ClauseSpec) -> Statement | None:
    """Return the statement of a clause in the manifest.

    If an earlier version stored only the sentence, the sentence is parsed.
    """
    return known.statement or _with_iris(read_step(known.role, known.sentence, FIRST_WORDING), known)


def stated_by_step(
    role: str,
    text: str,
    known: ClauseSpec | None,
    wording: int = WORDING,
    named: Sequence[Predicate] = (),
    scene: SceneSpec = NO_SCENE,
) -> Statement | None:
    """Return the statement of a step.

    This is the statement of ``known``, the clause of the step's line. If the sentence was edited, the sentence is
    parsed by the version ``wording`` of the feature, with the predicates ``named`` that the model defines. The elements
    of ``scene`` decide between predicates with the same words.
    """
    if known is not None and known.sentence == text:
        return statement_of(known)
    read = with_fitting_predicates(read_step(role, text, wording, named), scene)
    return read if known is None else _with_iris(read, known)


def is_free_text(statement: Statement | None, text: str) -> bool:
    """Return whether the text of a step is no sentence of the catalog, so that behave has no step for it.

    A fluent with a predicate of the catalog may also be written as free text.
    """
    if isinstance(statement, Fluent) and definition_of(statement.predicate) is None:
        return re.fullmatch(fluent_pattern(statement.predicate), text) is None
    return isinstance(statement, Text)


def judged_clause(clause: Clause, known: ClauseSpec | None, spec: ScenarioSpec) -> Clause:
    """Return a clause with the policies of the scenario's execution and the events of the clause's iterations."""
    found = with_policies(clause, spec)
    return found if known is None else _in_iterations(found, known, iterations_of_events(spec))


def clause_of(known: ClauseSpec, spec: ScenarioSpec) -> Clause:
    """Return a Given or Then clause of the manifest in the form needed to judge it.

    Raises ``TypeError`` for a When clause.
    """
    statement = statement_of(known)
    if statement is None or isinstance(statement, BehaviourCall | EventOccurrence):
        raise TypeError(f"{known.sentence} is a When clause")
    return judged_clause(statement, known, spec)


def named_predicates(statements: Iterable[Statement | None]) -> tuple[Predicate, ...]:
    """Return the predicates that a model defines and statements use, one for each sentence."""
    found: dict[str, Predicate] = {}
    for statement in statements:
        fluents = (
            () if statement is None or isinstance(statement, BehaviourCall | EventOccurrence) else leaves_of(statement)
        )
        for leaf in fluents:
            parts = [part.predicate for part in leaf.condition.parts] if leaf.condition is not None else []
            for one in (*([leaf.predicate] if isinstance(leaf, Fluent) else []), *parts):
                if definition_of(one) is not None:
                    found.setdefault(one.sentence, one)
    return tuple(found.values())


def behaviour_calls(spec: ScenarioSpec) -> list[tuple[BehaviourCall, ClauseSpec]]:
    """Return the behaviours of a scenario in execution order, each with its clause."""
    statements = ((statement_of(clause), clause) for clause in spec.clauses if clause.role == "when")
    return [(statement, clause) for statement, clause in statements if isinstance(statement, BehaviourCall)]


def iteration_of(known: ClauseSpec | None) -> int:
    """Return the iteration of a behaviour; 0 for any iteration."""
    return known.iterations[0] if known is not None and known.iterations else 0


def iterations_of_events(spec: ScenarioSpec) -> Mapping[str, Collection[int]]:
    """Map events to the iterations in which behaviours emit them.

    Events that may occur in every iteration, such as those of the scenario itself, are left out.
    """
    executed: dict[str, set[int]] = {}
    for call, clause in behaviour_calls(spec):
        if call.part and clause.iterations:
            executed.setdefault(call.part, set()).add(clause.iterations[0])
    found: dict[str, set[int]] = {}
    for event, emitters in spec.events.items() if executed else ():
        parts = [one.partition(" ")[0] for one in each_emitter(emitters)]
        if all(part in executed for part in parts):
            found[event] = set().union(*(executed[part] for part in parts))
    return found


def iteration_of_event(event: str, known: ClauseSpec | None, spec: ScenarioSpec) -> int:
    """Return the iteration in which a When clause expects an event; 0 for any iteration.

    It is the first iteration in the scope of the clause in which a behaviour emits the event, if there is any.
    """
    if known is None or not known.iterations:
        return 0
    first, last = known.iterations[0], known.iterations[-1]
    return min((one for one in iterations_of_events(spec).get(event, ()) if first <= one <= last), default=first)


def _with_iris(statement: Statement | None, known: ClauseSpec) -> Statement | None:
    """Return the statement of a parsed sentence in which the fluents and texts have the IRIs of ``known``, in order."""
    if isinstance(statement, BehaviourCall) and isinstance(known.statement, BehaviourCall):
        own = known.statement
        return replace(statement, part=own.part, start=own.start, end=own.end)
    if statement is None or isinstance(statement, BehaviourCall | EventOccurrence):
        return statement
    return _named(statement, iter(known.parts or (known.iri,)))


def _named(clause: Clause, iris: Iterator[str]) -> Clause:
    if isinstance(clause, Junction):
        return replace(clause, operands=tuple(_named(operand, iris) for operand in clause.operands))
    return replace(clause, iri=next(iris, ""))


def _in_iterations(clause: Clause, known: ClauseSpec, emitting: Mapping[str, Collection[int]]) -> Clause:
    if isinstance(clause, Junction):
        return replace(clause, operands=tuple(_in_iterations(operand, known, emitting) for operand in clause.operands))
    if clause.time is None:
        return clause
    return replace(clause, time=in_iterations(clause.time, known.role, known.iterations, emitting))
