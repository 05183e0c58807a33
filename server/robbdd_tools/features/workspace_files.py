"""Find the model files below folders on disk, whether or not they are open."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from itertools import islice
from pathlib import Path

from robbdd_tools.base.files import path_to_uri, uri_to_path
from robbdd_tools.base.limits import SCANNED_DEPTH, SCANNED_ENTRIES
from robbdd_tools.names.index import language_of

MAX_FILES = 5_000
"""Maximum number of model files per workspace."""
MAX_FOLDERS = 200
"""Maximum number of folders searched around a file outside of the workspace's folders."""
_PASSED_OVER = frozenset({"node_modules", "__pycache__", "build", "dist"})


def model_files(folders: Iterable[str]) -> list[str]:
    """Return the URIs of the model files below some folders, in alphabetical order. Hidden folders are skipped."""
    found: dict[str, None] = {}
    for folder in folders:
        path = uri_to_path(folder)
        for uri in _below(path, language_of) if path is not None else ():
            found.setdefault(uri)
            if len(found) == MAX_FILES:
                return sorted(found)
    return sorted(found)


def model_files_near(uri: str) -> list[str]:
    """Return the model files in the folder of a file and below it, sorted. At most ``MAX_FOLDERS`` folders are read."""
    return files_near(uri, language_of)


def files_near(uri: str, wanted: Callable[[str], object]) -> list[str]:
    """Return the files with wanted names in the folder of a file and below it, as ``model_files_near`` does."""
    path = uri_to_path(uri)
    return sorted(_below(path.parent, wanted, MAX_FOLDERS)) if path is not None else []


def _below(folder: Path, wanted: Callable[[str], object], most_folders: int | None = None) -> Iterator[str]:
    entries = 0
    for place, inner, names in islice(os.walk(folder), most_folders):
        entries += len(inner) + len(names)
        if entries > SCANNED_ENTRIES.value():
            return
        deep = len(Path(place).parts) - len(folder.parts) >= SCANNED_DEPTH.value()
        inner[:] = sorted(name for name in inner if not (deep or name.startswith(".") or name in _PASSED_OVER))
        for name in sorted(names):
            if wanted(name):
                yield path_to_uri(Path(place) / name)
