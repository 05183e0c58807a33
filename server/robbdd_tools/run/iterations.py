"""Find the behaviour executions of a clause's iteration of ``for all``."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from robbdd_tools.gherkin.steps import Scope, Step
from robbdd_tools.protocol.clauses import BehaviourCall


def behaviour_scopes(steps: Iterable[Step]) -> list[Scope]:
    """Return the scope of each behaviour step of a scenario, in execution order."""
    return [step.scope for step in steps if isinstance(step.statement, BehaviourCall)]


def iterations_of(scope: Scope, behaviours: Sequence[Scope]) -> tuple[int, ...]:
    """Return the numbers (from 1) of the first and last behaviour in a scope, or in the nearest outer scope with any.

    Returns nothing for a scenario with a single behaviour: all its events belong to it.
    """
    if len(behaviours) < 2:
        return ()
    while True:
        inside = [number for number, other in enumerate(behaviours, start=1) if other[: len(scope)] == scope]
        if inside:
            return inside[0], inside[-1]
        scope = scope[:-1]
