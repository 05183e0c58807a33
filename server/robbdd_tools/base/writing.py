"""Write files atomically. A reader finds either the old or the new content, even after a crash or on a full disk.

The content is written to a temporary file in the same folder, synced, and renamed over the old file. Mode and owner are
kept. A symbolic link stays a link, and its target is replaced. A file with several hard links keeps them (see
``_overwrite``). Existing pipes and devices (``/dev/stdout``) are written to directly.
"""

from __future__ import annotations

import errno
import io
import os
import secrets
import stat
from collections.abc import Generator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO, TextIO

from robbdd_tools.base.renames import rename

TEMPORARY = ".robbdd-"
"""Prefix of temporary files; they end in ``.tmp``, so that no reader takes them for results."""

_STREAMS = (("dev",), ("proc",))
"""A path in one of these folders may name an open stream, such as ``/dev/stdout``, even if redirected to a file."""


def replace_file(path: Path, content: str | bytes) -> None:
    """Write a file atomically; text is written as UTF-8 with ``\n``.

    Raises ``OSError``, and then keeps the old file.
    """
    data = content.encode("utf-8") if isinstance(content, str) else content
    with replacing_bytes(path) as file:
        file.write(data)


@contextmanager
def replacing(path: Path) -> Generator[TextIO]:
    """Open a UTF-8 text file that replaces the old one at the end of the block. Raises ``OSError``.

    After an exception in the block, the old file is unchanged.
    """
    with replacing_bytes(path) as file:
        text = io.TextIOWrapper(file, encoding="utf-8", newline="\n")
        yield text
        text.flush()
        text.detach()


@contextmanager
def replacing_bytes(path: Path) -> Generator[BinaryIO]:
    """Open a binary file that replaces the old one at the end of the block (see ``replacing``)."""
    status = _status(path)
    if status is not None and (not stat.S_ISREG(status.st_mode) or path.absolute().parts[1:2] in _STREAMS):
        with path.open("wb") as stream:
            yield stream
        return
    target = Path(os.path.realpath(path))
    fresh = target.with_name(f"{TEMPORARY}{secrets.token_hex(8)}.tmp")
    try:
        with _created(fresh, path) as file:
            yield file
            file.flush()
            if status is not None:
                _take_over(file.fileno(), status)
            os.fsync(file.fileno())
        if status is not None and status.st_nlink > 1:
            _overwrite(target, fresh)
        else:
            rename(fresh, target)
        _sync_folder(target.parent)
    except OSError as error:
        # Name the requested file in the error, not the temporary one.
        if error.filename in (None, str(fresh)):
            raise OSError(error.errno, error.strerror or str(error), str(path)) from error
        raise
    finally:
        with suppress(OSError):
            fresh.unlink(missing_ok=True)


def _status(path: Path) -> os.stat_result | None:
    """Return the status of an existing file. Raises ``OSError`` if the file cannot be written."""
    try:
        status = path.stat()
    except FileNotFoundError:
        return None
    if stat.S_ISDIR(status.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if not os.access(path, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
    return status


def _created(fresh: Path, path: Path) -> BinaryIO:
    if not fresh.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(path.parent))
    return fresh.open("xb")


def _take_over(descriptor: int, status: os.stat_result) -> None:
    """Give a new file the owner and mode of the file that it replaces."""
    if hasattr(os, "fchown"):
        # Only a privileged user can change owners; others own the files that they replace.
        with suppress(PermissionError):
            os.fchown(descriptor, status.st_uid, status.st_gid)
    if hasattr(os, "fchmod"):
        os.fchmod(descriptor, stat.S_IMODE(status.st_mode))


def _overwrite(target: Path, fresh: Path) -> None:
    """Write the content of a complete new file into an old file that has several hard links.

    The other links show the new content. If this fails halfway, the new file replaces this link only.
    """
    data = fresh.read_bytes()
    try:
        with target.open("r+b") as file:
            file.write(data)
            file.truncate()
            file.flush()
            os.fsync(file.fileno())
    except OSError:
        rename(fresh, target)


def _sync_folder(folder: Path) -> None:
    """Sync a folder to disk after a rename, on systems where folders can be opened."""
    with suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
