"""Make the results of two sources comparable: a study against a study, or against a run."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from robbdd_tools.campaign.matched_executions import NothingShared, execution_key
from robbdd_tools.run.report import value_word, value_words, variable_word
from robbdd_tools.workbench.comparison import Executed, changes_between

if TYPE_CHECKING:
    from robbdd_tools.campaign.run_sources import RunSource
    from robbdd_tools.workbench.comparison import ExecutionChange
    from robbdd_tools.workbench.execution_rows import ExecutionResult


def aligned(before: RunSource, after: RunSource) -> tuple[RunSource, RunSource, tuple[str, ...]]:
    """Return two sources whose executions can be matched, and what differs in their input, in words.

    Two runs are returned unchanged. In a study, the names of clauses identify them. A factor or variable that has a
    single value in each source, but a different one, is the change under examination. It is left out of the values, so
    that executions match. Raises ``NothingShared`` if only one source has a factor, with several levels.
    """
    if not (before.is_study or after.is_study):
        return before, after, ()
    one, other = _levels(before.results), _levels(after.results)
    differing = [name for name in {**one, **other} if one.get(name) != other.get(name)]
    single = [name for name in differing if len(one.get(name, "1")) == len(other.get(name, "1")) == 1]
    for name in differing:
        if name not in one or name not in other:
            _refuse_several(name, one.get(name) or other.get(name) or {}, "earlier" if name in one else "later")
    remarks = tuple(_remark(name, one.get(name), other.get(name)) for name in single)
    remarks = (*remarks, *_facts(before.facts, after.facts))
    return _without(before, single), _without(after, single), remarks


def flipped(before: RunSource, after: RunSource) -> tuple[ExecutionChange, ...]:
    """Return the executions of both sources whose verdicts differ."""
    sides = [
        {execution_key(one): Executed(_values(one), one, trace=False) for one in source.results}
        for source in (before, after)
    ]
    changes, _ = changes_between(*sides)
    return tuple(change for change in changes if change.flipped)


def _levels(results: Iterable[ExecutionResult]) -> Mapping[str, Mapping[str, object]]:
    """Return the values of each factor and variable, with their JSON text as the key."""
    found: dict[str, dict[str, object]] = {}
    for result in results:
        for name, value in result.values.items():
            found.setdefault(name, {})[json.dumps(value, sort_keys=True)] = value
    return found


def _refuse_several(name: str, levels: Mapping[str, object], side: str) -> None:
    if len(levels) > 1:
        shown = ", ".join(map(value_word, levels.values()))
        word = variable_word(name)
        raise NothingShared(
            f"only the {side} one has the factor {word}, with the levels {shown}: choose one of them, as in "
            f"FILE.study:{word}={value_word(next(iter(levels.values())))}"
        )


def _remark(name: str, before: Mapping[str, object] | None, after: Mapping[str, object] | None) -> str:
    old, new = ("none" if not one else value_word(next(iter(one.values()))) for one in (before, after))
    return f"{variable_word(name)}: {old} became {new}"


def _without(source: RunSource, names: Iterable[str]) -> RunSource:
    left = set(names)
    return replace(
        source,
        results=tuple(
            replace(
                result,
                values={name: value for name, value in result.values.items() if name not in left},
                clauses=tuple(replace(clause, iri=clause.name) for clause in result.clauses),
            )
            for result in source.results
        ),
    )


def _facts(before: Mapping[str, str], after: Mapping[str, str]) -> Iterator[str]:
    for fact, words in (("version", "RobBDD"), ("simulator", "the simulator")):
        if before.get(fact) and after.get(fact) and before[fact] != after[fact]:
            yield f"{words} {before[fact]} became {after[fact]}"


def _values(result: ExecutionResult) -> str:
    return ", ".join(value_words(name, value) for name, value in result.values.items())
