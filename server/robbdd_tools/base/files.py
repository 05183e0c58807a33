"""Reads user files; what is wrong with one comes back as a sentence, never as an exception."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import unquote, urlsplit

LARGEST_FILE = 8 * 1024 * 1024
"""Bytes. A model written by people stays far below; a larger file is refused rather than hanging the editor."""


@dataclass(frozen=True, slots=True)
class Unreadable:
    """Why a file has no text: ``code`` is a diagnostic code, ``reason`` a sentence with the fix."""

    code: str
    reason: str


@dataclass(frozen=True, slots=True)
class FileState:
    """A file on disk at its last change (nanoseconds, size in bytes), which stands for its text as a key of caches."""

    uri: str
    path: Path
    changed: int
    size: int


def file_state(uri: str) -> FileState | None:
    """Return the present state of a file on disk; ``None`` where there is none."""
    path = uri_to_path(uri)
    try:
        status = path.stat() if path is not None else None
    except OSError:
        return None
    return None if path is None or status is None else FileState(uri, path, status.st_mtime_ns, status.st_size)


def full_path(path: Path) -> Path:
    """Return a path made absolute, without ``..`` (as imports are read), its links kept as the user wrote them."""
    return Path(os.path.normpath(path.absolute()))


def path_to_uri(path: Path) -> str:
    """Return the ``file:`` URI of a path, see ``full_path``."""
    return full_path(path).as_uri()


def uri_to_path(uri: str) -> Path | None:
    """Return the path of a ``file:`` URI, or ``None`` for any other scheme."""
    parts = urlsplit(uri)
    if parts.scheme != "file":
        return None
    path = unquote(parts.path)
    if len(path) > 2 and path[0] == "/" and path[2] == ":":
        path = path[1:]
    return Path(path)


def too_large(name: str, size: int) -> Unreadable | None:
    """Refuse a text of more than ``LARGEST_FILE`` (``size`` in bytes, or code points of an open document)."""
    if size <= LARGEST_FILE:
        return None
    return Unreadable(
        "file-too-large",
        f"'{name}' has {size / 1048576:.1f} MiB; the limit is {LARGEST_FILE // 1048576} MiB: "
        "split the model into several files and import them",
    )


def read_text(path: Path) -> str | Unreadable:
    """Return the text of a UTF-8 file (a byte-order mark is dropped) or the reason why there is none."""
    try:
        if path.is_dir():
            return Unreadable("file-is-folder", f"'{path.name}' is a folder; name a file in it")
        size = path.stat().st_size
        refused = too_large(path.name, size)
        if refused is not None:
            return refused
        data = path.read_bytes()
    except FileNotFoundError:
        return Unreadable("file-missing", f"there is no file '{path.name}' in {path.parent}")
    except OSError as error:
        return Unreadable("file-unreadable", f"'{path.name}' cannot be read: {error.strerror or error}")
    if b"\0" in data[:8192]:
        return Unreadable("file-binary", f"'{path.name}' is a binary file, not text")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        return Unreadable(
            "file-encoding",
            f"'{path.name}' is not UTF-8 (byte 0x{data[error.start]:02x} in line {line}): save it as UTF-8",
        )
