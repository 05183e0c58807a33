"""The store of one study: a database of finished executions that stays small with hundreds of thousands of them.

Texts that executions share (names, reasons, units, values of variables) are stored once. Executions arrive in batches,
each of which is committed as a whole. Wall times and hosts may differ between equal studies; nothing else does.
"""

from __future__ import annotations

import json
import platform
import sqlite3
from collections.abc import Generator, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from robbdd_tools.base.writing import replace_file
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.database import Migrations, explained, open_database, transaction
from robbdd_tools.run.results import unjudged

if TYPE_CHECKING:
    from robbdd_tools.protocol.messages import ClauseJudged
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.run.results import RunResults, ScenarioResult

NAME = "study.sqlite"
OUTCOMES = (Outcome.HOLDS, Outcome.VIOLATED, Outcome.UNKNOWN)
"""Verdicts by their numbers in the database."""
COLUMNS = ("scenario", "variant", "variation", "execution", "repetition", "seed", "duration", "scenario_verdict",
           "clause", "verdict", "margin", "unit", "at", "reason")  # fmt: skip
"""Columns of an exported row, after the levels."""
MIGRATIONS: Migrations = (
    (
        "CREATE TABLE fact (name TEXT PRIMARY KEY, content TEXT NOT NULL) WITHOUT ROWID",
        "CREATE TABLE word (id INTEGER PRIMARY KEY, content TEXT NOT NULL UNIQUE)",
        # levels is a JSON object: the levels of the study's factors, then the values of the scenario's variables.
        """CREATE TABLE combination (
            id INTEGER PRIMARY KEY,
            cell TEXT NOT NULL,
            story TEXT NOT NULL,
            variant TEXT NOT NULL,
            variation INTEGER NOT NULL,
            execution TEXT NOT NULL,
            name TEXT NOT NULL,
            levels TEXT NOT NULL,
            UNIQUE (cell, variant, variation, execution)
        )""",
        "CREATE TABLE batch (number INTEGER PRIMARY KEY, cell TEXT NOT NULL, host INTEGER NOT NULL)",
        # verdict is 0 (holds), 1 (violated) or 2 (unknown); wall is in s and may differ between equal studies.
        """CREATE TABLE execution (
            id INTEGER PRIMARY KEY,
            batch INTEGER NOT NULL REFERENCES batch (number),
            combination INTEGER NOT NULL REFERENCES combination (id),
            repetition INTEGER NOT NULL,
            seed INTEGER NOT NULL,
            verdict INTEGER NOT NULL,
            simulated REAL NOT NULL,
            wall REAL NOT NULL
        )""",
        # clause, unit, reason and cause are words; robustness is in the unit.
        """CREATE TABLE clause (
            execution INTEGER NOT NULL REFERENCES execution (id),
            position INTEGER NOT NULL,
            clause INTEGER NOT NULL,
            verdict INTEGER NOT NULL,
            robustness REAL,
            unit INTEGER NOT NULL,
            at REAL,
            reason INTEGER NOT NULL,
            cause INTEGER NOT NULL,
            PRIMARY KEY (execution, position)
        ) WITHOUT ROWID""",
    ),
)


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


class StudyStore:
    """The results of a study. Every method raises ``DatabaseProblem`` if the database cannot be used."""

    def __init__(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        ignore = folder / ".gitignore"
        if not ignore.exists():
            replace_file(ignore, "*\n")
        self.path = folder / NAME
        self._connection = open_database(self.path, migrations=MIGRATIONS)
        self._words: dict[str, int] = {}

    def close(self) -> None:
        """Close the database."""
        self._connection.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def fact(self, name: str) -> str | None:
        """Return a fact about the study, such as the digest of its models; ``None`` if it was never noted."""
        with explained(self.path):
            row = self._connection.execute("SELECT content FROM fact WHERE name = ?", (name,)).fetchone()
        return None if row is None else str(row[0])

    def facts(self) -> Mapping[str, str]:
        """Return all facts about the study by name: its name, versions, and digests of what it used."""
        return dict(self._rows("SELECT name, content FROM fact ORDER BY name"))

    def note(self, facts: Mapping[str, str]) -> None:
        """Store facts about the study."""
        with self._writing() as connection:
            connection.executemany("INSERT OR REPLACE INTO fact (name, content) VALUES (?, ?)", facts.items())

    def batches(self) -> frozenset[int]:
        """Return the numbers of the stored batches."""
        with explained(self.path):
            return frozenset(number for (number,) in self._connection.execute("SELECT number FROM batch"))

    def add(self, batch: int, cell: str, levels: Mapping[str, str], results: RunResults) -> None:
        """Store the executions of a batch. ``levels`` are those of the study's factors."""
        with self._writing() as connection:
            self._words.clear()
            row = (batch, cell, self._word(connection, platform.node()))
            connection.execute("INSERT INTO batch (number, cell, host) VALUES (?, ?, ?)", row)
            for scenario in results.scenarios:
                self._add(connection, batch, self._combination(connection, cell, levels, scenario.spec), scenario)

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
        """Yield the number of executions and of those that hold in each batch, after its number."""
        yield from self._rows("SELECT batch, count(*), sum(verdict = 0) FROM execution GROUP BY batch ORDER BY batch")

    def wall(self) -> float:
        """Return the sum of the wall times of all executions in s."""
        return next(self._rows("SELECT coalesce(sum(wall), 0) FROM execution"))[0]

    def rows(self) -> Iterator[dict[str, Any]]:
        """Yield one flat dictionary for each clause of each execution, in the order of the study.

        The levels of factors and the values of variables are in columns called ``level.NAME``.
        """
        query = """SELECT levels, combination.name, variant, variation, combination.execution, repetition, seed,
                simulated, execution.verdict, name.content, clause.verdict, robustness, unit.content, at, reason.content
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

    def _rows(self, query: str) -> Iterator[tuple[Any, ...]]:
        with explained(self.path):
            yield from self._connection.execute(query)

    def _add(self, connection: sqlite3.Connection, batch: int, combination: int, scenario: ScenarioResult) -> None:
        spec, finished = scenario.spec, scenario.finished
        simulated, wall = (0.0, 0.0) if finished is None else (finished.simulated, finished.wall)
        row = (batch, combination, spec.repetition, spec.seed, OUTCOMES.index(scenario.verdict), simulated, wall)
        places = "INSERT INTO execution (batch, combination, repetition, seed, verdict, simulated, wall) "
        execution = connection.execute(f"{places} VALUES (?, ?, ?, ?, ?, ?, ?)", row).lastrowid
        clauses = (
            (execution, position, self._word(connection, clause.name), *self._verdict(connection, judged))
            for position, clause in enumerate(spec.clauses)
            for judged in (scenario.judged.get(clause.line) or unjudged(clause),)
        )
        connection.executemany("INSERT INTO clause VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)", clauses)

    def _verdict(self, connection: sqlite3.Connection, judged: ClauseJudged) -> Iterable[object]:
        unit, reason, cause = (
            self._word(connection, text) for text in (judged.unit, judged.reason, str(judged.cause or ""))
        )
        return OUTCOMES.index(Outcome(judged.verdict)), judged.robustness, unit, judged.at, reason, cause

    def _combination(
        self, connection: sqlite3.Connection, cell: str, levels: Mapping[str, str], spec: ScenarioSpec
    ) -> int:
        execution = "" if spec.execution is None else spec.execution.name
        key = (cell, spec.variant, spec.variation, execution)
        query = "SELECT id FROM combination WHERE cell = ? AND variant = ? AND variation = ? AND execution = ?"
        known = connection.execute(query, key).fetchone()
        if known is not None:
            return int(known[0])
        written = json.dumps({**levels, **spec.values})
        name = spec.name.partition(" (repetition ")[0]
        columns = "INSERT INTO combination (cell, variant, variation, execution, story, name, levels) "
        cursor = connection.execute(f"{columns} VALUES (?, ?, ?, ?, ?, ?, ?)", (*key, spec.story, name, written))
        return int(cursor.lastrowid or 0)

    def _word(self, connection: sqlite3.Connection, content: str) -> int:
        known = self._words.get(content)
        if known is None:
            connection.execute("INSERT OR IGNORE INTO word (content) VALUES (?)", (content,))
            (known,) = connection.execute("SELECT id FROM word WHERE content = ?", (content,)).fetchone()
            self._words[content] = known
        return known

    @contextmanager
    def _writing(self) -> Generator[sqlite3.Connection]:
        with explained(self.path), transaction(self._connection):
            yield self._connection
