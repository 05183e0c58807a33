"""Set up the execution of a scenario: its behaviours, its times, and the execution that related scenarios share."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from robbdd_tools.agent.behaviour_calls import TIMEOUT, Call, Timing
from robbdd_tools.agent.behaviour_run import BehaviourRun
from robbdd_tools.catalog.api import Kind
from robbdd_tools.catalog.contacts import TOUCH
from robbdd_tools.judging.quantities import fluents_with_quantity
from robbdd_tools.judging.scenario_clauses import iteration_of, statement_of
from robbdd_tools.monitor.time import After, Before
from robbdd_tools.protocol.clauses import AnyOf, BehaviourCall, Clause, EventOccurrence, Statement, fluents_of
from robbdd_tools.world.errors import SceneError

if TYPE_CHECKING:
    from robbdd_tools.protocol.specs import ClauseSpec, ScenarioSpec

LEAD = 0.5
"""Minimum time (s) between the scenario's start and its first behaviour."""
KEPT = 8
"""This many courses are kept for further scenarios. A dropped course is simulated again, bit-identical."""


class SharedExecutions:
    """The executions that several scenarios share. There is one for each execution of a behaviour tree."""

    def __init__(self) -> None:
        self._kept: dict[str, BehaviourRun] = {}
        self.reported: set[str] = set()
        """Elements already reported as not simulated, or as simulated by an unspecific model."""

    def course(self, spec: ScenarioSpec, calls: Sequence[Call], timing: Timing) -> BehaviourRun:
        """Return the ``BehaviourRun`` of a scenario, a new one unless the scenario shares an earlier one.

        Raises ``SceneError``.
        """
        if spec.tree is None:
            return BehaviourRun(spec, calls, timing)
        course = self._kept.pop(spec.tree.name, None) or BehaviourRun(spec, calls, timing)
        self._kept[spec.tree.name] = course
        while len(self._kept) > KEPT:
            del self._kept[next(iter(self._kept))]
        return course


def calls_of(spec: ScenarioSpec) -> list[Call]:
    """Return the behaviours of a scenario or, if it has a behaviour tree, the tree's behaviours with known arguments.

    Raises the ``SceneError`` of ``call_of``.
    """
    if spec.tree is not None:
        return [Call(leaf.behaviour, leaf.arguments) for leaf in spec.tree.leaves() if leaf.behaviour]
    return calls_in_order((statement_of(clause), clause) for clause in spec.clauses)


def calls_in_order(steps: Iterable[tuple[Statement | None, ClauseSpec | None]]) -> list[Call]:
    """Return the behaviours among the steps of a scenario, each with the events that it awaits.

    A step has a clause, unless a person added the step. In a When with one behaviour, events are observed, not awaited.
    Raises ``SceneError``.
    """
    found: list[Call] = []
    awaited: tuple[str, ...] = ()
    for statement, known in steps:
        match statement:
            case EventOccurrence(event):
                awaited = (*awaited, event)
            case BehaviourCall():
                call = replace(call_of(statement), iteration=iteration_of(known) or (1 if statement.part else 0))
                found.append(replace(call, awaited=awaited) if call.part else call)
                awaited = ()
            case _:
                pass
    return found


def call_of(call: BehaviourCall) -> Call:
    """Return a behaviour in the form in which it is executed.

    A place may be a set, from which the behaviour chooses an element. Raises ``SceneError`` for an empty set, and for a
    set in any other slot.
    """
    arguments: dict[str, str | tuple[str, ...]] = {}
    for slot in call.behaviour.slots:
        filler = call.arguments[slot.name]
        found = filler.elements if isinstance(filler, AnyOf) else filler
        if not isinstance(found, str) and slot.kind is not Kind.WORKSPACE:
            raise SceneError(f"'{call.behaviour.name}' needs one {slot.name}, not a set of them")
        if not found:
            raise SceneError(f"'{call.behaviour.name}' has no {slot.name} to choose: the set is empty")
        arguments[slot.name] = found
    return Call(call.behaviour.name, arguments, call.part, call.is_meanwhile)


def timing_of(spec: ScenarioSpec, clauses: Iterable[Clause]) -> Timing:
    """Return times that leave room for the windows of all clauses of the scenario or of its behaviour tree.

    Scenarios that share an execution record the contact forces that the clauses of the first scenario need.
    """
    clauses = (*clauses, *(condition for event in spec.defined for condition in event.conditions))
    lead, tail = (LEAD, 0.0) if spec.tree is None else (spec.tree.lead, spec.tree.tail)
    for clause in clauses if spec.tree is None else ():
        for fluent in fluents_of(clause):
            match fluent.time:
                case Before(_, float(horizon)):
                    lead = max(lead, horizon)
                case After(_, float(horizon)):
                    tail = max(tail, horizon)
                case _:
                    pass
    timeout = None if spec.execution is None else spec.execution.timeout
    touching = frozenset(
        str(arguments[slot])
        for clause in clauses
        for _, arguments in fluents_with_quantity(clause, TOUCH)
        for slot in ("one", "other")
        if slot in arguments
    )
    return Timing(lead, tail, timeout or TIMEOUT, touching)
