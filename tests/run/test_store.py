"""Stored runs: numbered folders in the models' project, in limited number."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from robbdd_tools.run.store import KEPT, NoSuchRun, RunRecord, RunStore, project_root, shown_path, store_beside

RECORD = RunRecord("m.bdd", "../../../m.bdd", "abc", 1, "0.1.0", "MuJoCo 4")


def test_runs_are_numbered_and_found_by_number_name_or_folder(tmp_path: Path) -> None:
    store = RunStore(tmp_path / "deep" / "runs")
    assert store.runs() == []
    first, second = store.begin(), store.begin()
    assert [run.number for run in store.runs()] == [1, 2]
    first.write_record(RECORD)
    assert (store.find("1"), store.find("latest"), store.find("2")) == (first, second, second)
    elsewhere = store.find(str(first.folder))
    assert (elsewhere, elsewhere.record()) == (first, RECORD)


def test_the_oldest_runs_make_room(tmp_path: Path) -> None:
    store = RunStore(tmp_path)
    for _ in range(KEPT + 3):
        run = store.begin()
        run.write_record(RECORD)
        run.write_results({"complete": True, "scenarios": []})
        assert run.lock is not None
        run.lock.release()
    # A live run does not count as completed.
    assert [run.number for run in store.runs()] == list(range(3, KEPT + 4))


def test_an_unknown_run_is_answered_with_the_known_ones(tmp_path: Path) -> None:
    store = RunStore(tmp_path)
    with pytest.raises(NoSuchRun, match="it has none"):
        store.find("latest")
    store.begin()
    with pytest.raises(NoSuchRun, match=r"there is no run '7' in .*; it has 1"):
        store.find("7")


def test_a_reader_meets_no_document_that_is_half_written(tmp_path: Path) -> None:
    run = RunStore(tmp_path).begin()
    run.write_results({"number": 1})
    with (run.folder / "results.json").open(encoding="utf-8") as reader:
        run.write_results({"number": 2})
        assert json.load(reader) == {"number": 1}
    assert run.results() == {"number": 2}


def test_what_is_not_whole_is_explained(tmp_path: Path) -> None:
    run = RunStore(tmp_path).begin()
    with pytest.raises(NoSuchRun, match=r"holds no finished run: there is no run\.json"):
        run.record()
    (run.folder / "run.json").write_text("[]")
    with pytest.raises(NoSuchRun, match="is not an object"):
        run.record()
    (run.folder / "run.json").write_text('{"a": 1}')
    with pytest.raises(NoSuchRun, match="is not the record of a run"):
        run.record()
    with pytest.raises(NoSuchRun, match="holds no run"):
        run.manifest()


@pytest.mark.parametrize("mark", ["pyproject.toml", "robbdd.toml", ".git"])
def test_the_store_lies_at_the_root_of_the_project(tmp_path: Path, mark: str) -> None:
    models = tmp_path / "models" / "cell"
    models.mkdir(parents=True)
    (tmp_path / mark).touch()
    model = models / "m.bdd"
    assert store_beside(model).folder == tmp_path / ".robbdd" / "runs"
    assert shown_path(model) == "models/cell/m.bdd"
    assert project_root(models) == tmp_path


def test_a_path_by_way_of_another_project_leads_to_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("here", "there"):
        (tmp_path / name).mkdir()
    (tmp_path / "here" / "pyproject.toml").touch()
    (tmp_path / "there" / "m.bdd").touch()
    monkeypatch.chdir(tmp_path / "here")
    model = Path("..") / "there" / "m.bdd"
    assert project_root(model) == tmp_path / "there"
    assert shown_path(model) == "m.bdd"


def test_without_a_project_it_lies_beside_the_model(tmp_path: Path) -> None:
    assert store_beside(tmp_path / "m.bdd").folder == tmp_path / ".robbdd" / "runs"
