"""Read regular files up to a size limit. All other modules read files by the functions of this module.

Each file is checked before it is opened and again afterwards, and is opened without blocking. So a named pipe, a device
or a link to one can neither block the process nor fill its memory: its reader gets the reason of the refusal.
"""

from __future__ import annotations

import errno
import os
import stat
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from robbdd_tools.base.limits import MIB, MODEL_SIZE, Limit
from robbdd_tools.base.stored_names import alike_path
from robbdd_tools.base.uris import path_of, uri_of

# Windows lacks this flag; there, no path in a folder names a pipe.
_OPENING = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_BINARY", 0)
_KINDS = {
    stat.S_IFIFO: "a named pipe",
    stat.S_IFSOCK: "a socket",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
}


@dataclass(frozen=True, slots=True)
class Unreadable:
    """The reason why a file cannot be read.

    ``code`` is a diagnostic code, and ``reason`` is a sentence with the fix.
    """

    code: str
    reason: str


class UnreadableFile(OSError):
    """A file cannot be read. The message is a sentence for the user, and ``code`` is a diagnostic code."""

    def __init__(self, problem: Unreadable) -> None:
        super().__init__(problem.reason)
        self.code = problem.code
        self.problem = problem


class MissingFile(UnreadableFile, FileNotFoundError):
    """The file does not exist."""


@dataclass(frozen=True, slots=True)
class FileState:
    """The modification time (nanoseconds) and the size (bytes) of a file. Caches use them as a key for its text."""

    uri: str
    path: Path
    changed: int
    size: int


def file_state(uri: str) -> FileState | None:
    """Return the current state of a regular file, or ``None`` if there is no such file."""
    path = uri_to_path(uri)
    try:
        status = path.stat() if path is not None else None
    except (OSError, ValueError):
        return None
    if path is None or status is None or not stat.S_ISREG(status.st_mode):
        return None
    return FileState(uri, path, status.st_mtime_ns, status.st_size)


def full_path(path: Path) -> Path:
    """Return a path made absolute and without ``..`` (as for imports); links stay as the user wrote them."""
    return Path(os.path.normpath(path.absolute()))


def path_to_uri(path: Path) -> str:
    """Return the ``file:`` URI of a path, see ``full_path``."""
    return uri_of(full_path(path))


def uri_to_path(uri: str) -> Path | None:
    """Return the path of a ``file:`` URI, or ``None`` if it has none (see ``path_of``)."""
    path = path_of(uri)
    return None if path is None else Path(path)


def too_large(name: str, size: int, limit: Limit = MODEL_SIZE) -> Unreadable | None:
    """Return a message if a text is too large. ``size`` is in bytes, or in code points for an open document."""
    return _too_large(name, limit, f"has {size / MIB:.1f} MiB") if size > limit.value() else None


def read_text(path: Path, limit: Limit = MODEL_SIZE) -> str | Unreadable:
    """Return the text of a UTF-8 file without its byte-order mark, or the reason why it cannot be read."""
    try:
        return load_text(path, limit)
    except UnreadableFile as error:
        return error.problem


def load_text(path: Path, limit: Limit = MODEL_SIZE) -> str:
    """Return the text of a UTF-8 file without its byte-order mark. Raises ``UnreadableFile``."""
    data = load_bytes(path, limit)
    if b"\0" in data[:8192]:
        raise UnreadableFile(Unreadable("file-binary", f"'{path.name}' is a binary file, not text"))
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        reason = f"'{path.name}' is not UTF-8 (byte 0x{data[error.start]:02x} in line {line}): save it as UTF-8"
        raise UnreadableFile(Unreadable("file-encoding", reason)) from None


def load_bytes(path: Path, limit: Limit = MODEL_SIZE) -> bytes:
    """Return the content of a file; raises ``UnreadableFile``.

    At most one byte more than the limit is read, even if the file claims another size.
    """
    largest = limit.value()
    try:
        with open_regular(path) as file:
            size = os.fstat(file.fileno()).st_size
            refused = too_large(path.name, size, limit)
            if refused is not None:
                raise UnreadableFile(refused)
            data = file.read(largest + 1)
    except UnreadableFile:
        raise
    except OSError as error:
        raise _error(_failed(path, error)) from None
    if len(data) > largest:
        raise UnreadableFile(_too_large(path.name, limit, "grows while it is read"))
    return data


def open_regular(path: Path) -> BinaryIO:
    """Open a regular file for reading. Raises ``UnreadableFile`` for any other kind of file."""
    problem = unreadable(path)
    if problem is not None:
        raise _error(problem)
    try:
        descriptor = os.open(path, _OPENING)
    except OSError as error:
        raise _error(_failed(path, error)) from None
    # The file at this path may have been replaced since it was checked.
    problem = _not_regular(path, os.fstat(descriptor))
    if problem is not None:
        os.close(descriptor)
        raise UnreadableFile(problem)
    return os.fdopen(descriptor, "rb")


def unreadable(path: Path) -> Unreadable | None:
    """Return the reason why a path does not name a regular file; ``None`` if it does. The file is not opened."""
    try:
        return _not_regular(path, path.stat())
    except ValueError:
        shown = str(path).encode("unicode_escape").decode("ascii")
        return Unreadable("file-missing", f"'{shown}' is not a path: it contains a NUL or a lone surrogate")
    except OSError as error:
        return _failed(path, error)


def _error(problem: Unreadable) -> UnreadableFile:
    return MissingFile(problem) if problem.code == "file-missing" else UnreadableFile(problem)


def _not_regular(path: Path, status: os.stat_result) -> Unreadable | None:
    if stat.S_ISREG(status.st_mode):
        return None
    if stat.S_ISDIR(status.st_mode):
        return Unreadable("file-is-folder", f"'{path.name}' is a folder; name a file in it")
    kind = _KINDS.get(stat.S_IFMT(status.st_mode), "not a regular file")
    via = " (through a link)" if path.is_symlink() else ""
    return Unreadable("file-not-regular", f"'{path.name}' is {kind}{via}; only regular files are read")


def _failed(path: Path, error: OSError) -> Unreadable:
    match error.errno:
        case errno.ENOENT:
            return Unreadable("file-missing", f"there is no file '{path.name}' in {path.parent}{_hint(path)}")
        case errno.ELOOP:
            return Unreadable("file-unreadable", f"'{path.name}' cannot be read: its symbolic links form a loop")
        case _:
            return Unreadable("file-unreadable", f"'{path.name}' cannot be read: {error.strerror or error}")


def _hint(path: Path) -> str:
    if path.is_symlink():
        return f": it is a symbolic link to {path.readlink()}, which does not exist"
    alike = alike_path(path)
    return "" if alike is None else f", but there is {alike}: upper and lower case letters differ"


def _too_large(name: str, limit: Limit, fact: str) -> Unreadable:
    largest = f"{limit.value() / MIB:.3g} MiB"
    advice = "split the model into several files and import them" if limit is MODEL_SIZE else f"see {limit.variable}"
    return Unreadable("file-too-large", f"'{name}' {fact}; the limit is {largest}: {advice}")
