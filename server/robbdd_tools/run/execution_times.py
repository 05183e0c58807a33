"""Wall time of stored executions: how long a scenario usually takes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from robbdd_tools.run.database import explained, read_database

NEWEST = 200
"""At most this many executions of a variant count, the newest ones. Older ones may be of another model."""
_QUERY = "SELECT wall FROM execution WHERE variant = ? ORDER BY id DESC LIMIT ?"


@dataclass(frozen=True, slots=True)
class Duration:
    """The median wall time of the stored executions of a variant in s, and the number of these executions."""

    seconds: float
    executions: int


def usual_durations(database: Path, variants: Iterable[str]) -> Mapping[str, Duration]:
    """Return the usual durations of variants, given by their IRIs. Variants without an execution are missing.

    Raises ``DatabaseProblem``.
    """
    from statistics import median

    with explained(database):
        connection = read_database(database)
        if connection is None:
            return {}
        with closing(connection):
            found = {iri: connection.execute(_QUERY, (iri, NEWEST)).fetchall() for iri in dict.fromkeys(variants)}
    return {iri: Duration(median(wall for (wall,) in rows), len(rows)) for iri, rows in found.items() if rows}
