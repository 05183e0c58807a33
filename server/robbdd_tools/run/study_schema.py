"""The schema of the store of one study."""

from __future__ import annotations

from robbdd_tools.run.database import Migrations

NAME = "study.sqlite"
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
