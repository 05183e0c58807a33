"""Models are loaded from files, folders and texts; their errors are data with places."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit import EXAMPLES, MODEL, SCENE
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.workbench.model import ModelErrors, NothingToRun, load
from robbdd_tools.workbench.named_files import NotAModel

PICKPLACE = EXAMPLES / "pickplace" / "pickplace.bdd"


@pytest.fixture
def bench(tmp_path: Path) -> Path:
    (tmp_path / "lab.scene").write_text(SCENE, encoding="utf-8")
    path = tmp_path / "bench.bdd"
    path.write_text(MODEL, encoding="utf-8")
    return path


def test_a_sound_model_has_scenarios_and_no_error() -> None:
    model = load(PICKPLACE)
    assert model.is_valid
    assert [file.name for file in model.files] == [str(PICKPLACE)]
    assert len(model.scenarios()) == 4


def test_an_error_has_file_line_column_and_code(bench: Path) -> None:
    bench.write_text(MODEL.replace("<parts.bolt>", "<parts.bolr>").replace("obj set <parts>", "{ <parts.bolr> }"))
    model = load(bench)
    (error,) = [finding for finding in model.diagnostics if finding.is_error]
    line = next(n for n, text in enumerate(bench.read_text().splitlines(), start=1) if "bolr" in text)
    assert (error.place.path, error.place.line, error.code) == (bench, line, "unknown-name")
    column = bench.read_text().splitlines()[line - 1].index("parts.bolr") + 1
    assert error.place.column in (column, column + len("parts."))
    assert str(error).startswith(f"{error.place}: error: ")


def test_a_fix_carries_its_edits(bench: Path) -> None:
    bench.write_text(MODEL.replace("obj set <parts>", "obj set <part>"))
    (error,) = [finding for finding in load(bench).diagnostics if finding.is_error]
    (edit,) = error.fixes[0].edits
    assert edit.text == "parts"
    assert edit.place.path == bench
    assert error.as_json()["fixes"][0]["edits"][0]["text"] == "parts"


def test_a_model_with_errors_is_not_planned(bench: Path) -> None:
    bench.write_text(MODEL.replace("obj set <parts>", "obj set <part>"))
    with pytest.raises(ModelErrors, match="unknown-name") as caught:
        load(bench).scenarios()
    assert [finding.severity for finding in caught.value.findings] == [Severity.ERROR]


def test_a_text_replaces_the_file_and_finds_its_imports(bench: Path) -> None:
    bench.unlink()
    assert len(load(bench, text=MODEL).scenarios()) == 4


def test_a_folder_is_all_its_models_with_executions_first() -> None:
    model = load(EXAMPLES / "pickplace")
    assert [Path(file.name).suffix for file in model.runnable] == [".bddx", ".bdd"]
    with pytest.raises(ValueError, match="cannot be loaded together"):
        model.graph()


def test_a_graph_is_a_model_too(bench: Path, tmp_path: Path) -> None:
    graph = tmp_path / "bench.ttl"
    graph.write_text(load(bench).graph("ttl"), encoding="utf-8")
    assert [one.variation for one in load(graph).scenarios().scenarios] == [1, 2, 3, 4]


@pytest.mark.parametrize(("name", "reason"), [("gone.bdd", "file-missing"), ("scene.scene", "no scenario to run")])
def test_what_cannot_be_run_is_an_exception_with_the_reason(tmp_path: Path, name: str, reason: str) -> None:
    (tmp_path / "scene.scene").write_text(SCENE, encoding="utf-8")
    with pytest.raises((ModelErrors, NothingToRun), match=reason):
        load(tmp_path / name).scenarios()


def test_a_file_of_another_kind_is_refused(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("", encoding="utf-8")
    with pytest.raises(NotAModel, match="its name must end in one of"):
        load(tmp_path / "notes.txt")
    with pytest.raises(NotAModel, match="there is no file or folder"):
        load(tmp_path / "gone")
    (tmp_path / "empty").mkdir()
    with pytest.raises(NotAModel, match="there is no model in"):
        load(tmp_path / "empty")
