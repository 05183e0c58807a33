"""Select the results that concern a file: the results of its own project, and of projects that import the file.

Copies of a project, such as two checkouts in one window, declare the same IRIs. A run of one copy is no evidence for
the other one.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, TypeVar

from robbdd_tools.features.run_verdicts import NOTHING, Findings, RejudgedClause

if TYPE_CHECKING:
    from robbdd_tools.features.run_verdicts import Judged, JudgedScenario, RejudgedExecution, RejudgedExecutions
    from robbdd_tools.names.project import Snapshot

Entry = TypeVar("Entry")


class ProjectFindings:
    """The results of each project at one moment."""

    def __init__(self, scenarios: Iterable[JudgedScenario] = (), rejudged: RejudgedExecutions | None = None) -> None:
        by_project: dict[str, list[JudgedScenario]] = {}
        for scenario in scenarios:
            by_project.setdefault(scenario.project, []).append(scenario)
        self._findings = {name: findings_of(own, rejudged or {}) for name, own in by_project.items()}
        self._models = {name: {one.model for one in own} for name, own in by_project.items()}

    def of_file(self, snapshot: Snapshot, uri: str, project: str) -> Findings:
        """Return the results that concern a file of a project."""
        shown = [
            found
            for name, found in self._findings.items()
            if name == project or any(uri in snapshot.reachability.walk(model) for model in self._models[name])
        ]
        return _united(shown) if shown else NOTHING


def findings_of(scenarios: Iterable[JudgedScenario], rejudged: RejudgedExecutions = MappingProxyType({})) -> Findings:
    """Return the results of some scenarios, including the verdicts of stored traces on edited clauses."""
    clauses: dict[str, list[Judged]] = {}
    variants: dict[str, list[JudgedScenario]] = {}
    edited: dict[str, list[RejudgedClause]] = {}
    for scenario in scenarios:
        for iri, judged in _rejudged_clauses(scenario, rejudged.get(scenario.model, {})):
            edited.setdefault(iri, []).append(judged)
        variants.setdefault(scenario.variant, []).append(scenario)
        for iri, judgement in scenario.clauses.items():
            clauses.setdefault(iri, []).append((scenario, judgement))
    return Findings(
        {iri: tuple(judged) for iri, judged in clauses.items()},
        {iri: tuple(scenarios) for iri, scenarios in variants.items()},
        {iri: tuple(judged) for iri, judged in edited.items()},
    )


def _rejudged_clauses(
    scenario: JudgedScenario, rejudged: Mapping[tuple[int, int], RejudgedExecution]
) -> Iterator[tuple[str, RejudgedClause]]:
    found = rejudged.get((scenario.run, scenario.index))
    if found is None:
        return
    if found.reason:
        for iri, before in scenario.clauses.items():
            yield iri, RejudgedClause(scenario, None, before, found.reason)
    for iri, judgement in found.clauses.items():
        yield iri, RejudgedClause(scenario, judgement, scenario.clauses.get(iri))


def _united(every: Sequence[Findings]) -> Findings:
    if len(every) == 1:
        return every[0]
    return Findings(
        _joined([one.clauses for one in every]),
        _joined([one.variants for one in every]),
        _joined([one.rejudged for one in every]),
    )


def _joined(every: Sequence[Mapping[str, tuple[Entry, ...]]]) -> dict[str, tuple[Entry, ...]]:
    found: dict[str, tuple[Entry, ...]] = {}
    for one in every:
        for iri, entries in one.items():
            found[iri] = found.get(iri, ()) + entries
    return found
