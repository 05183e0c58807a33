"""The texts of files that models name: Python code, steps, and descriptions of robots (MJCF, URDF).

Analysis reads an editor's unsaved text instead of the file. Runs always read the file.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path

from robbdd_tools.base.files import FileState, UnreadableFile, file_state, load_bytes, load_text, path_to_uri, too_large
from robbdd_tools.base.limits import SOURCE_SIZE


@dataclass(slots=True)
class _Editor:
    """The unsaved texts by the real paths of their files. Each text has a number that is never used again."""

    texts: Mapping[str, tuple[int, str]] = field(default_factory=dict[str, tuple[int, str]])
    numbers: count[int] = field(default_factory=lambda: count(1))

    def at(self, path: Path) -> tuple[int, str] | None:
        return self.texts.get(_key(path)) if self.texts else None


_EDITOR = _Editor()


def use_unsaved(texts: Mapping[Path, str]) -> None:
    """Use these texts instead of the contents of their files, until the next call."""
    known = _EDITOR.texts
    found: dict[str, tuple[int, str]] = {}
    for path, text in texts.items():
        key = _key(path)
        before = known.get(key)
        found[key] = before if before is not None and before[1] == text else (next(_EDITOR.numbers), text)
    _EDITOR.texts = found


def source_state(path: Path) -> FileState | None:
    """Return a key for the current text of a file, as ``file_state`` does for a file on disk."""
    unsaved = _EDITOR.at(path)
    if unsaved is None:
        return file_state(path_to_uri(path))
    number, text = unsaved
    return FileState(path_to_uri(path), path, -number, len(text))


def load_source(path: Path) -> str:
    """Return the current text of a file of at most ``SOURCE_SIZE``. Raises ``UnreadableFile``."""
    unsaved = _EDITOR.at(path)
    if unsaved is None:
        return load_text(path, SOURCE_SIZE)
    refused = too_large(path.name, len(unsaved[1]), SOURCE_SIZE)
    if refused is not None:
        raise UnreadableFile(refused)
    return unsaved[1]


def unsaved_source(path: Path) -> str | None:
    """Return the unsaved text of a file, or ``None``."""
    unsaved = _EDITOR.at(path)
    return None if unsaved is None else unsaved[1]


def source_xml(path: Path) -> str | bytes:
    """Return the current XML of a file: its unsaved text, or its bytes, in the encoding that the XML declares.

    Raises ``UnreadableFile`` and ``OSError``.
    """
    unsaved = unsaved_source(path)
    return load_bytes(path) if unsaved is None else unsaved


def _key(path: Path) -> str:
    return os.path.normcase(os.path.realpath(path))
