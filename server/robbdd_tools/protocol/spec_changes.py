"""Compare a scenario with its stored execution: find changes, except of clauses, that make the trace no evidence."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from typing import TYPE_CHECKING, Any, cast

from robbdd_tools.monitor.time import occurrences
from robbdd_tools.protocol.clauses import EventOccurrence, Fluent, Junction, Text, leaves_of, to_plain

if TYPE_CHECKING:
    from robbdd_tools.catalog.coordination import TreeSpec
    from robbdd_tools.protocol.specs import ClauseSpec, ScenarioSpec

AGAIN = "execute a new run"
"""Instruction for the case that a stored trace is no evidence."""
CHANGED = f"{{}} changed since the run: {AGAIN}"
_POSITIONS = frozenset({"origin"})
"""Source positions, which move with every edit."""
_OF_RUN = frozenset({"origin", "name", "lead", "tail"})
"""Ignored fields of a behaviour tree: also its name within a run, and times that follow from windows of clauses."""


def change_of(spec: ScenarioSpec, stored: ScenarioSpec) -> str:
    """Return the reason why a stored trace is no evidence for an edited scenario; empty if it is evidence.

    Only data is compared, so edits of comments and layout change nothing. The two scenarios have the same variant,
    values, execution and repetition.
    """
    return content_change(spec, stored) or seed_change(spec, stored)


def content_change(spec: ScenarioSpec, stored: ScenarioSpec) -> str:
    """Return the part of ``change_of`` that is the same for all repetitions of a scenario."""
    for name, same in _comparisons(spec, stored):
        if not same:
            return CHANGED.format(name)
    return ""


def seed_change(spec: ScenarioSpec, stored: ScenarioSpec) -> str:
    """Return the part of ``change_of`` that concerns the seed."""
    # A scenario with a changed number has another seed, but its trace still shows an execution of it.
    same = spec.variation != stored.variation or spec.seed == stored.seed
    return "" if same else CHANGED.format("the seed")


def without_repetition(spec: ScenarioSpec) -> ScenarioSpec:
    """Return a scenario without its number, its seed and its place: the result is equal for all its repetitions."""
    return replace(spec, feature="", line=0, name="", seed=0, repetition=1)


def edited_clauses(spec: ScenarioSpec, stored: ScenarioSpec) -> tuple[ClauseSpec, ...]:
    """Return the clauses of a scenario with content, iterations or policies that differ from its stored execution.

    If one of several clauses with the same IRI differs, all of them are returned. Behaviours are left out, because
    ``change_of`` compares them.
    """
    now, then = _by_iri(spec), _by_iri(stored)
    behaviours = {clause.iri for clause in _behaviours(spec)}
    edited = (clause for clause in spec.clauses if now[clause.iri] != then.get(clause.iri))
    return tuple(clause for clause in edited if clause.iri not in behaviours)


def _comparisons(spec: ScenarioSpec, stored: ScenarioSpec) -> Iterator[tuple[str, bool]]:
    yield "the scene", _bare(spec.scene) == _bare(stored.scene)
    yield "the scene instance", _bare(spec.instance) == _bare(stored.instance)
    yield "the behaviour tree", (_tree(spec.tree), spec.node) == (_tree(stored.tree), stored.node)
    yield "the behaviour", _same_behaviours(spec, stored)
    now, then = spec.execution, stored.execution
    if now is not None and then is not None:
        yield "the implementation of the behaviour", _bare(now.implementation) == _bare(then.implementation)
        yield "the time limit", now.timeout == then.timeout


def _same_behaviours(spec: ScenarioSpec, stored: ScenarioSpec) -> bool:
    now, then = _behaviours(spec), _behaviours(stored)
    # Earlier versions stored only the sentences.
    if all(clause.statement is not None for clause in (*now, *then)):
        return list(map(_content, now)) == list(map(_content, then))
    return [clause.sentence for clause in now] == [clause.sentence for clause in then]


def _behaviours(spec: ScenarioSpec) -> list[ClauseSpec]:
    """Return the clauses of a scenario that execute a behaviour, in execution order."""
    clauses = (clause for clause in spec.clauses if clause.role == "when")
    return [clause for clause in clauses if not isinstance(clause.statement, EventOccurrence)]


def _content(clause: ClauseSpec) -> object:
    return clause.sentence if clause.statement is None else _bare(to_plain(clause.statement))


def _by_iri(spec: ScenarioSpec) -> dict[str, list[object]]:
    policies = {} if spec.execution is None else {policy.clause: policy for policy in spec.execution.policies}
    defined = {event.name: _bare(event) for event in spec.defined}
    found: dict[str, list[object]] = {}
    for clause in spec.clauses:
        own = [_bare(policies[iri]) for iri in (clause.parts or (clause.iri,)) if iri in policies]
        found.setdefault(clause.iri, []).append(
            (clause.role, _content(clause), list(clause.iterations), own, _events(clause, defined))
        )
    return found


def _events(clause: ClauseSpec, defined: Mapping[str, object]) -> list[object]:
    """Return the definitions of the events that a clause names."""
    names: set[str] = set()
    match clause.statement:
        case EventOccurrence(event):
            names = {event}
        case Fluent() | Text() | Junction() as stated:
            times = [leaf.time for leaf in leaves_of(stated) if leaf.time is not None]
            names = {event for time in times for event, _ in occurrences(time)}
        case _:
            pass
    return [defined[name] for name in sorted(names) if name in defined]


def _tree(tree: TreeSpec | None) -> object:
    return None if tree is None else _bare(tree, _OF_RUN)


def _bare(value: Any, ignored: frozenset[str] = _POSITIONS) -> object:
    """Return data in a form in which data from a file and data in memory are equal, without the ``ignored`` fields."""
    if is_dataclass(value) and not isinstance(value, type):
        kept = (entry.name for entry in fields(value) if entry.name not in ignored)
        return {name: _bare(getattr(value, name)) for name in kept}
    if isinstance(value, Mapping):
        entries = cast("Mapping[str, Any]", value).items()
        return {name: _bare(entry) for name, entry in entries}
    if isinstance(value, tuple | list):
        return [_bare(entry) for entry in cast("tuple[Any, ...]", value)]
    return value
