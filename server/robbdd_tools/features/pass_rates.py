"""Pass rates, and the number of executions that they lack: a rate of some of the scenarios is no pass."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.features.rejudged_results import BADNESS, SIGNS
from robbdd_tools.features.run_verdicts import execution_digest, variant_digest
from robbdd_tools.features.scenarios import scenario_numbers
from robbdd_tools.names.variant_places import VariantIris

if TYPE_CHECKING:
    from robbdd_tools.features.executions import PlacedExecution
    from robbdd_tools.features.run_verdicts import Findings, JudgedScenario
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.names.variant_places import PlacedVariant

STALE = "(stale)"
Missing = int | None
"""The number of executions that have no result yet; ``None`` if it is unknown, because a set of values is unknown."""


@dataclass(frozen=True, slots=True)
class PassRate:
    """The numbers of a variant's executions that passed, that were run and that are missing.

    ``worst`` is the worst outcome of those that were run.
    """

    passed: int
    run: int
    worst: str
    stale: bool
    missing: Missing = 0

    @property
    def outcome(self) -> str:
        """The outcome of all executions that there should be."""
        return outcome_of_all(self.worst, self.missing)

    @property
    def label(self) -> str:
        """The pass rate as text."""
        counts = counted(self.passed, self.run, self.missing, "passed")
        return f"{SIGNS[self.outcome]} {counts}" + (f" {STALE}" if self.stale else "")


def outcome_of_all(worst: str, missing: Missing) -> str:
    """Return the outcome of executions, some of which may be missing, from the worst outcome of the others."""
    return "unknown" if worst == "holds" and missing != 0 else worst


def counted(passed: int, run: int, missing: Missing, word: str) -> str:
    """Return numbers of executions as text, such as ``2/2 passed`` or ``2 of 4 executed, 2 passed``."""
    return f"{passed}/{run} {word}" if missing == 0 else f"{extent(run, missing)}, {passed:,} {word}"


def extent(run: int, missing: Missing) -> str:
    """Return how many executions have a result, as text, such as ``2 of 4 executed``."""
    return f"{run:,} executed, others unknown" if missing is None else f"{run:,} of {run + missing:,} executed"


def missing_executions(known: Iterable[JudgedScenario], count: int | None) -> Missing:
    """Return how many executions of a variant with ``count`` scenarios have not finished.

    A scenario is expected as often as the run repeated it that executed it last. Each execution of a ``.bddx`` with
    results is expected to execute all scenarios; a result without an execution counts for each of them.
    """
    every = list(known)
    if count is None:
        return None
    by_execution = {one.execution for one in every} - {""} or {""}
    return sum(_missing([one for one in every if one.execution in ("", own)], count) for own in by_execution)


def expected_executions(known: Iterable[JudgedScenario], count: int | None) -> int | None:
    """Return how many executions a variant with ``count`` scenarios should have, those that have finished included."""
    every = list(known)
    missing = missing_executions(every, count)
    return None if missing is None else missing + sum(one.finished for one in every)


def _missing(known: list[JudgedScenario], count: int) -> int:
    expected: dict[int, int] = {}
    finished: dict[int, int] = {}
    for one in known:
        expected[one.variation] = max(expected.get(one.variation, 1), one.repetition, one.repetitions)
        finished[one.variation] = finished.get(one.variation, 0) + one.finished
    begun = sum(max(0, number - finished[scenario]) for scenario, number in expected.items())
    return begun + max(0, count - len(expected)) * max(expected.values(), default=1)


class ExpectedExecutions:
    """The numbers of executions of the variants of a file and of the files that import it, by IRI."""

    def __init__(self, snapshot: Snapshot, uri: str) -> None:
        self._snapshot, self._uri = snapshot, uri
        self._counts: dict[str | None, int | None] = {}
        self._totals: dict[str, int | None] = {}
        self._is_read = False

    def of(self, scenarios: Iterable[JudgedScenario], findings: Findings) -> int | None:
        """Return how many executions the variants of some scenarios should have; ``None`` if this is unknown."""
        found = [self._expected(variant, findings) for variant in {one.variant for one in scenarios}]
        known = [one for one in found if one is not None]
        return sum(known) if len(known) == len(found) else None

    def _expected(self, variant: str, findings: Findings) -> int | None:
        if variant not in self._totals:
            self._totals[variant] = expected_executions(findings.variants.get(variant, ()), self._count(variant))
        return self._totals[variant]

    def _count(self, variant: str) -> int | None:
        if not self._is_read:
            self._is_read = True
            for uri in (*self._snapshot.importers(self._uri), self._uri):
                self._read(uri)
        return self._counts.get(variant)

    def _read(self, uri: str) -> None:
        for file in self._snapshot.closure(uri):
            iris = VariantIris(self._snapshot, file)
            for placed, numbers in scenario_numbers(self._snapshot, file):
                self._counts |= zip(iris.of(placed), numbers, strict=True)


def pass_rate(snapshot: Snapshot, variant: PlacedVariant, findings: Findings, count: int | None) -> PassRate | None:
    """Return the pass rate of a variant with ``count`` scenarios in its last runs, or ``None`` if it was never run."""
    known = findings.variants.get(variant.iri)
    if known is None:
        return None
    now = variant_digest(snapshot, variant)
    return _rate(known, [one.digest == now for one in known], count)


def execution_rate(
    snapshot: Snapshot, execution: PlacedExecution, findings: Findings, count: int | None
) -> PassRate | None:
    """Return the pass rate of an execution's variant, of ``count`` scenarios, in its last runs by this execution.

    Returns ``None`` if there are no such runs.
    """
    now = execution_digest(snapshot, execution)
    own = [one for one in findings.variants.get(execution.variant.iri, ()) if one.execution == execution.iri]
    return _rate(own, [one.execution_digest == now for one in own], count)


def _rate(known: Iterable[JudgedScenario], current: Iterable[bool], count: int | None) -> PassRate | None:
    """Return the pass rate of scenarios. ``current`` has a flag for each that is true if its run judged this text."""
    every = list(known)
    finished = [(one.outcome, is_current) for one, is_current in zip(every, current, strict=True) if one.finished]
    if not finished:
        return None
    outcomes = [outcome for outcome, _ in finished]
    worst = min(outcomes, key=BADNESS.index)
    stale = not all(is_current for _, is_current in finished)
    return PassRate(outcomes.count("holds"), len(outcomes), worst, stale, missing_executions(every, count))
