"""The source of a report: the results of a stored run or of a study, with their environment."""

from __future__ import annotations

import json
import os
import shlex
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.campaign.study_executions import study_executions
from robbdd_tools.protocol.run_folder import curves_file
from robbdd_tools.run.json_documents import NoTrace, stored_curves
from robbdd_tools.workbench.recorded_requirements import read_requirements, requirements_from

if TYPE_CHECKING:
    from robbdd_tools.campaign.coverage import KindCoverage
    from robbdd_tools.campaign.report_moments import Moment, Moments
    from robbdd_tools.campaign.study_again import Again
    from robbdd_tools.graph.verified_requirements import LinkedRequirement
    from robbdd_tools.run.study_reader import StudyReader
    from robbdd_tools.workbench.execution_rows import ClauseResult, ExecutionResult
    from robbdd_tools.workbench.stored import PastRun


@dataclass(frozen=True)
class ReportSource:
    """The contents of a report.

    - ``state``: the reason why the results are incomplete; empty if they are complete.
    - ``environment``: names and values, in words.
    - ``command``: returns the command that executes a result again; empty if there is none.
    - ``coverage``: what a study has exercised of what it could; empty for a run.
    - ``requirements``: the requirements of the models, as recorded when the run or study began.
    - ``curves``: returns the stored margins of a result over time, by feature line, and the feature lines of its
      clauses; both are empty if nothing is stored.
    """

    title: str
    results: tuple[ExecutionResult, ...]
    state: str
    environment: tuple[tuple[str, str], ...]
    command: Callable[[ExecutionResult], str]
    curves: Callable[[ExecutionResult], tuple[Mapping[str, object], tuple[int, ...]]]
    moments: Mapping[int, Moment] = field(default_factory=dict[int, "Moment"])
    requirements: tuple[LinkedRequirement, ...] = ()
    coverage: tuple[KindCoverage, ...] = ()


def run_report(run: PastRun) -> ReportSource:
    """Return the source of the report of a stored run. Raises ``NoSuchRun``."""
    record = run.record
    rows = [("model", record.path), ("digest of its graph", record.digest), ("seed", str(record.seed))]
    rows += [("RobBDD", record.version), ("simulator", record.simulator), ("log", record.log)]
    rows += [(f"file {path}", digest) for path, digest in sorted(record.files.items())]

    def command(result: ExecutionResult) -> str:
        return shlex.join(["robbdd", "replay", str(run.number or run.folder), "--scenario", result.name])

    def curves(result: ExecutionResult) -> tuple[Mapping[str, object], tuple[int, ...]]:
        if not curves_file(run.folder, result.index).is_file():
            return {}, ()
        try:
            kept = stored_curves(run.place, result.index)
        except NoTrace:
            return {}, ()
        return kept, tuple(clause.line for clause in run.place.manifest().scenarios[result.index].clauses)

    # The root of a project is called as its folder.
    name = Path(os.path.normpath(run.folder / record.origin)).name if record.path == "." else record.path
    title = f"{name}: run {run.number}" if run.number else name
    environment = tuple((name, value) for name, value in rows if value)
    required = read_requirements(run.folder)
    state = run.status.words()
    return ReportSource(title, run.results, state, environment, command, curves, requirements=required)


def study_report(name: str, store: StudyReader) -> ReportSource:
    """Return the source of the report of a study; ``name`` is the name of its file. Raises ``DatabaseProblem``."""
    facts = store.facts()
    results = study_executions(store.rows())
    total = int(facts.get("total", len(results)))
    state = "" if len(results) >= total else f"{len(results)} of {total} executions are stored"
    shown = {"name": "study", "digest": "digest of the study", "version": "RobBDD", "simulator": "simulator"}
    environment = [(words, facts[fact]) for fact, words in shown.items() if facts.get(fact)]
    environment += used_file_rows(facts)

    def command(result: ExecutionResult) -> str:
        return shlex.join(["robbdd", "study", "replay", name, str(result.index + 1)])

    required = requirements_from(facts.get("requirements", "[]"))
    shown_facts = tuple(environment)
    return ReportSource(name, results, state, shown_facts, command, lambda _: ({}, ()), requirements=required)


def used_file_rows(facts: Mapping[str, str]) -> list[tuple[str, str]]:
    """Return the names and digests of the other files of a study, each file of all cells once."""
    every = (json.loads(content) for fact, content in facts.items() if fact.startswith("files "))
    found = {(name.rpartition("/")[2], str(digest)): None for files in every for name, digest in files.items()}
    return [(f"file {name}", digest) for name, digest in sorted(found)]


def with_traces(source: ReportSource, again: Again, moments: Moments | None) -> ReportSource:
    """Add the recordings of executions of a study that were executed again.

    These executions get curves, moments, and clauses with sentences. The run's folder may be removed afterwards. Raises
    ``NoSuchRun``.
    """
    recorded = run_report(again.run)
    chosen = [recorded.results[index] for index in again.indices.values()]
    found: Mapping[int, Moment] = {} if moments is None else moments.add(again.run.place, chosen)
    kept = {study: recorded.curves(recorded.results[index]) for study, index in again.indices.items()}
    former = source.curves

    def curves(result: ExecutionResult) -> tuple[Mapping[str, object], tuple[int, ...]]:
        return kept.get(result.index) or former(result)

    results = [
        replace(one, clauses=_with_sentences(one, recorded.results[again.indices[one.index]]))
        if one.index in again.indices
        else one
        for one in source.results
    ]
    shown = {study: found[index] for study, index in again.indices.items() if index in found}
    return replace(source, results=tuple(results), curves=curves, moments={**source.moments, **shown})


def _with_sentences(stored: ExecutionResult, again: ExecutionResult) -> tuple[ClauseResult, ...]:
    """Return the run's clauses with the names that they have in the study's store, which identify them in a report."""
    pairs = zip(stored.clauses, again.clauses, strict=True)
    return tuple(replace(new, iri=old.iri, name=old.name) for old, new in pairs)
