"""Record the current call of users' code in a mapped file, which survives the process.

A process that the system kills, for example without memory, can write nothing; a mapped file keeps its contents.
"""

from __future__ import annotations

import mmap
from pathlib import Path
from typing import Any

from robbdd_tools.protocol.run_folder import NOTE_SIZE

_page: mmap.mmap | None = None


def keep_in(path: Path) -> None:
    """Keep the notes of this process in a file. Raises ``OSError``."""
    global _page
    with path.open("w+b") as file:
        file.truncate(NOTE_SIZE)
        _page = mmap.mmap(file.fileno(), NOTE_SIZE)


def begin(name: str, code: object) -> bytes:
    """Record the start of a call of ``code``, named ``name``; return the note that ``end`` restores."""
    if _page is None:
        return b""
    before = _page[:]
    compiled: Any = getattr(code, "__code__", None)
    place = "\0" if compiled is None else f"{compiled.co_filename}\0{compiled.co_firstlineno}"
    _page[:] = f"{name}\0{place}\0".encode("utf-8", "replace")[:NOTE_SIZE].ljust(NOTE_SIZE, b"\0")
    return before


def end(before: bytes) -> None:
    """Record the end of a call."""
    if _page is not None:
        _page[:] = before
