"""The public interface runs models: results as they finish, stored runs, traces as arrays."""

from __future__ import annotations

import asyncio
import re
import shutil
from dataclasses import replace
from operator import attrgetter
from pathlib import Path

import pytest

import robbdd_tools as robbdd
from kit import DOCS, EXAMPLES
from robbdd_tools.traces.mcap_file import read_trace, write_trace
from workbench import reference

pytestmark = pytest.mark.physics


@pytest.fixture
def model(tmp_path: Path) -> robbdd.Model:
    folder = shutil.copytree(EXAMPLES / "pickplace", tmp_path / "cell")
    return robbdd.load(folder / "pickplace.bdd")


def test_the_reference_lists_every_public_name_and_signature() -> None:
    page = (DOCS / "python-reference.md").read_text(encoding="utf-8")
    assert page == reference.page(), "run .venv/bin/python tests/workbench/reference.py, and note it in the changelog"


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


def test_the_runs_of_a_folder_without_a_project_are_found_from_the_folder_above(tmp_path: Path) -> None:
    for number, name in enumerate(("one", "two"), 1):
        folder = shutil.copytree(EXAMPLES / "pickplace", tmp_path / name)
        with robbdd.load(folder / "pickplace.bdd").scenarios(first=1).run(seed=number) as run:
            run.wait()
        if number == 1:
            assert robbdd.find_run("1", tmp_path).folder == run.folder
            assert robbdd.runs(tmp_path / "one")[0].folder == run.folder
    with pytest.raises(robbdd.NoSuchRun, match="but in several folders: one, two; name one of them"):
        robbdd.runs(tmp_path)
    (tmp_path / ".robbdd" / "runs").mkdir(parents=True)
    assert robbdd.runs(tmp_path) == ()


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


@pytest.fixture
def stored(model: robbdd.Model) -> robbdd.Run:
    with model.scenarios(first=1).run(jobs=1) as run:
        return run.wait()


def edited(model: robbdd.Model, old: str, new: str) -> robbdd.Model:
    text = model.path.read_text(encoding="utf-8")
    assert old in text
    model.path.write_text(text.replace(old, new), encoding="utf-8")
    return robbdd.load(model.path)


def test_an_unchanged_model_judges_a_run_as_the_run_did(model: robbdd.Model, stored: robbdd.Run) -> None:
    judged = robbdd.judge(stored, model)
    assert judged.results == stored.results
    assert judged.rows() == stored.rows()
    assert judged.ending == ""


def test_a_judged_execution_has_its_index_in_the_run(model: robbdd.Model) -> None:
    with model.scenarios().run(jobs=2) as run:
        run.wait()
    half = edited(model, "<cubes.cube0>, <balls.ball0>", "<balls.ball0>")
    judged = robbdd.judge(run, half)
    assert [result.index for result in judged.results] == [
        result.index for result in run.results if result.values["crit:var-thing"] == "env:ball0"
    ]


def test_an_edited_clause_is_judged_on_the_stored_trace(model: robbdd.Model, stored: robbdd.Run) -> None:
    tightened = edited(model, "located at <goal>, after <evt-place-end>", "located at <goal>, before <evt-pick-start>")
    judged = asyncio.run(asyncio.to_thread(robbdd.judge, robbdd.find_run("latest", model.path), tightened))
    verdicts = {clause.name: clause.verdict for result in judged.results for clause in result.clauses}
    assert verdicts["at-goal"] is robbdd.Outcome.VIOLATED
    assert verdicts["at-source"] is robbdd.Outcome.HOLDS
    assert robbdd.find_run("latest", model.path).results == stored.results


def test_a_run_that_has_nothing_to_judge_is_refused(model: robbdd.Model) -> None:
    with (
        model.scenarios(first=1).run() as run,
        pytest.raises(robbdd.NothingToJudge, match="has finished no execution yet"),
    ):
        robbdd.judge(run, model)
    with model.scenarios(first=1).run(keeping=robbdd.Keeping(keep=False)) as gone:
        gone.wait()
    with pytest.raises(robbdd.NoSuchRun):
        robbdd.judge(gone, model)


def test_a_replay_of_a_run_has_the_same_traces(model: robbdd.Model, stored: robbdd.Run) -> None:
    replayed = robbdd.replay(stored, jobs=1)
    assert [(trace.index, trace.name, trace.difference) for trace in replayed.traces] == [
        (0, stored.results[0].name, "")
    ]
    assert replayed.is_identical
    assert replayed.simulator == robbdd.find_run("latest", model.path).record.simulator


def test_a_replay_reports_a_trace_that_differs(model: robbdd.Model, stored: robbdd.Run) -> None:
    (path,) = (stored.folder / "traces").glob("*.mcap")
    evidence = read_trace(path)
    moved = evidence.trace.positions.copy()
    moved[-1] += 1e-9
    write_trace(path, replace(evidence, trace=replace(evidence.trace, positions=moved)), [])
    replayed = robbdd.replay(robbdd.find_run("latest", model.path), jobs=1)
    assert not replayed.is_identical
    assert "position of env:" in replayed.traces[0].difference


def test_a_replay_of_a_changed_model_is_refused_unless_it_is_forced(model: robbdd.Model, stored: robbdd.Run) -> None:
    edited(model, "after <evt-place-end>", "1 seconds after <evt-place-end>")
    with pytest.raises(robbdd.CannotReplay, match="was changed since the run"):
        robbdd.replay(stored)
    assert robbdd.replay(stored, force=True).is_identical


def test_a_trace_that_is_gone_is_an_error_of_the_package(stored: robbdd.Run) -> None:
    (path,) = (stored.folder / "traces").glob("*.mcap")
    path.unlink()
    with pytest.raises(robbdd.UnreadableTrace) as caught:
        stored.trace(0)
    assert isinstance(caught.value, robbdd.RobbddError)


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
    assert "\nreplayed True\n" in printed
    assert "\njudged holds\n" in printed
    assert "\nlogged unknown (" in printed
