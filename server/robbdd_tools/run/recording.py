"""Write the results of a live run to the database, in one transaction for each finished execution.

``Recording.take`` must be called before a result is shown, so that every shown result is already committed.
"""

from __future__ import annotations

import json
import platform
import sqlite3
from collections.abc import Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, replace
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from robbdd_tools.monitor.verdict import Cause
from robbdd_tools.protocol.messages import (
    ClauseJudged,
    MarginRanges,
    Output,
    RunFinished,
    RunStarted,
    ScenarioFinished,
    ScenarioStarted,
    UserCodeFailed,
)
from robbdd_tools.protocol.specs import scenario_key
from robbdd_tools.run.database import DatabaseProblem, explained, open_database, transaction
from robbdd_tools.run.results import RunResults, ScenarioResult
from robbdd_tools.run.stored_results import CAUSES, FAILED, FINISHED, INTERRUPTED, RUNNING, STOPPED, restored

if TYPE_CHECKING:
    from collections.abc import Generator

    from robbdd_tools.monitor.fault import Fault
    from robbdd_tools.protocol.messages import RunMessage
    from robbdd_tools.protocol.specs import Manifest
    from robbdd_tools.run.run_policy import Policy
    from robbdd_tools.run.store import RunRecord, StoredRun


Detail = ClauseJudged | MarginRanges | UserCodeFailed | Output
"""Messages that are stored with the end of their execution."""


class OtherSimulator(Exception):
    """A run cannot be resumed with this simulator; the message gives the reason."""


class Recording:
    """Writes the database rows of one live run. Every method raises ``DatabaseProblem`` if the database cannot be used.

    Call ``begin`` or ``resume`` first, then ``take`` for every message on arrival, then ``end``. Call ``close`` in any
    case. Only one thread may use the object at a time. Several processes may record executions of the same run: one of
    them begins it, one of them ends it, and each process takes the messages of its own executions.
    """

    def __init__(self, place: StoredRun, manifest: Manifest) -> None:
        self._place = place
        self.manifest = manifest
        self._open: dict[int, list[Detail]] = {}
        self._done: set[int] = set()
        self._simulator = ""
        self._stops = False
        self._connection = open_database(place.database, durable=place.kept)

    def begin(self, record: RunRecord, policy: Policy, prepared: str = "") -> None:
        """Insert the run into the database. ``prepared`` is a digest of the run folder."""
        self._stops = policy.stop_on_failure
        row = {
            "number": self._place.number,
            "state": RUNNING,
            "ending": "",
            "total": len(self.manifest.scenarios),
            "path": record.path,
            "digest": record.digest,
            "prepared": prepared,
            "seed": record.seed,
            "version": record.version,
            "simulator": "",
            "timeout": policy.timeout,
            "stop_on_failure": policy.stop_on_failure,
            "jobs": policy.jobs,
            "host": platform.node(),
            "began": _now(),
        }
        with self._writing() as connection:
            connection.execute("DELETE FROM run WHERE number = ?", (self._place.number,))
            _insert(connection, "run", row)

    def resume(self, policy: Policy) -> RunResults:
        """Resume an unfinished run under ``policy``; return its finished results."""
        self._stops = policy.stop_on_failure
        number = self._place.number
        with self._writing() as connection:
            connection.execute(
                "UPDATE run SET state = ?, ending = '', timeout = ?, stop_on_failure = ?, jobs = ? WHERE number = ?",
                (RUNNING, policy.timeout, policy.stop_on_failure, policy.jobs, number),
            )
            # A repaired error must not be reported again; one that remains will occur again.
            connection.execute("DELETE FROM fault WHERE run = ? AND shared", (number,))
            (self._simulator,) = connection.execute("SELECT simulator FROM run WHERE number = ?", (number,)).fetchone()
            results = restored(connection, number, self.manifest)
        self._done = {index for index, one in enumerate(results.scenarios) if one.finished is not None}
        return results

    def take(self, message: RunMessage, host: str = "") -> bool:
        """Store a message. If it finishes an execution, that execution is committed on return.

        ``host`` is the machine that executed the scenario; empty for this machine. Returns ``is_new(message)``. Raises
        ``OtherSimulator`` if a resumed run uses another simulator than before.
        """
        match message:
            case RunStarted():
                self._use_simulator(message.simulator)
            case ScenarioStarted(index):
                self._open[index] = []
            case ClauseJudged(index) | MarginRanges(index) | UserCodeFailed(int(index)) | Output(int(index)):
                self._open.setdefault(index, []).append(message)
            case UserCodeFailed(None, fault):
                with self._writing() as connection:
                    self._write_fault(connection, fault, shared=True)
            case ScenarioFinished(index):
                judged = self._open.pop(index, [])
                if index not in self._done:
                    self._write(message, judged, host or platform.node())
            case _:
                pass
        return self.is_new(message)

    def is_new(self, message: RunMessage) -> bool:
        """Return whether a message is about an execution that was still unfinished when the run was resumed."""
        return getattr(message, "index", None) not in self._done

    def forget(self, index: int) -> None:
        """Delete the stored execution of a scenario, because the scenario is executed again."""
        with self._writing() as connection:
            connection.execute("DELETE FROM execution WHERE run = ? AND idx = ?", (self._place.number, index))

    def end(self, ending: str, *, interrupted: bool = False) -> RunResults:
        """Record the end of the run and return its results. Raises ``OSError``.

        ``ending`` is the reason for the executions that are still open. Also writes ``run.json`` and ``results.json``.
        """
        number = self._place.number
        with self._writing() as connection:
            results = restored(connection, number, self.manifest)
            first = results.first_failure() if self._stops else None
            if first is not None:
                # Which later executions were finished depends on the number of processes.
                connection.execute("DELETE FROM execution WHERE run = ? AND idx > ?", (number, first))
                results = restored(connection, number, self.manifest)
            count = sum(one.finished is not None for one in results.scenarios)
            if count == len(results.scenarios):
                state, ending = FINISHED, ""
            elif first is not None and count == first + 1:
                state = STOPPED
            else:
                state = INTERRUPTED if interrupted else FAILED
            connection.execute(
                "UPDATE run SET state = ?, ending = ?, ended = ? WHERE number = ?", (state, ending, _now(), number)
            )
            (simulator,) = connection.execute("SELECT simulator FROM run WHERE number = ?", (number,)).fetchone()
        if state == FINISHED:
            results.apply(RunFinished(True))
        else:
            results.close(ending, CAUSES.get(state, Cause.NOT_EXECUTED))
        self._place.write_record(replace(self._place.record(), simulator=simulator))
        self._place.write_results(results.as_json())
        return results

    def close(self) -> None:
        """Close the database and release the run's lock."""
        self._connection.close()
        if self._place.lock is not None:
            self._place.lock.release()

    def _use_simulator(self, simulator: str) -> None:
        if self._simulator and self._simulator != simulator:
            raise OtherSimulator(f"the run was made with {self._simulator}, and this is {simulator}")
        self._simulator = simulator
        with self._writing() as connection:
            connection.execute("UPDATE run SET simulator = ? WHERE number = ?", (simulator, self._place.number))

    def _write_fault(self, connection: sqlite3.Connection, fault: Fault, *, shared: bool) -> None:
        row = (self._place.number, fault.id, shared, json.dumps(asdict(fault)))
        connection.execute("INSERT OR REPLACE INTO fault (run, id, shared, content) VALUES (?, ?, ?, ?)", row)

    def _write(self, finished: ScenarioFinished, messages: Sequence[Detail], host: str) -> None:
        spec = self.manifest.scenarios[finished.index]
        judged = {message.line: message for message in messages if isinstance(message, ClauseJudged)}
        varied = {message.line: message for message in messages if isinstance(message, MarginRanges)}
        names = {clause.line: clause.iri for clause in spec.clauses}
        row = {
            "run": self._place.number,
            "idx": finished.index,
            "key": scenario_key(spec),
            "story": spec.story,
            "variant": spec.variant,
            "variation": spec.variation,
            "repetition": spec.repetition,
            "seed": spec.seed,
            "verdict": str(ScenarioResult(spec, judged).verdict),
            "simulated": finished.simulated,
            "resampled": finished.resampled,
            "contacts": json.dumps([asdict(one) for one in finished.contacts]),
            "wall": finished.wall,
            "stepping": finished.stepping,
            "host": host,
            "ended": _now(),
            "printed": "".join(f"{message.text}\n" for message in messages if isinstance(message, Output)),
        }
        with self._writing() as connection:
            for fault in (message.fault for message in messages if isinstance(message, UserCodeFailed)):
                self._write_fault(connection, fault, shared=False)
            execution = _insert(connection, "execution", row)
            for position, (line, one) in enumerate(judged.items()):
                clause = {
                    "execution": execution,
                    "position": position,
                    "line": line,
                    "iri": names.get(line, ""),
                    "verdict": one.verdict,
                    "robustness": one.robustness,
                    "unit": one.unit,
                    "at": one.at,
                    "worst_at": one.worst_at,
                    "reason": one.reason,
                    "vacuous": one.vacuous,
                    "fault": one.fault,
                    "cause": one.cause,
                    "operand": one.operand,
                    "ranges": None if line not in varied else json.dumps(varied[line].ranges),
                    "held_before": None if line not in varied else varied[line].held_before,
                }
                _insert(connection, "clause", clause)

    @contextmanager
    def _writing(self) -> Generator[sqlite3.Connection]:
        with explained(self._place.database), transaction(self._connection):
            yield self._connection


def pending(results: RunResults, *, stops: bool) -> list[int]:
    """Return the numbers of the scenarios that must still be executed to complete a run.

    If one of several scenarios that share an execution is open, all of them are executed again. If the run ``stops`` at
    its first failure, scenarios after a known failure are left out.
    """
    first = results.first_failure() if stops else None
    wanted = [
        index
        for index, scenario in enumerate(results.scenarios)
        if scenario.finished is None and (first is None or index < first)
    ]
    trees = {tree.name for index in wanted if (tree := results.scenarios[index].spec.tree) is not None}
    open_ones = frozenset(wanted)
    return [
        index
        for index, scenario in enumerate(results.scenarios)
        if index in open_ones or (scenario.spec.tree is not None and scenario.spec.tree.name in trees)
    ]


def failure_reason(error: OSError) -> str:
    """Return why no further results of a run can be kept."""
    reason = str(error) if isinstance(error, DatabaseProblem) else f"{error.filename}: {error.strerror or error}"
    return f"results can no longer be stored: {reason}"


def _insert(connection: sqlite3.Connection, table: str, row: Mapping[str, object]) -> int | None:
    """Insert a row and return its id. Table and column names come from this module, never from users."""
    names, places = ", ".join(row), ", ".join("?" * len(row))
    return connection.execute(f"INSERT INTO {table} ({names}) VALUES ({places})", tuple(row.values())).lastrowid


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")
