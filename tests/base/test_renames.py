"""Renaming files that other programs have open, as Windows and as POSIX do it."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from robbdd_tools.base import renames
from robbdd_tools.base.writing import replace_file


@pytest.fixture
def opened(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], list[Path]]:
    """Let another program have files open for so many attempts to replace them; returns the attempts."""
    real = Path.replace

    def open_for(attempts: int) -> list[Path]:
        tried: list[Path] = []

        def replace(source: Path, target: Path) -> Path:
            tried.append(target)
            if len(tried) <= attempts:
                raise PermissionError(13, "The process cannot access the file", str(source))
            return real(source, target)

        monkeypatch.setattr(Path, "replace", replace)
        return tried

    return open_for


def test_windows_waits_for_a_program_that_has_a_file_open(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, opened: Callable[[int], list[Path]]
) -> None:
    monkeypatch.setattr(sys, "platform", "win32")
    path = tmp_path / "m.bdd"
    path.write_text("old")
    tried = opened(3)
    replace_file(path, "new")
    assert (len(tried), path.read_text()) == (4, "new")


def test_windows_reports_a_file_that_stays_open_and_leaves_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, opened: Callable[[int], list[Path]]
) -> None:
    monkeypatch.setattr(sys, "platform", "win32")
    monkeypatch.setattr(renames, "PATIENCE", 0.1)
    path = tmp_path / "m.bdd"
    path.write_text("old")
    tried = opened(10**9)
    with pytest.raises(PermissionError, match="cannot access") as raised:
        replace_file(path, "new")
    assert len(tried) > 1
    assert raised.value.filename == str(path)
    assert [entry.name for entry in tmp_path.iterdir()] == ["m.bdd"]
    assert path.read_text() == "old"


def test_elsewhere_a_refused_permission_is_reported_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, opened: Callable[[int], list[Path]]
) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    tried = opened(10**9)
    with pytest.raises(PermissionError):
        replace_file(tmp_path / "m.bdd", "new")
    assert len(tried) == 1
