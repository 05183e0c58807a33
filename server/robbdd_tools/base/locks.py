"""File locks. The operating system releases them when the process that holds them ends, for whatever reason."""

from __future__ import annotations

import errno
import sys
from contextlib import suppress
from pathlib import Path
from time import monotonic, sleep
from typing import BinaryIO

from robbdd_tools.base.files import open_regular

if sys.platform == "win32":
    import msvcrt

    def _try_lock(file: BinaryIO, *, shared: bool) -> bool:
        """Lock the first byte of a file. Windows has no shared locks here, so a ``shared`` lock is exclusive, too."""
        del shared
        try:
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        except OSError as error:
            if error.errno in (errno.EACCES, errno.EDEADLOCK):
                return False
            raise
        return True
else:
    import fcntl

    def _try_lock(file: BinaryIO, *, shared: bool) -> bool:
        """Lock the file without waiting.

        ``flock`` is used instead of ``lockf``, because its locks belong to the open file instead of the process.
        """
        try:
            fcntl.flock(file, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
        return True


_PAUSE = 0.02
"""Seconds between two attempts to lock a file."""


class Lock:
    """A lock that this process holds until it releases it or ends."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file

    def release(self) -> None:
        """Release the lock. The file is not deleted."""
        self._file.close()


def acquire(path: Path, patience: float = 0.0) -> Lock | None:
    """Lock a file within ``patience`` seconds. Return ``None`` if it is still locked by another holder.

    The file is created if it is missing. Raises ``OSError``, also if the file system does not support locks.
    """
    deadline = monotonic() + patience
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, "is not a regular file", str(path))
    file = path.open("ab")
    try:
        while not _try_lock(file, shared=False):
            if monotonic() >= deadline:
                file.close()
                return None
            sleep(_PAUSE)
    except BaseException:
        file.close()
        raise
    return Lock(file)


def is_held(path: Path) -> bool:
    """Return whether any process, this one included, holds the lock on a file."""
    with suppress(OSError), open_regular(path) as file:
        return not _try_lock(file, shared=True)
    return False
