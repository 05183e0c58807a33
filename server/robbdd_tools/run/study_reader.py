"""Read the store of one study. Nothing is written, so a read-only folder is enough."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.database import DatabaseProblem, explained, read_database
from robbdd_tools.run.study_schema import MIGRATIONS, NAME

OUTCOMES = (Outcome.HOLDS, Outcome.VIOLATED, Outcome.UNKNOWN)
"""The verdicts; the position of each is its number in the database."""
COLUMNS = ("number", "scenario", "variant", "variation", "execution", "repetition", "seed", "duration",
           "scenario_verdict", "clause", "verdict", "margin", "unit", "at", "reason")  # fmt: skip
"""Columns of an exported row, after the levels."""

TABLES: Mapping[str, str] = {
    "fact": "SELECT name, content FROM fact ORDER BY name",
    "word": "SELECT id, content FROM word ORDER BY id",
    "combination": "SELECT id, cell, story, variant, variation, execution, name, levels FROM combination ORDER BY id",
    "batch": "SELECT number, cell, host FROM batch ORDER BY number",
    "execution": "SELECT id, batch, combination, repetition, seed, verdict, simulated, 0.0 FROM execution ORDER BY id",
    "clause": "SELECT * FROM clause ORDER BY execution, position",
}
"""Table of the database → the query of its rows, in the order of its columns; wall times are 0."""


@dataclass(frozen=True, slots=True)
class CombinationCount:
    """The executions of one scenario in one cell: how many hold, are violated and are unknown."""

    levels: Mapping[str, Any]
    variant: str
    name: str
    holds: int
    violated: int
    unknown: int


@dataclass(frozen=True, slots=True)
class ClauseCount:
    """The verdicts on one clause. ``least`` is its smallest margin in ``unit``; ``None`` if it has none."""

    name: str
    holds: int
    violated: int
    unknown: int
    least: float | None
    unit: str


@dataclass(frozen=True, slots=True)
class StoredExecution:
    """An execution of a study: its number, its cell, its scenario, the name of its ``.bddx`` execution, and its seed.

    ``variation`` and ``repetition`` are numbers within the scenario variant.
    """

    number: int
    cell: str
    variant: str
    variation: int
    execution: str
    repetition: int
    seed: int

    @property
    def key(self) -> tuple[str, int, str, int]:
        """The key of the execution within its cell."""
        return self.variant, self.variation, self.execution, self.repetition


class StudyReader:
    """The results of a study. Every method raises ``DatabaseProblem`` if the database cannot be used."""

    def __init__(self, path: Path, connection: sqlite3.Connection) -> None:
        self.path = path
        self._connection = connection

    def close(self) -> None:
        """Close the database."""
        self._connection.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def fact(self, name: str) -> str | None:
        """Return a fact about the study, such as the digest of its models; ``None`` if it was never stored."""
        with explained(self.path):
            row = self._connection.execute("SELECT content FROM fact WHERE name = ?", (name,)).fetchone()
        return None if row is None else str(row[0])

    def facts(self) -> Mapping[str, str]:
        """Return all facts about the study by name: its name, versions, and digests of what it used."""
        return dict(self._rows("SELECT name, content FROM fact ORDER BY name"))

    def batches(self) -> frozenset[int]:
        """Return the numbers of the stored batches."""
        with explained(self.path):
            return frozenset(number for (number,) in self._connection.execute("SELECT number FROM batch"))

    def counts(self) -> list[CombinationCount]:
        """Return the number of verdicts on each scenario in each cell, in the order of their first executions."""
        query = """SELECT levels, variant, name, sum(verdict = 0), sum(verdict = 1), sum(verdict = 2)
            FROM execution JOIN combination ON combination.id = combination
            GROUP BY combination.id ORDER BY combination.id"""
        return [CombinationCount(json.loads(levels), *rest) for levels, *rest in self._rows(query)]

    def clauses(self) -> list[ClauseCount]:
        """Return the number of verdicts on each clause, in the order of their first verdicts."""
        query = """SELECT name.content, sum(verdict = 0), sum(verdict = 1), sum(verdict = 2), min(robustness),
                max(unit.content)
            FROM clause JOIN word AS name ON name.id = clause JOIN word AS unit ON unit.id = unit
            GROUP BY clause ORDER BY min(clause.execution), min(position)"""
        return [ClauseCount(*row) for row in self._rows(query)]

    def outcomes(self) -> Iterator[tuple[int, int, int]]:
        """Yield for each batch its number, the number of its executions, and how many of them hold."""
        yield from self._rows("SELECT batch, count(*), sum(verdict = 0) FROM execution GROUP BY batch ORDER BY batch")

    def verdicts(self) -> Mapping[Outcome, int]:
        """Return the number of executions by their verdicts."""
        found = self._rows("SELECT verdict, count(*) FROM execution GROUP BY verdict")
        return {OUTCOMES[verdict]: number for verdict, number in found}

    def executions(self, *, failures: bool = False, clause: str = "") -> Iterator[StoredExecution]:
        """Yield the executions in the order of the study.

        With ``failures``, only those that do not hold. With ``clause``, only those in which the clause of this name
        does not hold.
        """
        query = """SELECT execution.id, cell, variant, variation, combination.execution, repetition, seed
            FROM execution JOIN combination ON combination.id = combination
            WHERE (NOT ? OR verdict != 0) AND (? = '' OR EXISTS (
                SELECT 1 FROM clause JOIN word ON word.id = clause.clause
                WHERE clause.execution = execution.id AND word.content = ? AND clause.verdict != 0))
            ORDER BY execution.id"""
        for row in self._rows(query, (failures, clause, clause)):
            yield StoredExecution(*row)

    def numbers(self, batch: int) -> list[int]:
        """Return the numbers of the executions of a batch in its order."""
        return [number for (number,) in self._rows("SELECT id FROM execution WHERE batch = ? ORDER BY id", (batch,))]

    def failing(self, numbers: Iterable[int]) -> frozenset[int]:
        """Return the numbers of those of the given executions that do not hold."""
        query = "SELECT id FROM execution WHERE verdict != 0 AND id IN (SELECT value FROM json_each(?))"
        return frozenset(number for (number,) in self._rows(query, (json.dumps(list(numbers)),)))

    def judged(self, number: int) -> list[tuple[Outcome, float | None, float | None]]:
        """Return verdict, margin and instant of each clause of the execution with this number."""
        query = "SELECT verdict, robustness, at FROM clause WHERE execution = ? ORDER BY position"
        return [(OUTCOMES[verdict], margin, at) for verdict, margin, at in self._rows(query, (number,))]

    def tables(self) -> Mapping[str, list[tuple[Any, ...]]]:
        """Return the rows of each table of ``TABLES``, without wall times and names of machines."""
        found = {name: list(self._rows(query)) for name, query in TABLES.items()}
        hosts = {host for (host,) in self._rows("SELECT DISTINCT host FROM batch")}
        found["word"] = [(key, f"machine {key}" if key in hosts else content) for key, content in found["word"]]
        return found

    def wall(self) -> float:
        """Return the sum of the wall times of all executions in s."""
        return next(self._rows("SELECT coalesce(sum(wall), 0) FROM execution"))[0]

    def rows(self) -> Iterator[dict[str, Any]]:
        """Yield one flat dictionary for each clause of each execution, in the order of the study.

        The levels of factors and the values of variables are in columns called ``level.NAME``.
        """
        query = """SELECT levels, execution.id, combination.name, variant, variation, combination.execution, repetition,
                seed, simulated, execution.verdict, name.content, clause.verdict, robustness, unit.content, at,
                reason.content
            FROM execution JOIN combination ON combination.id = combination
            JOIN clause ON clause.execution = execution.id
            JOIN word AS name ON name.id = clause.clause JOIN word AS unit ON unit.id = unit
            JOIN word AS reason ON reason.id = reason
            ORDER BY batch, execution.id, position"""
        for row in self._rows(query):
            levels: dict[str, Any] = json.loads(row[0])
            found: dict[str, Any] = dict(zip(COLUMNS, row[1:], strict=True))
            verdicts = {name: OUTCOMES[int(found[name])].value for name in ("scenario_verdict", "verdict")}
            yield {**{f"level.{name}": value for name, value in levels.items()}, **found, **verdicts}

    def _rows(self, query: str, values: Sequence[object] = ()) -> Iterator[tuple[Any, ...]]:
        with explained(self.path):
            yield from self._connection.execute(query, values)


def read_study_store(folder: Path) -> StudyReader:
    """Open the store of a study for reading. Raises ``DatabaseProblem``."""
    path = folder / NAME
    connection = read_database(path, MIGRATIONS)
    if connection is None:
        raise DatabaseProblem(path, "has no results")
    return StudyReader(path, connection)
