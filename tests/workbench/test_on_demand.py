"""Single scenarios are executed in the order in which they are asked for, and recorded at once."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from kit import EXAMPLES
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.database import DatabaseProblem
from robbdd_tools.run.recording import Recording
from robbdd_tools.run.store import StoredRun, store_beside
from robbdd_tools.workbench.model import load
from robbdd_tools.workbench.on_demand import CannotRecord, OnDemand, end_run
from robbdd_tools.workbench.plan import Plan

pytestmark = pytest.mark.physics


@pytest.fixture
def plan(tmp_path: Path) -> Plan:
    folder = shutil.copytree(EXAMPLES / "pickplace", tmp_path / "cell")
    return load(folder / "pickplace.bdd").scenarios()


@pytest.fixture
def place(plan: Plan) -> StoredRun:
    assert plan.path is not None
    return store_beside(plan.path).begin()


def test_any_order_gives_the_results_of_a_run(plan: Plan, place: StoredRun) -> None:
    with OnDemand.begin(plan, place) as on_demand:
        found = {index: on_demand.execute(index).result for index in (3, 0)}
        assert place.status().counts == {"holds": 2}
        found |= {index: on_demand.execute(index).result for index in (1, 2)}
    results = end_run(place, "stopped")
    assert results.complete
    with plan.run() as run:
        run.wait()
    assert [found[index].clauses for index in range(4)] == [result.clauses for result in run.results]


def test_a_scenario_is_executed_again_when_it_is_asked_for_again(plan: Plan, place: StoredRun) -> None:
    with OnDemand.begin(plan, place) as on_demand:
        first, second = on_demand.execute(1), on_demand.execute(1)
    assert first.result.clauses == second.result.clauses
    assert end_run(place, "stopped").scenarios[0].judged
    assert place.status().finished == 1


def test_a_process_joins_a_run_that_another_one_began(plan: Plan, place: StoredRun) -> None:
    with OnDemand.begin(plan, place) as first, OnDemand.join(place, first_agent=1001) as second:
        assert first.execute(0).result.verdict is second.execute(1).result.verdict is Outcome.HOLDS
    results = end_run(place, "stopped")
    assert [scenario.verdict for scenario in results.scenarios] == [*["holds"] * 2, *["unknown"] * 2]
    assert results.ending == "stopped"
    assert place.status().state == "interrupted"
    assert place.record().simulator.startswith("MuJoCo")
    assert sorted(path.name for path in (place.folder / "logs").iterdir()) == ["agent-1.log", "agent-1001.log"]


def test_a_scenario_that_no_agent_begins_is_unknown(plan: Plan, place: StoredRun) -> None:
    with OnDemand.begin(plan, place) as on_demand:
        (place.folder / "manifest.json").write_text("{", encoding="utf-8")
        executed = on_demand.execute(0)
    assert {clause.verdict for clause in executed.result.clauses} == {Outcome.UNKNOWN}
    assert "the manifest" in executed.result.clauses[0].reason
    assert executed.result.duration is None


def test_a_result_that_cannot_be_recorded_is_not_a_result(
    plan: Plan, place: StoredRun, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise DatabaseProblem(place.database, "the disk is full")

    with OnDemand.begin(plan, place) as on_demand:
        monkeypatch.setattr(Recording, "_write", full)
        with pytest.raises(CannotRecord, match="the disk is full"):
            on_demand.execute(0)
        monkeypatch.undo()
        with pytest.raises(CannotRecord, match="the disk is full"):
            on_demand.execute(1)
    assert place.status().finished == 0, "nothing is executed after that"
