"""Bags whose last messages are in the write-ahead log of SQLite, because the recorder did not end properly."""

from __future__ import annotations

import shutil
import sqlite3
import tempfile
from collections.abc import Generator
from contextlib import closing, contextmanager
from pathlib import Path

from robbdd_tools.base.files import open_regular
from robbdd_tools.base.writing import replacing_bytes

WAL = "-wal"


def has_wal(path: Path) -> bool:
    """Return whether a file or a folder of a bag has messages outside of its SQLite files."""
    files = path.iterdir() if path.is_dir() else [path.with_name(path.name + WAL)]
    return any(one.name.endswith(f".db3{WAL}") and one.is_file() and one.stat().st_size for one in files)


@contextmanager
def without_wal(path: Path) -> Generator[Path]:
    """Yield a temporary copy of a bag with all messages in its SQLite files. Raises ``OSError`` and ``sqlite3.Error``.

    rosbags reads these files alone, and would take the bag for a shorter one.
    """
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "bag"
        folder.mkdir()
        names = [one.name for one in path.iterdir()] if path.is_dir() else [path.name, path.name + WAL]
        for one in names:
            source = (path if path.is_dir() else path.parent) / one
            if source.is_file():
                with open_regular(source) as read, replacing_bytes(folder / one) as copy:
                    shutil.copyfileobj(read, copy)
        for file in folder.glob("*.db3"):
            with closing(sqlite3.connect(file)) as connection:
                connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
                connection.execute("PRAGMA journal_mode=DELETE")
        yield folder if path.is_dir() else folder / path.name
