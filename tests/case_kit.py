"""A file system that ignores case, in place of the one at hand."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest

from robbdd_tools.base.stored_names import without_case


class CaseIgnored:
    """Lets ``os.stat``, ``os.open`` and ``os.scandir`` find files below a folder whatever their case is.

    Windows and macOS do so.
    """

    def __init__(self, monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
        self._folder = folder
        self.compared = 0
        """The number of calls of ``os.stat``."""
        self._stat, self._open, self._scandir = os.stat, os.open, os.scandir
        for name in ("stat", "open", "scandir"):
            monkeypatch.setattr(os, name, getattr(self, name))

    def stat(self, path: Any, *arguments: Any, **options: Any) -> os.stat_result:
        self.compared += 1
        return self._stat(self._found(path), *arguments, **options)

    def open(self, path: Any, *arguments: Any, **options: Any) -> int:
        return self._open(self._found(path), *arguments, **options)

    def scandir(self, path: Any = ".") -> Any:
        return self._scandir(self._found(path))

    def _found(self, path: Any) -> Any:
        if isinstance(path, int) or not Path(os.fsdecode(path)).is_relative_to(self._folder):
            return path
        place = self._folder
        for name in Path(os.fsdecode(path)).relative_to(self._folder).parts:
            stored = (other.name for other in _entries(place) if without_case(other.name) == without_case(name))
            place /= next(stored, name)
        return place


def _entries(folder: Path) -> list[Path]:
    try:
        return list(folder.iterdir())
    except OSError:
        return []
