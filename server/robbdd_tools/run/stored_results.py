"""Read the status and the results of one run from the database."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Mapping
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from robbdd_tools.base.plain import from_plain
from robbdd_tools.monitor.contact import Contact
from robbdd_tools.monitor.fault import Fault
from robbdd_tools.monitor.verdict import Cause, Outcome
from robbdd_tools.protocol.messages import ClauseJudged, MarginRanges, RunFinished, ScenarioFinished
from robbdd_tools.protocol.specs import Manifest
from robbdd_tools.run.database import explained, read_database
from robbdd_tools.run.results import RunResults

RUNNING, FINISHED, STOPPED, INTERRUPTED, FAILED = "running", "finished", "stopped", "interrupted", "failed"
"""States of a run in the database."""
CAUSES = {STOPPED: Cause.STOPPED, INTERRUPTED: Cause.CANCELLED}
"""State of a run → cause of its missing executions."""
DIED = "died"
"""State of a run that is ``RUNNING`` in the database although its lock is free."""
_JUDGED = ("line", "verdict", "robustness", "unit", "at", "reason", "worst_at", "vacuous", "fault", "cause", "operand")
"""Columns of a clause that are fields of ``ClauseJudged``."""
_ENDINGS = {
    RUNNING: "not executed yet: the run is in progress",
    DIED: "the run ended without notice",
    INTERRUPTED: "the run was interrupted",
}


@dataclass(frozen=True, slots=True)
class RunStatus:
    """The progress of a run.

    - ``ending``: the reason why executions are open.
    - ``counts``: the number of finished executions with each verdict.
    - ``timeout`` (wall time in s) and ``stop_on_failure``: the settings of the run.
    - ``prepared``: a digest of the manifest and the features of the run.
    """

    state: str
    ending: str
    total: int
    counts: Mapping[str, int]
    simulator: str = ""
    version: str = ""
    prepared: str = ""
    timeout: float = 0.0
    stop_on_failure: bool = False
    jobs: int = 1

    @property
    def finished(self) -> int:
        """Number of finished executions."""
        return sum(self.counts.values())

    @property
    def is_whole(self) -> bool:
        """Whether the run has executed everything that it was asked to execute."""
        return self.state in (FINISHED, STOPPED)

    def words(self) -> str:
        """Return a text about a run with unfinished executions, for example ``interrupted: 12 of 40 finished``."""
        if self.state == FINISHED:
            return ""
        name = "stopped at the first failure" if self.state == STOPPED else self.state
        return f"{name}: {self.finished} of {self.total} finished"


def read_status(database: Path, number: int, *, live: bool = False) -> RunStatus | None:
    """Return the status of a run, or ``None`` if the database has no such run. Raises ``DatabaseProblem``.

    ``live`` is true if the process of the run is still running.
    """
    with explained(database):
        connection = read_database(database)
        if connection is None:
            return None
        with closing(connection):
            return _status(connection, number, live=live)


def starts(database: Path) -> dict[int, str]:
    """Map the number of each run in a database, in order, to the time at which it began (ISO 8601).

    Raises ``DatabaseProblem``.
    """
    with explained(database):
        connection = read_database(database)
        if connection is None:
            return {}
        with closing(connection):
            return dict(connection.execute("SELECT number, began FROM run ORDER BY number").fetchall())


def finished_executions(database: Path, number: int) -> Mapping[int, float] | None:
    """Map the number of each finished execution of a run to its simulated time in s. Raises ``DatabaseProblem``.

    Returns ``None`` if the database has no such run.
    """
    with explained(database):
        connection = read_database(database)
        if connection is None:
            return None
        with closing(connection):
            if connection.execute("SELECT 1 FROM run WHERE number = ?", (number,)).fetchone() is None:
                return None
            query = "SELECT idx, simulated FROM execution WHERE run = ?"
            return dict(connection.execute(query, (number,)).fetchall())


def execution_ends(database: Path, number: int) -> Mapping[int, tuple[str, float]]:
    """Map the number of each finished execution of a run to its end (ISO 8601) and its wall time in s.

    It is empty if the database has no such run. Raises ``DatabaseProblem``.
    """
    with explained(database):
        connection = read_database(database)
        if connection is None:
            return {}
        with closing(connection):
            query = "SELECT idx, ended, wall FROM execution WHERE run = ?"
            return {index: (ended, wall) for index, ended, wall in connection.execute(query, (number,))}


def read_results(database: Path, number: int, manifest: Manifest, *, live: bool = False) -> RunResults | None:
    """Return the results of a run, or ``None`` if the database has none. Raises ``DatabaseProblem``.

    The clauses of an unfinished execution are unknown. Their reason says why the execution is unfinished.
    """
    with explained(database):
        connection = read_database(database)
        if connection is None:
            return None
        with closing(connection):
            status = _status(connection, number, live=live)
            if status is None:
                return None
            results = restored(connection, number, manifest)
    if status.state == FINISHED:
        results.apply(RunFinished(True))
    else:
        results.close(status.ending, CAUSES.get(status.state, Cause.NOT_EXECUTED))
    return results


def restored(connection: sqlite3.Connection, number: int, manifest: Manifest) -> RunResults:
    """Return the finished executions of a run as results, to which more can be added. Raises ``sqlite3.Error``."""
    try:
        return _restored(connection, number, manifest)
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        # SQLite finds damaged pages, but not damaged values in them.
        raise sqlite3.DatabaseError(f"run {number} cannot be read: {error}") from error


def _restored(connection: sqlite3.Connection, number: int, manifest: Manifest) -> RunResults:
    results = RunResults(manifest)
    faults = connection.execute("SELECT shared, content FROM fault WHERE run = ? ORDER BY id", (number,))
    for shared, content in faults:
        fault = from_plain(Fault, json.loads(content))
        results.faults[fault.id] = fault
        if shared:
            results.shared_faults.add(fault.id)
    query = """SELECT id, idx, simulated, wall, stepping, resampled, contacts, printed
        FROM execution WHERE run = ? ORDER BY idx"""
    for identifier, position, simulated, wall, stepping, resampled, contacts, printed in connection.execute(
        query, (number,)
    ):
        index = int(position)
        if index >= len(manifest.scenarios):
            continue
        spec = manifest.scenarios[index]
        query = f"""SELECT {", ".join(_JUDGED)}, ranges, held_before
            FROM clause WHERE execution = ? ORDER BY position"""
        known = {clause.line for clause in spec.clauses}
        touched = tuple(from_plain(Contact, one) for one in json.loads(contacts))
        for *judged, ranges, held_before in connection.execute(query, (identifier,)):
            clause = from_plain(ClauseJudged, {"index": index, **dict(zip(_JUDGED, judged, strict=True))})
            if clause.line in known:
                Outcome(clause.verdict)  # raises ValueError
                results.apply(clause)
                if ranges is not None:
                    held = None if held_before is None else bool(held_before)
                    given = {"index": index, "line": clause.line, "ranges": json.loads(ranges), "held_before": held}
                    results.apply(from_plain(MarginRanges, given))
        results.scenarios[index].printed = printed
        results.apply(ScenarioFinished(index, simulated, wall, stepping, resampled, touched))
    return results


def _status(connection: sqlite3.Connection, number: int, *, live: bool) -> RunStatus | None:
    query = """SELECT state, ending, total, simulator, version, prepared, timeout, stop_on_failure, jobs
        FROM run WHERE number = ?"""
    row = connection.execute(query, (number,)).fetchone()
    if row is None:
        return None
    state, ending, total, simulator, version, prepared, timeout, stops, jobs = row
    state = DIED if state == RUNNING and not live else state
    counted = connection.execute("SELECT verdict, count(*) FROM execution WHERE run = ? GROUP BY verdict", (number,))
    counts = dict(counted.fetchall())
    ending = ending or _ENDINGS.get(state, "")
    return RunStatus(state, ending, total, counts, simulator, version, prepared, timeout, bool(stops), jobs)
