"""Find the clauses that are unknown only because of another clause."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Protocol

from robbdd_tools.monitor.verdict import Cause, Outcome

_WAITING = (Cause.NO_EVENT, Cause.UNREACHED)
"""Causes of clauses that wait for something that never happened. Their reason ends with the reason why it never did."""


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


@dataclass(frozen=True, slots=True)
class Consequence:
    """The clause of the same execution that is the cause of an unknown one.

    ``position`` is the number of this clause, from 0. ``same_reason`` is true if both are unknown for the same reason.
    """

    position: int
    name: str
    same_reason: bool

    @property
    def words(self) -> str:
        """A text that names the cause. It is shown instead of the reason."""
        return f"unknown {'for the same reason as' if self.same_reason else 'because of'} {self.name}"


class Causes:
    """The clauses of one execution that have a reason of their own."""

    def __init__(self) -> None:
        self._known: list[tuple[int, str, JudgedClause]] = []

    def add(self, position: int, name: str, judged: JudgedClause) -> Consequence | None:
        """Add a clause, and return the earlier clause that is its cause.

        A clause is a consequence of an earlier one if it is unknown for the same reason, or if it waits for something
        that never happened for that reason.
        """
        for number, other, one in self._known:
            if other != name and _is_cause(one, judged):
                return Consequence(number, other, one.reason == judged.reason)
        if judged.verdict != Outcome.HOLDS and judged.reason:
            self._known.append((position, name, judged))
        return None


def consequences(clauses: Iterable[tuple[str, JudgedClause]]) -> Iterator[Consequence | None]:
    """Yield for each clause of an execution the clause that is its cause, or ``None`` if it has none.

    The clauses are given by their names and verdicts, in the order of the scenario.
    """
    causes = Causes()
    return (causes.add(position, name, judged) for position, (name, judged) in enumerate(clauses))


def _is_cause(earlier: JudgedClause, judged: JudgedClause) -> bool:
    if judged.verdict != Outcome.UNKNOWN:
        return False
    if earlier.reason == judged.reason:
        return earlier.verdict == Outcome.VIOLATED or earlier.cause == judged.cause
    return judged.cause in _WAITING and judged.reason.endswith(f": {earlier.reason}")
