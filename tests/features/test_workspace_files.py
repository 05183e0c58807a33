"""The search for model files ends at its limits."""

from __future__ import annotations

from pathlib import Path

import pytest

from robbdd_tools.base.limits import SCANNED_DEPTH, SCANNED_ENTRIES
from robbdd_tools.features import workspace_files
from robbdd_tools.features.workspace_files import model_files, model_files_near


def test_a_search_ends_at_the_number_of_entries(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for number in range(4):
        (tmp_path / f"f{number}").mkdir()
        (tmp_path / f"f{number}" / "lab.scene").touch()
    assert len(model_files([tmp_path.as_uri()])) == 4
    # Four folders, and one file in each of the two that are read.
    monkeypatch.setenv(SCANNED_ENTRIES.variable, "6")
    assert len(model_files([tmp_path.as_uri()])) == 2


def test_a_search_enters_folders_to_a_depth(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    deep = tmp_path
    for _ in range(5):
        deep /= "inner"
        deep.mkdir()
        (deep / "lab.scene").touch()
    assert len(model_files([tmp_path.as_uri()])) == 5
    monkeypatch.setenv(SCANNED_DEPTH.variable, "3")
    assert len(model_files([tmp_path.as_uri()])) == 3


def test_a_search_ends_at_the_number_of_model_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for number in range(4):
        (tmp_path / f"lab{number}.scene").touch()
    monkeypatch.setattr(workspace_files, "MAX_FILES", 3)
    assert len(model_files([tmp_path.as_uri()])) == 3


def test_a_search_around_a_file_reads_a_number_of_folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for number in range(4):
        (tmp_path / f"f{number}").mkdir()
        (tmp_path / f"f{number}" / "lab.scene").touch()
    monkeypatch.setattr(workspace_files, "MAX_FOLDERS", 3)
    # The file's own folder and two others.
    assert len(model_files_near((tmp_path / "main.bdd").as_uri())) == 2


def test_a_link_that_leads_back_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "lab.scene").touch()
    (tmp_path / "loop").symlink_to(tmp_path, target_is_directory=True)
    assert model_files([tmp_path.as_uri()]) == [(tmp_path / "lab.scene").as_uri()]
