"""The requirements of a run or a study with its results: requirement → scenarios → clauses → verdicts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.monitor.verdict import Outcome

if TYPE_CHECKING:
    from robbdd_tools.graph.verified_requirements import LinkedRequirement, VerifyingVariant
    from robbdd_tools.workbench.execution_rows import ClauseResult, ExecutionResult

NO_SCENARIO, NOT_RUN, VACUOUS = "no scenario", "not run", "proves little"
INCOMPLETE = "not run in full"
_WORST = (Outcome.VIOLATED, Outcome.UNKNOWN, Outcome.HOLDS)
_ORDER = ("violated", NO_SCENARIO, "unknown", VACUOUS, NOT_RUN, INCOMPLETE, "holds")
"""The verdicts on requirements, in the order of a report."""


@dataclass(frozen=True, slots=True)
class VerifyingClause:
    """A clause that verifies a requirement: its verdicts in the executions of one scenario variant."""

    name: str
    held: int
    total: int
    verdict: str
    vacuous: str


@dataclass(frozen=True, slots=True)
class VerifyingScenario:
    """A scenario variant that verifies a requirement. ``held`` of its ``total`` executions satisfy the requirement.

    ``clauses`` are those that verify it, if there are executions. ``left`` is the number of its scenarios without an
    execution.
    """

    name: str
    held: int
    total: int
    verdict: str
    clauses: tuple[VerifyingClause, ...]
    left: int = 0


@dataclass(frozen=True, slots=True)
class RequirementResult:
    """A requirement with its results.

    ``verdict`` is ``holds``, ``violated`` or ``unknown``; or ``no scenario``, ``not run`` (some scenario that verifies
    it), ``not run in full`` (only some of a variant's scenarios) or ``proves little`` (no clause that verifies it could
    have failed), which are no proof either.
    """

    label: str
    text: str
    source: str
    verdict: str
    scenarios: tuple[VerifyingScenario, ...]

    @property
    def held(self) -> int:
        """The number of executions that satisfy the requirement."""
        return sum(one.held for one in self.scenarios)

    @property
    def total(self) -> int:
        """The number of executions of its scenarios."""
        return sum(one.total for one in self.scenarios)


def requirement_results(
    links: Sequence[LinkedRequirement], results: Sequence[ExecutionResult]
) -> list[RequirementResult]:
    """Return each requirement with the results of a run or study; those that are not shown come first."""
    by_variant: dict[str, list[ExecutionResult]] = {}
    for result in results:
        by_variant.setdefault(result.variant, []).append(result)
    found = [_result(one, by_variant) for one in links]
    return sorted(found, key=lambda one: _ORDER.index(one.verdict))


def requirement_summary(found: Sequence[RequirementResult]) -> str:
    """Return how many requirements are shown, and why the others are not."""
    counted = Counter(one.verdict for one in found)
    counted[INCOMPLETE] += counted.pop(NOT_RUN, 0)
    others = [f"{counted[one]} {_WORDS[one]}" for one in _WORDS if counted[one]]
    return f"{counted['holds']} of {len(found)} requirements shown{''.join(f', {one}' for one in others)}"


_WORDS = {
    "violated": "violated",
    "unknown": "unknown",
    NO_SCENARIO: "without scenario",
    VACUOUS: "with clauses only that could not have failed",
    INCOMPLETE: INCOMPLETE,
}


def _result(one: LinkedRequirement, by_variant: Mapping[str, Sequence[ExecutionResult]]) -> RequirementResult:
    scenarios = tuple(_scenario(variant, by_variant.get(variant.iri, ())) for variant in one.variants)
    label = f"{one.name} ({one.identifier})" if one.identifier else one.name
    return RequirementResult(label, one.text, one.source, _verdict(scenarios), scenarios)


def _verdict(scenarios: Sequence[VerifyingScenario]) -> str:
    if not scenarios:
        return NO_SCENARIO
    known = {one.verdict for one in scenarios if one.total}
    failed = next((str(one) for one in _WORST[:2] if str(one) in known), "")
    if failed:
        return failed
    if not all(one.total for one in scenarios):
        return NOT_RUN
    if any(one.left for one in scenarios):
        return INCOMPLETE
    judged = [clause for one in scenarios for clause in one.clauses if clause.total]
    return VACUOUS if judged and all(clause.vacuous for clause in judged) else "holds"


def _scenario(variant: VerifyingVariant, results: Sequence[ExecutionResult]) -> VerifyingScenario:
    outcomes = [_outcome(variant, result) for result in results]
    clauses = tuple(_clauses(variant, results)) if results else ()
    verdict = str(_worst(outcomes)) if outcomes else NOT_RUN
    executed = len({one.variation for one in results})
    left = max(0, (variant.scenarios or executed) - executed)
    if left and verdict == Outcome.HOLDS:
        verdict = INCOMPLETE
    return VerifyingScenario(variant.name, outcomes.count(Outcome.HOLDS), len(outcomes), verdict, clauses, left)


def _outcome(variant: VerifyingVariant, result: ExecutionResult) -> Outcome:
    """Return the outcome of an execution for a requirement: that of the scenario, or the worst of its clauses."""
    if variant.whole:
        return result.verdict
    judged = [clause.verdict for clause in result.clauses if _named(variant, clause)]
    return _worst(judged) if judged else Outcome.UNKNOWN


def _clauses(variant: VerifyingVariant, results: Sequence[ExecutionResult]) -> Iterator[VerifyingClause]:
    for iri, name in variant.clauses.items():
        own = [[one for one in result.clauses if _named(variant, one) == iri] for result in results]
        verdicts = [_worst([one.verdict for one in several]) for several in own if several]
        every = [one for several in own for one in several]
        vacuous = every[0].vacuous if every and all(one.vacuous for one in every) else ""
        verdict = str(_worst(verdicts)) if verdicts else NOT_RUN
        yield VerifyingClause(name, verdicts.count(Outcome.HOLDS), len(verdicts), verdict, vacuous)


def _named(variant: VerifyingVariant, clause: ClauseResult) -> str:
    """Return the IRI of the verifying clause of a result, or ``""``. A study stores only names of clauses."""
    if clause.iri in variant.clauses:
        return clause.iri
    return next((iri for iri, name in variant.clauses.items() if clause.iri == name), "")


def _worst(outcomes: Sequence[Outcome]) -> Outcome:
    return min(outcomes, key=_WORST.index)
