"""Clauses as a scenario states them: their sentence, with its policies and the occurrences of events it refers to."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from robbdd_tools.judging.parsed_sentences import Clause, Fluent, Junction, Unmatched, read_clause
from robbdd_tools.judging.policies import with_policies
from robbdd_tools.monitor.time import in_iterations

if TYPE_CHECKING:
    from robbdd_tools.protocol.specs import ClauseSpec, ScenarioSpec


def stated_clause(text: str, stated: ClauseSpec | None, spec: ScenarioSpec) -> Clause:
    """Return the Given or Then clause of a sentence; ``stated`` is what the manifest says of it, if anything."""
    clause = with_policies(read_clause(text), stated, spec)
    return clause if stated is None else _within(clause, stated)


def stated_iteration(stated: ClauseSpec | None) -> int:
    """Return the iteration in which a When clause expects its event, 0 for any."""
    return stated.iterations[0] if stated is not None and stated.iterations else 0


def _within(clause: Clause, stated: ClauseSpec) -> Clause:
    match clause:
        case Fluent():
            return replace(clause, time=in_iterations(clause.time, stated.role, stated.iterations))
        case Junction():
            return replace(clause, operands=tuple(_within(operand, stated) for operand in clause.operands))
        case Unmatched():
            return clause
