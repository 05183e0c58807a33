"""The graph of a study: its models, the study itself and, if wanted, the results of its executions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import chain
from typing import TYPE_CHECKING, Any

from robbdd_tools.campaign.study_executions import study_executions
from robbdd_tools.run.prepare import DEFAULT_SEED

if TYPE_CHECKING:
    from robbdd_tools.campaign.study_file import Study
    from robbdd_tools.graph.write.built import BuiltGraph
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.run.study_reader import StudyReader
    from robbdd_tools.workbench.execution_rows import ExecutionResult


def study_graph(study: Study, store: StudyReader | None = None, traces: Mapping[int, str] | None = None) -> BuiltGraph:
    """Return the graph of a study without errors, with the results in ``store``.

    ``traces`` are the SHA-256 of kept traces, by the number of their execution in the study minus 1.
    Raises ``ModelErrors``, ``DatabaseProblem``, and ``BadResults`` if a result is about a scenario that the study no
    longer has.
    """
    from robbdd_tools.graph.write.planned_study import add_study, add_study_run, joined
    from robbdd_tools.graph.write.run_results import add_results, add_traces, run_iri

    assert study.model is not None
    built = joined([file.graph for file in study.model.runnable])
    graph = built.graph
    specs = _specs(study)
    add_study(graph, study.content, study.digest, dict.fromkeys(variant for variant, _ in specs))
    if store is not None:
        executions = study_executions(store.rows())
        total = int(store.fact("total") or 0)
        document = _document(study, executions, specs, complete=len(executions) == total)
        add_results(graph, document)
        add_study_run(graph, study.content, study.digest, run_iri(document), (one.values for one in executions))
        places = {one.index: place for place, one in enumerate(executions)}
        add_traces(
            graph, document, {places[index]: digest for index, digest in (traces or {}).items() if index in places}
        )
    return built


def _specs(study: Study) -> dict[tuple[str, str], ScenarioSpec]:
    """Return a specified execution of each variant, by the variant and its execution in a ``.bddx``."""
    specs = chain.from_iterable(cell.plan.specs(repeat=1) for cell in study.cells)
    found: dict[tuple[str, str], ScenarioSpec] = {}
    for spec in specs:
        found.setdefault((spec.variant, "" if spec.execution is None else spec.execution.name), spec)
    return found


def _document(
    study: Study,
    executions: tuple[ExecutionResult, ...],
    specs: Mapping[tuple[str, str], ScenarioSpec],
    *,
    complete: bool,
) -> dict[str, Any]:
    """Return the executions as the results of a run (``docs/schemas/run.schema.json``)."""
    seed = study.content.whole("seed")
    scenarios = list(_scenarios(study, executions, specs))
    return {"seed": DEFAULT_SEED if seed is None else seed, "complete": complete, "scenarios": scenarios}


def _scenarios(
    study: Study, executions: tuple[ExecutionResult, ...], specs: Mapping[tuple[str, str], ScenarioSpec]
) -> Iterator[dict[str, Any]]:
    from robbdd_tools.graph.write.planned_study import factor_names
    from robbdd_tools.graph.write.run_results import BadResults

    factors = frozenset(factor_names(study.content))
    for one in executions:
        spec = specs.get((one.variant, one.execution))
        if spec is None:
            raise BadResults(f"the study no longer executes the scenario {one.name}")
        iris = {clause.name: clause.iri for clause in spec.clauses}
        yield {
            "story": spec.story,
            "variant": one.variant,
            "variation": one.variation,
            "repetition": one.repetition,
            "name": one.name,
            "seed": one.seed,
            "verdict": one.verdict.value,
            "duration": one.duration,
            "values": {name: value for name, value in one.values.items() if name not in factors},
            "clauses": [
                {
                    "name": clause.name,
                    "iri": iris.get(clause.name, clause.name),
                    "verdict": clause.verdict.value,
                    "robustness": clause.margin,
                    "unit": clause.unit,
                    "at": clause.at,
                    "reason": clause.reason,
                }
                for clause in one.clauses
            ],
        }
