"""The verdicts on one clause in all stored runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from robbdd_tools.run.clause_history import clause_history
from robbdd_tools.run.store import RunStore
from run.recorded import CLAUSES, record_run


@pytest.fixture
def store(tmp_path: Path) -> RunStore:
    return RunStore(tmp_path / ".robbdd" / "runs")


def test_each_run_counts_its_verdicts_and_names_its_worst_execution(store: RunStore) -> None:
    record_run(store, [0.3, 0.1, 0.2])
    record_run(store, [0.3, -0.2, -0.1, None])
    record_run(store, [None, 0.5])
    found = clause_history(store.database, CLAUSES[0].iri)
    assert [(one.run, one.holding, one.total, one.verdict) for one in found] == [
        (1, 3, 3, "holds"),
        (2, 1, 4, "violated"),
        (3, 1, 2, "unknown"),
    ]
    assert [(one.margin, one.unit, one.worst) for one in found] == [(0.1, "m", 1), (-0.2, "m", 1), (0.5, "m", 0)]
    assert all(one.began for one in found)


def test_runs_that_did_not_judge_the_clause_are_left_out(store: RunStore) -> None:
    assert clause_history(store.database, CLAUSES[0].iri) == []
    record_run(store, [0.3], clauses=CLAUSES[1:])
    record_run(store, [0.3])
    assert [one.run for one in clause_history(store.database, CLAUSES[0].iri)] == [2]
    assert [one.run for one in clause_history(store.database, CLAUSES[1].iri)] == [1]


def test_a_clause_that_is_repeated_within_an_execution_counts_once_with_its_worst_verdict(store: RunStore) -> None:
    first, second = CLAUSES
    record_run(store, [0.3], clauses=(first, type(second)(9, first.iri, "again", "then", "s")))
    (found,) = clause_history(store.database, first.iri)
    assert (found.total, found.holding) == (1, 1)
