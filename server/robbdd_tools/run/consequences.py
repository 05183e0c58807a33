"""Find the clauses that are unknown only because of another clause, which has the reason."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Protocol

from robbdd_tools.monitor.verdict import Cause, Outcome

_WAITING = (Cause.NO_EVENT, Cause.UNREACHED)
"""Causes of clauses that wait for something that never happened. Their reason ends with that of what stopped it."""


class JudgedClause(Protocol):
    """A verdict on a clause, from a message or from stored results."""

    @property
    def verdict(self) -> str:
        """``holds``, ``violated`` or ``unknown``."""
        ...

    @property
    def reason(self) -> str:
        """Why the clause is violated or unknown."""
        ...

    @property
    def cause(self) -> str | None:
        """The type of the reason of an unknown verdict."""
        ...


def consequences(clauses: Iterable[tuple[str, JudgedClause]]) -> Iterator[str]:
    """Yield for each clause of an execution words that name its cause; empty if it is no consequence of another one.

    The clauses are given by their names and verdicts, in the order of the scenario. A clause is a consequence of an
    earlier one if it is unknown for the same reason, or if it waits for something that never happened for that reason.
    """
    causes: list[tuple[str, JudgedClause]] = []
    for name, judged in clauses:
        found = next(((other, one) for other, one in causes if other != name and _is_cause(one, judged)), None)
        if found is None:
            if judged.verdict != Outcome.HOLDS and judged.reason:
                causes.append((name, judged))
            yield ""
        else:
            same = found[1].reason == judged.reason
            yield f"unknown for the same reason as {found[0]}" if same else f"unknown because of {found[0]}"


def _is_cause(earlier: JudgedClause, judged: JudgedClause) -> bool:
    if judged.verdict != Outcome.UNKNOWN:
        return False
    if earlier.reason == judged.reason:
        return earlier.verdict == Outcome.VIOLATED or earlier.cause == judged.cause
    return judged.cause in _WAITING and judged.reason.endswith(f": {earlier.reason}")
