"""Results of executions without a run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.workbench.execution_rows import ClauseResult, ExecutionResult

UNKNOWN = float("nan")
"""Stands for the margin of a clause whose verdict is unknown."""


def clause(name: str, margin: float, unit: str = "m") -> ClauseResult:
    """Return a judged clause: it holds if its margin is above 0, and is unknown if it is ``UNKNOWN``."""
    known = margin == margin
    verdict = Outcome.UNKNOWN if not known else Outcome.HOLDS if margin > 0 else Outcome.VIOLATED
    found = margin if known and unit else None
    return ClauseResult(name, f"https://x/{name}", "then", name, verdict, found, unit, None, None, "", "")


def executions(margins: Mapping[str, Sequence[float]], seed: int = 0, unit: str = "m") -> list[ExecutionResult]:
    """Return executions of one variant; each clause is given by its name and its margin in each execution."""
    return list(_executions(margins, seed, unit))


def _executions(margins: Mapping[str, Sequence[float]], seed: int, unit: str) -> Iterator[ExecutionResult]:
    for index, row in enumerate(zip(*margins.values(), strict=True)):
        clauses = tuple(clause(name, value, unit) for name, value in zip(margins, row, strict=True))
        verdicts = [one.verdict for one in clauses]
        worst = next(one for one in (Outcome.VIOLATED, Outcome.UNKNOWN, Outcome.HOLDS) if one in verdicts)
        name, variant, values = f"e:v -- {index + 1}", "https://x/v", {"e:var-x": index}
        yield ExecutionResult(
            index, name, "https://x/s", variant, index + 1, 1, "", "m.bdd", values, seed + index, worst, 1.0, clauses
        )
