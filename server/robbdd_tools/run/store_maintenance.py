"""Maintain a database between runs: create or migrate it, mark dead runs, remove old ones."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from contextlib import closing
from pathlib import Path

from robbdd_tools.run.database import DamagedDatabase, check, explained, move_aside, open_database, transaction
from robbdd_tools.run.stored_results import DIED, RUNNING


def make_ready(database: Path, live: Collection[int]) -> str:
    """Prepare a database for a new run; return a note for the user. Raises ``DatabaseProblem``.

    ``live`` are the runs in progress. A damaged database is moved aside, unless a live run is writing to it. If an
    earlier run died, the whole database is checked.
    """
    try:
        _settle(database, live)
    except DamagedDatabase as error:
        if live:
            raise
        target = move_aside(database)
        open_database(database).close()
        return f"{error}; it is kept as {target.name}, and a new one was created"
    return ""


def remove_runs(database: Path, numbers: Iterable[int]) -> None:
    """Remove all rows of some runs; raises ``DatabaseProblem``."""
    with explained(database), closing(open_database(database)) as connection, transaction(connection):
        for number in numbers:
            connection.execute("DELETE FROM run WHERE number = ?", (number,))


def _settle(database: Path, live: Collection[int]) -> None:
    with explained(database), closing(open_database(database)) as connection:
        running = {number for (number,) in connection.execute("SELECT number FROM run WHERE state = ?", (RUNNING,))}
        died = running.difference(live)
        if not died:
            return
        check(connection, database)
        with transaction(connection):
            for number in died:
                connection.execute("UPDATE run SET state = ? WHERE number = ?", (DIED, number))
