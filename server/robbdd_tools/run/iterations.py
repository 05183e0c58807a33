"""Which executions of behaviours a clause of a scenario refers to: those of its iteration of ``for all``."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from robbdd_tools.gherkin.steps import Scope, Step
from robbdd_tools.protocol.clauses import BehaviourCall


def behaviour_scopes(steps: Iterable[Step]) -> list[Scope]:
    """Return the scope of each behaviour among the steps of a scenario, in the order in which they are executed."""
    return [step.scope for step in steps if isinstance(step.statement, BehaviourCall)]


def iterations_of(scope: Scope, behaviours: Sequence[Scope]) -> tuple[int, ...]:
    """Return the numbers, from 1, of the first and last behaviour in a scope, or in the next one around that has any.

    Nothing for a scenario with a single behaviour: every event of it is meant.
    """
    if len(behaviours) < 2:
        return ()
    while True:
        inside = [number for number, other in enumerate(behaviours, start=1) if other[: len(scope)] == scope]
        if inside:
            return inside[0], inside[-1]
        scope = scope[:-1]
