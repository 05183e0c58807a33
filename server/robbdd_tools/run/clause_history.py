"""The verdicts on one clause in all stored runs of a project."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from contextlib import closing
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.database import explained, read_database

_BADNESS = (Outcome.VIOLATED, Outcome.UNKNOWN, Outcome.HOLDS)
_QUERY = """SELECT run.number, run.began, execution.idx, clause.verdict, clause.robustness, clause.unit
    FROM clause JOIN execution ON execution.id = clause.execution JOIN run ON run.number = execution.run
    WHERE clause.iri = ? ORDER BY run.number, execution.idx"""


@dataclass(frozen=True, slots=True)
class ClauseRun:
    """The verdicts of one run on a clause.

    - ``began``: the time at which the run began (ISO 8601).
    - ``counts``: the number of executions with each verdict. If a clause is repeated within an execution, its worst
      verdict counts.
    - ``margin``: the smallest margin in ``unit`` (SI); ``None`` if no margin was measured.
    - ``worst``: the number of the execution with the worst verdict and, among these, the smallest margin.
    """

    run: int
    began: str
    counts: Mapping[str, int]
    margin: float | None
    unit: str
    worst: int

    @property
    def total(self) -> int:
        """The number of executions in which the clause was judged."""
        return sum(self.counts.values())

    @property
    def holding(self) -> int:
        """The number of executions in which the clause holds."""
        return self.counts.get(Outcome.HOLDS, 0)

    @property
    def verdict(self) -> Outcome:
        """The worst verdict of the run on the clause."""
        return next(one for one in _BADNESS if self.counts.get(one))


def clause_history(database: Path, clause: str) -> list[ClauseRun]:
    """Return the runs in a database that judged a clause, given by its IRI, oldest first. Raises ``DatabaseProblem``.

    An unfinished run counts with its finished executions.
    """
    with explained(database):
        connection = read_database(database)
        if connection is None:
            return []
        with closing(connection):
            rows = connection.execute(_QUERY, (clause,)).fetchall()
    return [_run(number, began, list(own)) for (number, began), own in groupby(rows, key=lambda row: row[:2])]


def _run(number: int, began: str, rows: Iterable[tuple[int, str, int, str, float | None, str]]) -> ClauseRun:
    verdicts: dict[int, Outcome] = {}
    ranked: list[tuple[int, float, int]] = []
    margins: list[tuple[float, str]] = []
    for _, _, index, word, margin, unit in rows:
        verdict = Outcome(word)
        verdicts[index] = min(verdict, verdicts.get(index, verdict), key=_BADNESS.index)
        ranked.append((_BADNESS.index(verdict), float("inf") if margin is None else margin, index))
        if margin is not None:
            margins.append((margin, unit))
    smallest, unit = min(margins, default=(None, ""))
    return ClauseRun(number, began, Counter(map(str, verdicts.values())), smallest, unit, min(ranked)[2])
