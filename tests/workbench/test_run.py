"""The public interface runs models: results as they finish, stored runs, traces as arrays."""

from __future__ import annotations

import asyncio
import re
import shutil
from operator import attrgetter
from pathlib import Path

import pytest

import robbdd_tools as robbdd
from kit import DOCS, EXAMPLES

pytestmark = pytest.mark.physics


@pytest.fixture
def model(tmp_path: Path) -> robbdd.Model:
    folder = shutil.copytree(EXAMPLES / "pickplace", tmp_path / "cell")
    return robbdd.load(folder / "pickplace.bdd")


def test_every_public_name_is_there() -> None:
    assert robbdd.__all__ == sorted(robbdd.__all__)
    assert all(getattr(robbdd, name) is not None for name in robbdd.__all__)
    assert {*robbdd.__all__} <= {*dir(robbdd)}
    with pytest.raises(AttributeError, match="gone"):
        attrgetter("gone")(robbdd)


def test_results_come_as_executions_finish_and_are_kept(model: robbdd.Model) -> None:
    plan = model.scenarios(first=2)
    with plan.run(seed=3, jobs=2) as run:
        finished = {result.index: result for result in run}
    assert [finished[index] for index in sorted(finished)] == list(run.results)
    assert [result.seed for result in run.results] == [spec.seed for spec in model.scenarios(first=2, seed=3).scenarios]
    assert {clause.verdict for result in run.results for clause in result.clauses} == {robbdd.Outcome.HOLDS}
    (stored,) = robbdd.runs(model.path)
    assert stored.results == run.results
    assert robbdd.find_run("latest", model.path).number == run.number


def test_a_trace_has_arrays_and_events(model: robbdd.Model) -> None:
    with model.scenarios(first=1).run() as run:
        run.wait()
    trace = run.trace(run.results[0])
    assert trace.positions.shape == (len(trace.times), len(trace.names), 3)
    assert "crit:evt-place-end" in {stamp.name for stamp in trace.events}


def test_a_row_per_clause_holds_the_values(model: robbdd.Model) -> None:
    with model.scenarios(first=1).run(keeping=robbdd.Keeping(keep=False)) as run:
        run.wait()
    rows = run.rows()
    assert len(rows) == len(run.results[0].clauses)
    assert all(row["value.crit:var-robot"] == "env:panda" for row in rows)
    assert robbdd.runs(model.path) == ()


def test_leaving_a_run_early_keeps_what_is_finished(model: robbdd.Model) -> None:
    with model.scenarios().run(jobs=1) as run:
        first = next(iter(run))
    assert run.results[first.index].verdict is first.verdict
    assert run.ending == "the run was cancelled"
    (stored,) = robbdd.runs(model.path)
    assert stored.status.state == "interrupted"
    assert stored.results == run.results


def test_a_run_can_be_awaited(model: robbdd.Model) -> None:
    async def names() -> list[str]:
        async with model.scenarios(first=2).run(jobs=1) as run:
            return [result.name async for result in run]

    assert sorted(asyncio.run(names())) == [spec.name for spec in model.scenarios(first=2).scenarios]


def test_the_examples_of_the_python_page_run(
    model: robbdd.Model, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    page = (DOCS / "python.md").read_text(encoding="utf-8")
    examples = re.findall(r"```python\n(.*?)```", page, flags=re.DOTALL)
    monkeypatch.chdir(model.path.parent)
    exec("".join(examples), {})
    printed = capsys.readouterr().out
    assert "crit:part-to-bin" in printed
    assert "finished 4 4" in printed
