"""Results database: connections, schema and migrations.

Journal mode is WAL with full synchronisation: committed data survives a crash of the process or the machine.
"""

from __future__ import annotations

import errno
import sqlite3
import tempfile
from collections.abc import Generator
from contextlib import closing, contextmanager
from pathlib import Path

from robbdd_tools.base.files import load_bytes
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.base.renames import rename
from robbdd_tools.base.writing import replace_file

NAME = "results.sqlite"
LOG = "-wal"
"""Suffix of SQLite's write-ahead log, which holds the latest transactions."""
BUSY = 30.0
"""Seconds that a connection waits while another one writes."""
_DAMAGE = {sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB}
_NO_ROOM = {sqlite3.SQLITE_IOERR_SHMSIZE, sqlite3.SQLITE_IOERR_WRITE}
"""Extended codes of a file that cannot grow: SQLite calls these I/O errors, not a full disk."""
_UNWRITABLE = {sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_READONLY}

Migrations = tuple[tuple[str, ...], ...]
MIGRATIONS: Migrations = (
    (
        # state: running, finished, stopped (at the first failure), interrupted, failed. A run that died is 'running'
        # although nobody holds its lock. Host, start, end and jobs may differ between equal runs; nothing else does.
        """CREATE TABLE run (
            number INTEGER PRIMARY KEY,
            state TEXT NOT NULL,
            ending TEXT NOT NULL,
            total INTEGER NOT NULL,
            path TEXT NOT NULL,
            digest TEXT NOT NULL,
            prepared TEXT NOT NULL,
            seed INTEGER NOT NULL,
            version TEXT NOT NULL,
            simulator TEXT NOT NULL,
            timeout REAL NOT NULL,
            stop_on_failure INTEGER NOT NULL,
            jobs INTEGER NOT NULL,
            host TEXT NOT NULL,
            began TEXT NOT NULL,
            ended TEXT
        )""",
        # idx is the number in the run's manifest; wall, stepping, host and ended may differ between equal runs.
        """CREATE TABLE execution (
            id INTEGER PRIMARY KEY,
            run INTEGER NOT NULL REFERENCES run (number) ON DELETE CASCADE,
            idx INTEGER NOT NULL,
            key TEXT NOT NULL,
            story TEXT NOT NULL,
            variant TEXT NOT NULL,
            variation INTEGER NOT NULL,
            repetition INTEGER NOT NULL,
            seed INTEGER NOT NULL,
            verdict TEXT NOT NULL,
            simulated REAL NOT NULL,
            resampled INTEGER NOT NULL,
            wall REAL NOT NULL,
            stepping REAL NOT NULL,
            host TEXT NOT NULL,
            ended TEXT NOT NULL,
            UNIQUE (run, idx)
        )""",
        # position is the order of judgement; ranges is a JSON list of the fluents' least and greatest margins;
        # held_before is 1 if the clause held before the behaviour began, NULL if unknown.
        """CREATE TABLE clause (
            execution INTEGER NOT NULL REFERENCES execution (id) ON DELETE CASCADE,
            position INTEGER NOT NULL,
            line INTEGER NOT NULL,
            iri TEXT NOT NULL,
            verdict TEXT NOT NULL,
            robustness REAL,
            unit TEXT NOT NULL,
            at REAL,
            worst_at REAL,
            reason TEXT NOT NULL,
            vacuous TEXT NOT NULL,
            fault TEXT NOT NULL,
            ranges TEXT,
            held_before INTEGER,
            PRIMARY KEY (execution, position)
        ) WITHOUT ROWID""",
    ),
    # contacts is a JSON list of the agents' contacts that no clause names.
    ("ALTER TABLE execution ADD COLUMN contacts TEXT NOT NULL DEFAULT '[]'",),
    (
        # cause is the type of an unknown verdict's reason; operand is the number of the deciding fluent.
        "ALTER TABLE clause ADD COLUMN cause TEXT NOT NULL DEFAULT ''",
        "ALTER TABLE clause ADD COLUMN operand INTEGER",
    ),
    (
        # An error in users' code: content is a Fault as JSON; shared is 1 for code that all executions load.
        """CREATE TABLE fault (
            run INTEGER NOT NULL REFERENCES run (number) ON DELETE CASCADE,
            id TEXT NOT NULL,
            shared INTEGER NOT NULL,
            content TEXT NOT NULL,
            PRIMARY KEY (run, id)
        ) WITHOUT ROWID""",
        # printed is the output of users' code.
        "ALTER TABLE execution ADD COLUMN printed TEXT NOT NULL DEFAULT ''",
    ),
)
"""Migration statements, one tuple per schema version; ``PRAGMA user_version`` counts them."""


class DatabaseProblem(OSError):
    """The database cannot be used. ``filename`` is its path, and ``strerror`` is the reason shown to the user."""

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(errno.EIO, reason, str(path))

    def __str__(self) -> str:
        return f"{self.filename}: {self.strerror}"


class DamagedDatabase(DatabaseProblem):
    """The file is not a database, or is corrupt."""


@contextmanager
def explained(path: Path) -> Generator[None]:
    """Translate SQLite errors to ``DatabaseProblem``."""
    try:
        yield
    except sqlite3.Error as error:
        raise _problem(path, error) from error


@contextmanager
def transaction(connection: sqlite3.Connection) -> Generator[None]:
    """Commit all statements of the block, or none."""
    connection.execute("BEGIN IMMEDIATE")
    try:
        yield
        connection.execute("COMMIT")
    except BaseException:
        # A full disk ends the transaction by itself.
        if connection.in_transaction:
            connection.execute("ROLLBACK")
        raise


def open_database(path: Path, *, durable: bool = True, migrations: Migrations | None = None) -> sqlite3.Connection:
    """Open a database for writing, and create or migrate it as needed. Raises ``DatabaseProblem``.

    The caller manages transactions (see ``transaction``). If ``durable`` is false, commits do not wait for the disk.
    ``migrations`` define the schema; by default, they are those of runs.
    """
    migrations = MIGRATIONS if migrations is None else migrations
    if path.exists() and not path.is_file():
        raise DatabaseProblem(path, "is not a regular file")
    with explained(path):
        connection = sqlite3.connect(path, BUSY, isolation_level=None, check_same_thread=False)
        try:
            connection.execute("PRAGMA trusted_schema = OFF")
            connection.execute("PRAGMA foreign_keys = ON")
            version = _version(connection, path, migrations)
            connection.execute("PRAGMA journal_mode = WAL")
            connection.execute(f"PRAGMA synchronous = {'FULL' if durable else 'OFF'}")
            if version < len(migrations):
                _migrate(connection, path, migrations)
        except BaseException:
            connection.close()
            raise
        return connection


def read_database(path: Path, migrations: Migrations | None = None) -> sqlite3.Connection | None:
    """Open a database for reading; return ``None`` if it is missing or empty. Raises ``DatabaseProblem``.

    ``migrations`` define the schema; by default, they are those of runs.

    If SQLite cannot open the database in place, because its folder is read-only and it has a log, it is copied into
    memory.
    """
    if not path.is_file():
        return None
    with explained(path):
        try:
            return _read(path, migrations)
        except sqlite3.OperationalError as error:
            if _code(error) not in _UNWRITABLE:
                raise
        return _copy_in_memory(path, migrations)


def move_aside(path: Path) -> Path:
    """Rename a damaged database and its log, so that no data is lost; return the new name."""
    for number in range(1, 10_000):
        target = path.with_name(f"{path.name}.damaged-{number}")
        if not target.exists():
            break
    else:
        raise DatabaseProblem(path, "is damaged, and too many damaged copies are in its folder: remove them")
    for end in (LOG, "-shm", ""):
        part = path.with_name(path.name + end)
        if part.exists():
            rename(part, target.with_name(target.name + end))
    return target


def check(connection: sqlite3.Connection, path: Path, pragma: str = "quick_check") -> None:
    """Check the whole database. Raises ``DamagedDatabase`` if it is inconsistent.

    ``pragma`` is the SQLite check to run. ``integrity_check`` also compares the indexes with their tables.
    """
    with explained(path):
        (found,) = connection.execute(f"PRAGMA {pragma}(1)").fetchone()
    if found != "ok":
        raise DamagedDatabase(path, f"is damaged: {found}")


def inspect(path: Path) -> int:
    """Check that a database is intact and writable, without changing it; return its schema version.

    Raises ``DatabaseProblem``.
    """
    with explained(path), closing(_connect(path, "rw")) as connection:
        version = _version(connection, path)
        check(connection, path, "integrity_check")
        connection.execute("BEGIN IMMEDIATE")
        # On a read-only database, SQLite refuses no earlier statement.
        connection.execute(f"PRAGMA user_version = {version}")
        connection.execute("ROLLBACK")
        return version


def _connect(path: Path, mode: str) -> sqlite3.Connection:
    """Connect to an existing database. ``mode`` is ``ro`` (read only) or ``rw`` (read and write)."""
    connection = sqlite3.connect(f"{path.absolute().as_uri()}?mode={mode}", BUSY, isolation_level=None, uri=True)
    connection.execute("PRAGMA trusted_schema = OFF")
    return connection


def _read(path: Path, migrations: Migrations | None) -> sqlite3.Connection | None:
    connection = _connect(path, "ro")
    try:
        version = _version(connection, path, migrations)
        if version == 0:
            connection.close()
            return None
        if version < len(MIGRATIONS if migrations is None else migrations):
            # Readers migrate a copy of an older schema; the next run migrates the file.
            memory = _in_memory(connection)
            _migrate(memory, path, migrations)
            return memory
        return connection
    except BaseException:
        connection.close()
        raise


def _copy_in_memory(path: Path, migrations: Migrations | None) -> sqlite3.Connection | None:
    with tempfile.TemporaryDirectory(prefix="robbdd-") as folder:
        copy = Path(folder) / NAME
        try:
            replace_file(copy, load_bytes(path, RESULT_SIZE))
            log = path.with_name(path.name + LOG)
            if log.is_file():
                replace_file(copy.with_name(copy.name + LOG), load_bytes(log, RESULT_SIZE))
        except OSError as error:
            raise DatabaseProblem(path, f"cannot be read: {error.strerror or error}") from error
        connection = _read(copy, migrations)
        return None if connection is None else _in_memory(connection)


def _in_memory(connection: sqlite3.Connection) -> sqlite3.Connection:
    memory = sqlite3.connect(":memory:", isolation_level=None)
    try:
        connection.backup(memory)
    finally:
        connection.close()
    return memory


def _version(connection: sqlite3.Connection, path: Path, migrations: Migrations | None = None) -> int:
    """Return the schema version of a database, or 0 if it is empty. Raises ``DatabaseProblem`` if it is unusable."""
    known = len(MIGRATIONS if migrations is None else migrations)
    (version,) = connection.execute("PRAGMA user_version").fetchone()
    kinds = {kind for (kind,) in connection.execute("SELECT DISTINCT type FROM sqlite_master")}
    # A view or a trigger would run code of the file's author on every access.
    if not kinds <= {"table", "index"} or (kinds and not version):
        raise DatabaseProblem(path, "is a database of another program: move it away")
    if version > known:
        raise DatabaseProblem(
            path, f"was written by a newer version of RobBDD (schema {version}; this one knows {known}): update RobBDD"
        )
    return int(version)


def _migrate(connection: sqlite3.Connection, path: Path, migrations: Migrations | None = None) -> None:
    migrations = MIGRATIONS if migrations is None else migrations
    with transaction(connection):
        # Another process may have migrated it in the meantime.
        for statements in migrations[_version(connection, path, migrations) :]:
            for statement in statements:
                connection.execute(statement)
        connection.execute(f"PRAGMA user_version = {len(migrations)}")


def _problem(path: Path, error: sqlite3.Error) -> DatabaseProblem:
    if _code(error) in _DAMAGE or type(error) is sqlite3.DatabaseError:
        return DamagedDatabase(path, f"is damaged: {error}")
    if getattr(error, "sqlite_errorcode", 0) in _NO_ROOM:
        return DatabaseProblem(path, f"{error}: the disk may be full")
    return DatabaseProblem(path, str(error))


def _code(error: sqlite3.Error) -> int:
    return getattr(error, "sqlite_errorcode", 0) & 0xFF
