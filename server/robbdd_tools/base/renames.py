"""Renames files, on Windows also those that another program has open for a moment."""

from __future__ import annotations

import sys
from pathlib import Path
from time import monotonic, sleep

PATIENCE = 2.0
"""Seconds that a rename is tried again on Windows: virus scanners, indexers and editors open new files briefly."""
PAUSE = 0.02
"""Seconds between two attempts."""


def rename(source: Path, target: Path) -> None:
    """Give a file the name ``target``, in place of the file that has it. Raises ``OSError``.

    POSIX renames open files; Windows denies access while a program has one of the two open.
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
