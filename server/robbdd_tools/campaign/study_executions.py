"""The stored executions of a study as results, so that code that reads runs can also read studies."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import groupby
from typing import Any

from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.workbench.execution_rows import ClauseResult, ExecutionResult

_LEVEL = "level."


def study_executions(rows: Iterable[Mapping[str, Any]]) -> tuple[ExecutionResult, ...]:
    """Return the executions in the ``rows`` of a study's store, in their order.

    The ``index`` of each is its number in the study minus 1. A study stores no IRIs of clauses, so their names replace
    the IRIs. The study's factors are among the values.
    """
    return tuple(_executions(rows))


def _executions(rows: Iterable[Mapping[str, Any]]) -> Iterator[ExecutionResult]:
    for number, group in groupby(rows, key=lambda row: int(row["number"])):
        clauses = list(group)
        first = clauses[0]
        yield ExecutionResult(
            number - 1,
            first["scenario"],
            "",
            first["variant"],
            first["variation"],
            first["repetition"],
            first["execution"],
            "",
            {name.removeprefix(_LEVEL): value for name, value in first.items() if name.startswith(_LEVEL)},
            first["seed"],
            Outcome(first["scenario_verdict"]),
            first["duration"],
            tuple(map(_clause, clauses)),
        )


def _clause(row: Mapping[str, Any]) -> ClauseResult:
    return ClauseResult(
        row["clause"],
        row["clause"],
        "",
        "",
        Outcome(row["verdict"]),
        row["margin"],
        row["unit"],
        row["at"],
        None,
        row["reason"],
        "",
    )
