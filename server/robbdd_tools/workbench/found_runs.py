"""Read the results of stored runs that have not been read before, and notice a store that was deleted."""

from __future__ import annotations

import logging
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.features.run_verdicts import JudgedScenario
from robbdd_tools.run.consequences import Causes
from robbdd_tools.run.database import DatabaseProblem
from robbdd_tools.run.readable import clause_title, readable
from robbdd_tools.run.stored_results import RUNNING, starts
from robbdd_tools.workbench.judged_scenarios import (
    Repetitions,
    judged_scenario,
    judgement,
    project_of,
    with_cause,
)
from robbdd_tools.workbench.judged_text import read_texts

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robbdd_tools.run.store import RunStore, StoredRun

_LOG = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class Seen:
    """The last run of a store that was read: its number (0 for none), and the time at which it began (ISO 8601).

    If a store is deleted, its numbers restart. The time then shows that the runs are different ones.
    """

    number: int = 0
    began: str = ""


NOTHING_SEEN = Seen()


@dataclass(frozen=True, slots=True)
class FoundRun:
    """The finished scenarios of a stored run.

    ``some_repetitions`` is true if the run executed only some repetitions of its scenarios.
    """

    scenarios: tuple[JudgedScenario, ...]
    some_repetitions: bool


@dataclass(frozen=True, slots=True)
class ReadStore:
    """Results of the runs that have not been read before.

    - ``newest``: the number of the newest run in the store, including one in progress; 0 if there is no run.
    - ``is_replaced``: whether the runs that were read before no longer exist, because the store was deleted.
    """

    found: tuple[FoundRun, ...]
    seen: Seen
    newest: int
    is_replaced: bool


def read_store(store: RunStore, seen: Seen) -> ReadStore:
    """Read the runs after the run ``seen``.

    If a run is in progress, that run and all later ones are not read before it has ended.
    """
    try:
        began = starts(store.database)
    except DatabaseProblem:
        began = None
    runs = store.runs()
    newest = runs[-1].number if runs else 0
    replaced = began is not None and _is_replaced(seen, runs, began)
    if replaced:
        seen = NOTHING_SEEN
    found: list[FoundRun] = []
    for run in runs:
        if run.number > seen.number:
            try:
                if run.status().state == RUNNING:
                    break
                found.append(_found(run))
            except (RobbddError, OSError, ValueError, KeyError, TypeError, AttributeError) as error:
                _LOG.info("verdicts of %s are not shown: %s", run.folder, error)
            seen = Seen(run.number, (began or {}).get(run.number, ""))
    return ReadStore(tuple(found), seen, newest, replaced)


def _is_replaced(seen: Seen, runs: Sequence[StoredRun], began: Mapping[int, str]) -> bool:
    """Return whether a store no longer has the run that was read last. A store itself removes only old runs."""
    return not runs or seen.number > runs[-1].number or began.get(seen.number, seen.began) != seen.began


def _found(run: StoredRun) -> FoundRun:
    texts = read_texts(run.folder)
    named, seed, results = texts.named(), run.record().user_seed, run.read_results()
    scenarios: list[JudgedScenario] = []
    if results is None:
        return FoundRun((), texts.some_repetitions)
    vacuous = results.vacuous()
    projects = {text.uri: project_of(text.uri) for text in named.values()}
    repetitions = Repetitions(result.spec for result in results.scenarios)
    for index, result in enumerate(results.scenarios):
        if result.finished is not None:
            text = named[result.spec.model]
            scenario = judged_scenario(
                result.spec,
                text.uri,
                text.digests,
                projects[text.uri],
                run=run.number,
                index=index,
                seed=seed,
                repetitions=repetitions.of(result.spec),
            )
            causes = Causes()
            for position, clause in enumerate(result.spec.clauses):
                judged = result.judged.get(clause.line)
                if judged is not None:
                    shown = readable(judged, result.spec, results.faults)
                    found = judgement(clause, shown, text.digests)
                    because = causes.add(position, clause_title(clause), judged)
                    scenario.judge(clause.iri, with_cause(found, because, result.spec))
            scenario.mark_vacuous(vacuous)
            scenario.finished = True
            scenarios.append(scenario)
    return FoundRun(tuple(scenarios), texts.some_repetitions)
