"""Determine which behaviour executions belong to one iteration of a ``for all`` clause."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from robbdd_tools.gherkin.steps import Reach, Scope, Step
from robbdd_tools.protocol.clauses import BehaviourCall


def behaviour_scopes(steps: Iterable[Step]) -> list[Scope]:
    """Return the scopes of a scenario's behaviour steps in execution order. The behaviours of a When share one."""
    return list(dict.fromkeys(step.scope for step in steps if isinstance(step.statement, BehaviourCall)))


def iterations_of(scope: Scope, behaviours: Sequence[Scope], reach: Reach = None) -> tuple[int, ...]:
    """Return the numbers (from 1) of the first and the last iteration in the scope and the reach of a step.

    If the scope contains no behaviour, the nearest outer scope that contains one is used. The result is empty if the
    scenario has a single iteration, because all events of the scenario belong to it. If the parts in the step's reach
    contain no behaviour, because all their loops are over empty sets, the numbers denote no iteration.
    """
    if reach is not None:
        first, last = reach
        depth = len(scope)
        reached = [
            number
            for number, other in enumerate(behaviours, start=1)
            if other[:depth] == scope and first <= other[depth][1] <= last
        ]
        if not reached:
            return len(behaviours) + 1, len(behaviours) + 1
        return (reached[0], reached[-1]) if len(behaviours) > 1 else ()
    if len(behaviours) < 2:
        return ()
    while True:
        inside = [number for number, other in enumerate(behaviours, start=1) if other[: len(scope)] == scope]
        if inside:
            return inside[0], inside[-1]
        scope = scope[:-1]
