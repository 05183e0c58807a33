"""Rename files. On Windows, this includes files that another program has open for a short time."""

from __future__ import annotations

import sys
from pathlib import Path
from time import monotonic, sleep

PATIENCE = 2.0
"""On Windows, a rename is retried for this time (s): virus scanners, indexers and editors briefly open new files."""
PAUSE = 0.02
"""Seconds between two attempts."""


def rename(source: Path, target: Path) -> None:
    """Rename a file to ``target``, and replace an existing file of this name. Raises ``OSError``.

    POSIX renames open files. Windows denies access while a program has one of the two files open.
    """
    deadline = monotonic() + PATIENCE
    while True:
        try:
            source.replace(target)
        except PermissionError:
            if sys.platform != "win32" or monotonic() >= deadline:
                raise
            sleep(PAUSE)
        else:
            return
