"""Write the rows of a study as CSV, Parquet or a DuckDB database."""

from __future__ import annotations

import csv
import tempfile
from collections.abc import Iterable, Mapping
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import load_bytes
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.base.writing import replace_file, replacing
from robbdd_tools.run.study_reader import COLUMNS

if TYPE_CHECKING:
    from robbdd_tools.run.study_reader import StudyReader

PARQUET, DUCKDB = ".parquet", ".duckdb"
TABLE = "clauses"
"""Name of the table of rows in a database; the table ``facts`` has the versions."""
_TYPES = {
    **dict.fromkeys(("number", "variation", "repetition", "seed"), "BIGINT"),
    **dict.fromkeys(("duration", "margin", "at"), "DOUBLE"),
}
"""Types of columns that are not text."""


class TableProblem(RobbddError):
    """A table cannot be written; the message gives the reason."""


def write_table(store: StudyReader, output: Path) -> None:
    """Write one row for each clause of each execution; the suffix of ``output`` chooses the format, CSV for others.

    Equal studies have equal CSV and Parquet files. Raises ``TableProblem``, ``DatabaseProblem`` and ``OSError``.
    """
    columns = _columns(store)
    if output.suffix not in (PARQUET, DUCKDB):
        with replacing(output) as file:
            _write_csv(store, columns, file)
        return
    try:
        duckdb: Any = import_module("duckdb")
    except ImportError:
        raise TableProblem(f"{output.name} needs DuckDB: install robbdd-tools[analysis], or write a .csv") from None
    with tempfile.TemporaryDirectory(prefix="robbdd-") as name:
        rows, made = Path(name) / "rows.csv", Path(name) / f"made{output.suffix}"
        with replacing(rows) as file:
            _write_csv(store, columns, file)
        connection = duckdb.connect(str(made) if output.suffix == DUCKDB else ":memory:")
        try:
            # One thread keeps the order of the rows, so that equal studies have equal files.
            connection.execute("SET threads = 1")
            connection.execute(f"CREATE TABLE {TABLE} AS SELECT * FROM {_reader(rows, columns)}")
            if output.suffix == PARQUET:
                connection.execute(f"COPY {TABLE} TO {_quoted(str(made))} (FORMAT parquet, COMPRESSION zstd)")
            else:
                connection.execute("CREATE TABLE facts (name VARCHAR, content VARCHAR)")
                connection.executemany("INSERT INTO facts VALUES (?, ?)", list(store.facts().items()))
        finally:
            connection.close()
        replace_file(output, load_bytes(made, RESULT_SIZE))


def _columns(store: StudyReader) -> Mapping[str, str]:
    """Return the columns with their types. Levels are numbers if all values of a factor are."""
    levels: dict[str, list[object]] = {}
    for count in store.counts():
        for name, value in count.levels.items():
            levels.setdefault(f"level.{name}", []).append(value)
    return {
        **{name: _type(values) for name, values in levels.items()},
        **{name: _TYPES.get(name, "VARCHAR") for name in COLUMNS},
    }


def _type(values: Iterable[object]) -> str:
    kinds = {type(value) for value in values}
    if kinds == {int}:
        return "BIGINT"
    return "DOUBLE" if kinds <= {int, float} else "VARCHAR"


def _write_csv(store: StudyReader, columns: Mapping[str, str], file: TextIO) -> None:
    writer = csv.DictWriter(file, columns, lineterminator="\n")
    writer.writeheader()
    writer.writerows(store.rows())


def _reader(path: Path, columns: Mapping[str, str]) -> str:
    """Return the SQL function that reads the rows. An empty text is text; an empty number is missing."""
    types = ", ".join(f"{_quoted(name)}: {_quoted(kind)}" for name, kind in columns.items())
    texts = ", ".join(_quoted(name) for name, kind in columns.items() if kind == "VARCHAR")
    form = "header = true, delim = ',', quote = '\"', escape = '\"', auto_detect = false"
    return f"read_csv({_quoted(str(path))}, {form}, columns = {{{types}}}, force_not_null = [{texts}])"


def _quoted(text: str) -> str:
    return "'" + text.replace("'", "''") + "'"
