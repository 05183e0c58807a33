"""The store of one study: a database that stays small with hundreds of thousands of finished executions.

Texts that executions share (names, reasons, units, values of variables) are stored once. Executions arrive in batches.
Each batch is committed as a whole. Wall times and hosts may differ between equal studies; nothing else does.
"""

from __future__ import annotations

import json
import platform
import sqlite3
from collections.abc import Generator, Iterable, Mapping, Sequence
from contextlib import closing, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.writing import replace_file
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.database import explained, open_database, transaction
from robbdd_tools.run.results import unjudged
from robbdd_tools.run.study_reader import OUTCOMES, TABLES, StudyReader, read_study_store
from robbdd_tools.run.study_schema import MIGRATIONS, NAME

if TYPE_CHECKING:
    from robbdd_tools.protocol.messages import ClauseJudged
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.run.results import RunResults, ScenarioResult


class StudyStore(StudyReader):
    """The results of a study, open for writing. Methods raise ``DatabaseProblem`` if the database cannot be used."""

    def __init__(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        ignore = folder / ".gitignore"
        if not ignore.exists():
            replace_file(ignore, "*\n")
        super().__init__(folder / NAME, open_database(folder / NAME, migrations=MIGRATIONS))
        self._words: dict[str, int] = {}

    def note(self, facts: Mapping[str, str]) -> None:
        """Store facts about the study."""
        with self._writing() as connection:
            connection.executemany("INSERT OR REPLACE INTO fact (name, content) VALUES (?, ?)", facts.items())

    def add(self, batch: int, cell: str, levels: Mapping[str, str], results: RunResults) -> None:
        """Store the executions of a batch. ``levels`` maps the study's factors to their levels."""
        with self._writing() as connection:
            self._words.clear()
            row = (batch, cell, self._word(connection, platform.node()))
            connection.execute("INSERT INTO batch (number, cell, host) VALUES (?, ?, ?)", row)
            for scenario in results.scenarios:
                self._add(connection, batch, self._combination(connection, cell, levels, scenario.spec), scenario)

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


def restore(folder: Path, tables: Mapping[str, Sequence[Sequence[object]]]) -> StudyReader:
    """Write the rows of ``StudyReader.tables`` into a new store, and open it for reading.

    Raises ``DatabaseProblem``, and ``ValueError`` for rows that do not fit the tables.
    """
    path = folder / NAME
    with explained(path), closing(open_database(path, migrations=MIGRATIONS)) as connection, transaction(connection):
        for name in TABLES:
            for row in tables[name]:
                connection.execute(f"INSERT INTO {name} VALUES ({', '.join('?' * len(row))})", tuple(row))
    return read_study_store(folder)
