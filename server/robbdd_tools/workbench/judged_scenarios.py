"""Convert the verdicts of a run to the form that the editor stores and shows."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from robbdd_tools.base.files import uri_to_path
from robbdd_tools.features.run_verdicts import JudgedScenario, Judgement
from robbdd_tools.monitor.verdict import Cause, Outcome
from robbdd_tools.protocol.messages import never_judged
from robbdd_tools.protocol.specs import NO_PHYSICS
from robbdd_tools.run.readable import clause_title
from robbdd_tools.run.report import failure_words, margin, values_words, verdict_words
from robbdd_tools.run.store import project_root

if TYPE_CHECKING:
    from collections.abc import Iterable

    from robbdd_tools.features.run_verdicts import Digests
    from robbdd_tools.protocol.messages import ClauseJudged
    from robbdd_tools.protocol.specs import ClauseSpec, ScenarioSpec
    from robbdd_tools.run.consequences import Consequence

_BADNESS = {Outcome.VIOLATED: 0.0, Outcome.UNKNOWN: 1e6, Outcome.HOLDS: 2e6}


def judged_scenario(
    spec: ScenarioSpec,
    uri: str,
    digests: Digests,
    project: str,
    *,
    run: int,
    index: int,
    seed: int | None,
    repetitions: int = 1,
) -> JudgedScenario:
    """Return scenario number ``index`` (from 0) of a run, without verdicts.

    ``project`` is the root folder of the model's project (``project_of``); ``seed`` is the seed that the user gave;
    ``repetitions`` is how often the run was to execute the scenario.
    """
    execution = "" if spec.execution is None else spec.execution.iri
    return JudgedScenario(
        uri,
        spec.variant,
        spec.variation,
        values_words(spec),
        digests.variants.get(spec.variant, ""),
        digests.rows.get((spec.variant, spec.variation), ""),
        run=run,
        index=index,
        execution=execution,
        execution_digest=digests.executions.get(execution, ""),
        repetition=spec.repetition,
        repetitions=repetitions,
        seed=seed,
        substitution=spec.substitution,
        scene_instance=spec.chosen_scene,
        world=NO_PHYSICS if spec.world else None,
        project=project,
    )


class Repetitions:
    """How often a run was to execute each of its scenarios."""

    def __init__(self, scenarios: Iterable[ScenarioSpec]) -> None:
        self._most: dict[tuple[str, int, str], int] = {}
        for one in scenarios:
            self._most[_key(one)] = max(one.repetition, self._most.get(_key(one), 1))

    def of(self, spec: ScenarioSpec) -> int:
        """Return how often the run was to execute a scenario."""
        return self._most[_key(spec)]


def _key(spec: ScenarioSpec) -> tuple[str, int, str]:
    return spec.variant, spec.variation, "" if spec.execution is None else spec.execution.iri


def project_of(uri: str) -> str:
    """Return the root folder of a document's project; empty if the document is not a file."""
    path = uri_to_path(uri)
    return "" if path is None else str(project_root(path))


def judgement(clause: ClauseSpec, message: ClauseJudged, digests: Digests, shared_fault: str = "") -> Judgement:
    """Return a verdict on a clause.

    ``shared_fault`` is the error in users' code that leaves all clauses of the run unknown, if there is one.
    """
    outcome = Outcome(message.verdict)
    undefined = outcome is Outcome.UNKNOWN and message.cause == Cause.NO_STEP
    return Judgement(
        clause_title(clause),
        "undefined" if undefined else str(outcome),
        margin(message.robustness, message.unit),
        _BADNESS[outcome] + (message.robustness or 0.0),
        verdict_words(message, clause),
        digests.clauses.get(clause.iri, ""),
        message.line,
        operand=message.operand,
        fault=message.fault or (shared_fault if outcome is Outcome.UNKNOWN else ""),
        failure=failure_words(message, clause),
    )


def with_cause(found: Judgement, because: Consequence | None, spec: ScenarioSpec) -> Judgement:
    """Return a verdict with its cause, if the cause is another clause of the scenario."""
    if because is None:
        return found
    return replace(found, because=spec.clauses[because.position].iri, because_words=because.words)


def refused_judgement(clause: ClauseSpec, reason: str, digests: Digests) -> Judgement:
    """Return the verdict *unknown* on an edited clause that cannot be judged on a stored trace."""
    return judgement(clause, never_judged(0, clause.line, reason, Cause.CHANGED), digests)
