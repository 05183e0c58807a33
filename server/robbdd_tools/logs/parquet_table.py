"""Read the rows of Parquet files as texts, like those of a CSV file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import closing
from importlib import import_module
from pathlib import Path
from typing import Any

from robbdd_tools.base.files import open_regular
from robbdd_tools.logs.log_contents import UnreadableLog

PARQUET = ".parquet"
PATTERN = "*?["
"""Characters with which DuckDB reads several files."""
AT_ONCE = 10_000


def parquet_titles(path: Path) -> list[str]:
    """Return the titles of the columns. Raises ``UnreadableLog``, and ``OSError`` if the file cannot be opened."""
    with closing(_connected(path)) as connection:
        return list(_types(path, connection))


def parquet_rows(path: Path) -> Iterator[Mapping[str, str]]:
    """Yield each row in the order of the file; an empty text for a missing value. Raises like ``parquet_titles``."""
    with closing(_connected(path)) as connection:
        types = _types(path, connection)
        chosen = ", ".join(_chosen(title, kind) for title, kind in types.items())
        found = _executed(path, connection, f"SELECT {chosen} FROM read_parquet(?)")
        while rows := found.fetchmany(AT_ONCE):
            for row in rows:
                yield {title: _text(value) for title, value in zip(types, row, strict=True)}


def _connected(path: Path) -> Any:
    with open_regular(path):
        pass
    if any(letter in str(path) for letter in PATTERN):
        raise UnreadableLog(f"{path} cannot be read: its path must not have {', '.join(PATTERN)}")
    try:
        duckdb = import_module("duckdb")
    except ImportError:
        raise UnreadableLog(
            f"{path.name} needs DuckDB: pip install 'robbdd-tools[analysis]', or write a .csv"
        ) from None
    # One thread keeps the order of the rows; extensions would be loaded from a network.
    return duckdb.connect(":memory:", config={"threads": 1, "autoinstall_known_extensions": False})


def _types(path: Path, connection: Any) -> dict[str, str]:
    rows = _executed(path, connection, "DESCRIBE SELECT * FROM read_parquet(?)").fetchall()
    return {str(row[0]): str(row[1]) for row in rows}


def _executed(path: Path, connection: Any, query: str) -> Any:
    try:
        return connection.execute(query, [str(path)])
    except Exception as error:  # The classes of DuckDB's errors are only known when it is loaded.
        raise UnreadableLog(f"{path} cannot be read as Parquet: {str(error).splitlines()[0]}") from error


def _chosen(title: str, kind: str) -> str:
    """Return the expression of a column; points in time become seconds since 1970."""
    quoted = '"' + title.replace('"', '""') + '"'
    return f"epoch_ns({quoted}) / 1e9" if kind.startswith("TIMESTAMP") else quoted


def _text(value: object) -> str:
    return "" if value is None else repr(value) if isinstance(value, float) else str(value)
