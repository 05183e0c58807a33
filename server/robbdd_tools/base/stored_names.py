"""Find the names of files as the file system stores them, for paths that differ from them in case.

Windows and macOS usually ignore case in names (and macOS the Unicode form of accents), so a path can be valid there and
missing elsewhere.
"""

from __future__ import annotations

import os
import unicodedata
from collections.abc import Mapping, Sequence
from functools import lru_cache
from itertools import islice
from pathlib import Path

from robbdd_tools.base.limits import SCANNED_ENTRIES


def without_case(name: str) -> str:
    """Return a text that is equal for names that a file system may treat as equal."""
    return unicodedata.normalize("NFC", name).casefold()


def is_same_file(one: Path, other: Path) -> bool:
    """Return whether two paths lead to the same file or folder on the disk."""
    try:
        return one.samefile(other)
    except (OSError, ValueError):
        return False


def stored_path(path: Path, parts: int) -> Path | None:
    """Return an existing path with its last ``parts`` names as they are stored.

    Return ``None`` if the path already has the stored names. This is always so on file systems where case matters.
    """
    # This one look is enough where case matters, so that no folder is listed there.
    if not is_same_file(path, path.with_name(path.name.swapcase())):
        return None
    found = _in_folder(Path(*path.parts[: len(path.parts) - parts]), path.parts[len(path.parts) - parts :])
    return None if found == path else found


def alike_path(path: Path) -> Path | None:
    """Return an existing path that differs from a missing path only in case; ``None`` if there is none.

    The names of folders may differ, too.
    """
    place = path.parent
    try:
        while not place.is_dir() and place != place.parent:
            place = place.parent
    except (OSError, ValueError):
        return None
    return _in_folder(place, path.relative_to(place).parts)


def _in_folder(folder: Path, names: tuple[str, ...]) -> Path | None:
    for name in names:
        try:
            stored = _stored_names(folder, folder.stat().st_mtime_ns).get(without_case(name), ())
        except OSError:
            return None
        if not stored:
            return None
        folder /= name if name in stored else stored[0]
    return folder


@lru_cache(maxsize=64)
def _stored_names(folder: Path, _changed: int) -> Mapping[str, Sequence[str]]:
    """Return the sorted names in a folder by ``without_case``. They are read again when the folder has changed."""
    found: dict[str, list[str]] = {}
    with os.scandir(folder) as entries:
        for name in sorted(entry.name for entry in islice(entries, SCANNED_ENTRIES.value())):
            found.setdefault(without_case(name), []).append(name)
    return found
