"""Two stored runs side by side."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from robbdd_tools.run.store import NoSuchRun, RunStore
from robbdd_tools.workbench.comparison import ClauseTotals, compare
from run.recorded import CLAUSES, record_run


@pytest.fixture
def store(tmp_path: Path) -> RunStore:
    return RunStore(tmp_path / ".robbdd" / "runs")


def test_executions_that_flipped_come_first_with_their_margins(store: RunStore) -> None:
    before, after = record_run(store, [0.3, 0.2, 0.1, -0.1, 0.4]), record_run(store, [0.3, -0.2, None, 0.1])
    found = compare(before, after)
    assert (found.same, found.flipped, found.inputs) == (1, 3, ())
    flips = [(one.before and one.before.verdict, one.after and one.after.verdict) for one in found.changes]
    assert flips == [("holds", "violated"), ("holds", "unknown"), ("violated", "holds"), ("holds", None)]
    first = found.changes[0]
    (clause,) = first.clauses
    assert (clause.before, clause.after, clause.margin_before, clause.margin_after) == ("holds", "violated", 0.2, -0.2)
    assert (clause.reason, first.after and first.after.index, first.values) == ("-0.2", 1, "x = 1")
    (totals,) = found.clauses
    assert (totals.before, totals.after) == (ClauseTotals(4, 5, -0.1, "m"), ClauseTotals(2, 4, -0.2, "m"))


def test_equal_runs_have_no_changes(store: RunStore) -> None:
    found = compare(record_run(store, [0.3, None]), record_run(store, [0.2, None]))
    assert (found.same, found.changes) == (2, ())


def test_what_differs_in_the_input_is_named(store: RunStore) -> None:
    before, after = record_run(store, [0.3]), record_run(store, [0.3], seed=7)
    record = after.record()
    after.write_record(replace(record, digest="def", version="0.2.0", files={"../../../cell.scenex": "1"}))
    assert compare(before, after).inputs == (
        "the model has changed",
        "seed 1 became 7",
        "1 used file changed: cell.scenex",
        "RobBDD 0.1.0 became 0.2.0",
    )


def test_a_clause_that_only_one_run_judged_is_a_change(store: RunStore) -> None:
    found = compare(record_run(store, [0.3]), record_run(store, [0.3], clauses=CLAUSES))
    (change,) = found.changes
    (clause,) = change.clauses
    assert (clause.name, clause.before, clause.after, clause.margin_before) == ("c6", None, "holds", None)
    assert found.clauses[1].before == ClauseTotals()


def test_a_run_that_is_gone_is_reported(store: RunStore) -> None:
    before, after = record_run(store, [0.3]), record_run(store, [0.3])
    (before.folder / "manifest.json").unlink()
    with pytest.raises(NoSuchRun, match="holds no run"):
        compare(before, after)
