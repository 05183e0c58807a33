"""Match the executions of two runs that have the same scenario and values, and their clauses."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.readable import title
from robbdd_tools.workbench.execution_rows import ClauseResult, ExecutionResult

EVERY_CLAUSE = "every clause"
"""Name of the row that counts the executions in which all clauses hold."""
_BADNESS = (Outcome.VIOLATED, Outcome.UNKNOWN, Outcome.HOLDS)


class NothingShared(RobbddError):
    """Two runs have no execution or no clause in common."""


@dataclass(frozen=True, slots=True)
class Judged:
    """The verdict of one execution on a clause, with its margin in the clause's unit; ``None`` if not measured."""

    verdict: Outcome
    margin: float | None


@dataclass(frozen=True, slots=True)
class MatchedClause:
    """A clause with its verdicts in both runs. Position *i* of ``before`` and of ``after`` is the same scenario.

    The row of all clauses together has an empty ``iri`` and the ``role`` ``scenario``. ``unit`` is the unit of the
    margins.
    """

    iri: str
    name: str
    role: str
    unit: str
    before: tuple[Judged, ...]
    after: tuple[Judged, ...]


@dataclass(frozen=True, slots=True)
class MatchedRuns:
    """The executions that two runs have in common.

    - ``paired``: whether all of them have the same seed in both runs, so that they differ by what was changed alone.
    - ``shared``: their number. ``before_only`` and ``after_only`` count the executions of one run alone.
    - ``clauses``: the clauses of both runs, after the row of all clauses together.
    - ``removed``, ``added``: the names of the clauses that only the earlier, or only the later run has.
    """

    paired: bool
    shared: int
    before_only: int
    after_only: int
    clauses: tuple[MatchedClause, ...]
    removed: tuple[str, ...]
    added: tuple[str, ...]


def match(before: Iterable[ExecutionResult], after: Iterable[ExecutionResult]) -> MatchedRuns:
    """Match the executions of two runs. Raises ``NothingShared``.

    An execution is identified by its variant, values, ``.bddx`` execution and repetition. A clause that is repeated
    within an execution counts with its worst verdict and its smallest margin.
    """
    one, other = ({execution_key(result): result for result in run} for run in (before, after))
    shared = [(one[key], other[key]) for key in one if key in other]
    if not shared:
        raise NothingShared("the runs have no execution of the same scenario with the same values in common")
    sides = [(_by_iri(old), _by_iri(new)) for old, new in shared]
    known = {iri: clause for side in chain.from_iterable(sides) for iri, clause in side.items()}
    clauses = [_matched(iri, clause, sides) for iri, clause in known.items()]
    common = [clause for clause in clauses if clause.before]
    if not common:
        raise NothingShared("the runs have no clause in common: their models differ")
    return MatchedRuns(
        all(old.seed == new.seed for old, new in shared),
        len(shared),
        len(one) - len(shared),
        len(other) - len(shared),
        (_whole(shared), *common),
        *_unshared(sides),
    )


def _unshared(
    sides: Iterable[tuple[Mapping[str, ClauseResult], Mapping[str, ClauseResult]]],
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    removed: dict[str, str] = {}
    added: dict[str, str] = {}
    for old, new in sides:
        removed |= {iri: title(clause.name, clause.sentence) for iri, clause in old.items() if iri not in new}
        added |= {iri: title(clause.name, clause.sentence) for iri, clause in new.items() if iri not in old}
    return tuple(removed.values()), tuple(added.values())


def execution_key(result: ExecutionResult) -> str:
    """Return the key by which an execution is found in another run."""
    return json.dumps([result.variant, dict(result.values), result.execution, result.repetition], sort_keys=True)


def _by_iri(result: ExecutionResult) -> Mapping[str, ClauseResult]:
    worst: dict[str, ClauseResult] = {}
    for clause in result.clauses:
        known = worst.get(clause.iri)
        if known is None or _rank(clause) < _rank(known):
            worst[clause.iri] = clause
    return worst


def _rank(clause: ClauseResult) -> tuple[int, float]:
    return _BADNESS.index(clause.verdict), float("inf") if clause.margin is None else clause.margin


def _matched(
    iri: str, clause: ClauseResult, sides: Sequence[tuple[Mapping[str, ClauseResult], Mapping[str, ClauseResult]]]
) -> MatchedClause:
    pairs = [(old[iri], new[iri]) for old, new in sides if iri in old and iri in new]
    units = {one.unit for pair in pairs for one in pair if one.margin is not None}
    # Margins in two units cannot be compared: the predicate of the clause has changed.
    unit = units.pop() if len(units) == 1 else ""
    before, after = (
        zip(*((_judged(old, unit), _judged(new, unit)) for old, new in pairs), strict=True) if pairs else ((), ())
    )
    return MatchedClause(iri, title(clause.name, clause.sentence), clause.role, unit, before, after)


def _judged(clause: ClauseResult, unit: str) -> Judged:
    return Judged(clause.verdict, clause.margin if unit else None)


def _whole(shared: Iterable[tuple[ExecutionResult, ExecutionResult]]) -> MatchedClause:
    def sides() -> Iterator[tuple[Judged, Judged]]:
        for old, new in shared:
            yield Judged(old.verdict, None), Judged(new.verdict, None)

    before, after = zip(*sides(), strict=True)
    return MatchedClause("", EVERY_CLAUSE, "scenario", "", before, after)
