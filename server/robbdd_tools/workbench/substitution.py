"""Substitute other behaviours for implementations of behaviours.

A substitution maps an implementation in a ``.bddx`` (local name, CURIE or IRI) to the name of a catalog behaviour. In a
study, it may also map to another implementation of the model, in angle brackets (``<server-v2>``). If several
substitutions name the same implementation, the last one is used.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from robbdd_tools.catalog.executors import DEFAULT, EXECUTORS, executes
from robbdd_tools.gherkin.select import SelectionError
from robbdd_tools.graph.acceptance_model import Clause, Iri, behaviour_clauses

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import Implementation
    from robbdd_tools.graph.acceptance_model import AcceptanceModel, Execution
    from robbdd_tools.protocol.specs import ScenarioSpec


def parse_substitution(text: str) -> tuple[str, str]:
    """Read ``NAME=BEHAVIOUR``; raises ``SelectionError``."""
    name, equals, behaviour = (part.strip() for part in text.rpartition("="))
    if not (name and equals and behaviour) or _other(behaviour):
        raise SelectionError(f"'{text}' is not NAME=BEHAVIOUR, such as my-server=pick-place")
    return name, behaviour


def refuse_unknown(models: Iterable[AcceptanceModel], substitutions: Mapping[str, str]) -> None:
    """Raise ``SelectionError`` if no model has an implementation, or if a substitute does not exist."""
    known: set[str] = set()
    local: set[str] = set()
    others: dict[str, str] = {}
    for model in models:
        for one in model.implementations:
            others |= dict.fromkeys(_names(model, one.iri), _local(model, one.iri))
        for execution in model.executions:
            known |= _names(model, execution.implementation.iri)
            local.add(_local(model, execution.implementation.iri))
    for name, behaviour in substitutions.items():
        if name not in known:
            there_are = f"the executions use {', '.join(sorted(local))}" if local else "the model has no executions"
            raise SelectionError(f"there is no behaviour implementation '{name}'; {there_are}")
        other = _other(behaviour)
        if other and other not in others:
            listed = ", ".join(f"<{one}>" for one in sorted(set(others.values())))
            raise SelectionError(f"there is no behaviour implementation '{other}'; the model has {listed}")
        if not other and behaviour not in EXECUTORS:
            raise SelectionError(f"the catalog has no behaviour '{behaviour}'; it has {', '.join(EXECUTORS)}")


def substitute(model: AcceptanceModel, substitutions: Mapping[str, str]) -> AcceptanceModel:
    """Return a model whose executions use the substituted behaviours. Raises ``SelectionError``.

    Names that the model lacks are ignored. It is an error if the catalog lacks a behaviour, or if a behaviour cannot
    execute the behaviours of a scenario.
    """
    if not substitutions:
        return model
    executions = tuple(_substituted(model, execution, substitutions) for execution in model.executions)
    return replace(model, executions=executions)


def substitutions_of(scenarios: Iterable[ScenarioSpec]) -> dict[str, str]:
    """Map the IRI of each implementation that planned scenarios replace to the catalog behaviour."""
    executed = (spec.execution.implementation for spec in scenarios if spec.execution is not None)
    return {one.iri: one.name for one in executed if one.substitution is not None}


def _substituted(model: AcceptanceModel, execution: Execution, substitutions: Mapping[str, str]) -> Execution:
    names = _names(model, execution.implementation.iri)
    named = [behaviour for name, behaviour in substitutions.items() if name in names]
    if not named:
        return execution
    behaviour = named[-1]
    refuse_unknown([model], {execution.implementation.iri: behaviour})
    other = _named(model, _other(behaviour))
    if other is not None and other.iri == execution.implementation.iri:
        return execution
    executor = behaviour if other is None else other.name
    is_catalog = other is None or other.kind == "catalog"
    unfit = [one for one in _behaviours(model, execution.variant) if is_catalog and not executes(executor, one)]
    if unfit:
        raise SelectionError(
            f"'{executor}' of the catalog does not execute '{unfit[0]}' of {_local(model, execution.iri)}: "
            f"substitute '{DEFAULT}' for {_local(model, execution.implementation.iri)}"
        )
    return replace(execution, implementation=other or _replaced(execution.implementation, behaviour))


def _replaced(implementation: Implementation, behaviour: str) -> Implementation:
    stated = implementation.replaced or implementation.words
    return replace(implementation, kind="catalog", name=behaviour, replaced=stated)


def _other(behaviour: str) -> str:
    """Return the name of the implementation that a substitution names; empty for a catalog behaviour."""
    return behaviour[1:-1] if behaviour.startswith("<") and behaviour.endswith(">") else ""


def _named(model: AcceptanceModel, name: str) -> Implementation | None:
    return next((one for one in model.implementations if name and name in _names(model, one.iri)), None)


def _behaviours(model: AcceptanceModel, iri: Iri) -> Iterator[str]:
    for variant in (variant for story in model.stories for variant in story.variants if variant.iri == iri):
        clauses: tuple[Clause, ...] = (*variant.template.clauses, *variant.clauses)
        yield from (clause.behaviour for clause in behaviour_clauses(clauses))


def _names(model: AcceptanceModel, iri: str) -> set[str]:
    return {iri, model.curie(iri), _local(model, iri)}


def _local(model: AcceptanceModel, iri: str) -> str:
    return model.curie(iri).replace("/", ":").rpartition(":")[2]
