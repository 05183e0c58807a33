"""Show the verdicts of stored runs.

These include runs of the command line and of servers that ended during a run.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import uri_to_path
from robbdd_tools.features.run_verdicts import JudgedScenario, Results
from robbdd_tools.lsp.judged_scenarios import judged_scenario, judgement, project_of, with_cause
from robbdd_tools.lsp.saved_results import load_results, save_results
from robbdd_tools.run.consequences import Causes
from robbdd_tools.run.readable import clause_title, readable
from robbdd_tools.run.store import RunStore, store_beside
from robbdd_tools.run.stored_results import RUNNING
from robbdd_tools.workbench.judged_text import read_texts

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer
    from robbdd_tools.run.readable import clause_title, readable
from robbdd_tools.run.store import StoredRun

_LOG = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class FoundRun:
    """The finished scenarios of a stored run.

    ``some_repetitions`` is true if the run executed only some repetitions of its scenarios.
    """

    scenarios: tuple[JudgedScenario, ...]
    some_repetitions: bool


class StoredVerdicts:
    """Updates the results of the server from the stores of its projects."""

    def __init__(self, server: RobbddServer) -> None:
        self._server = server
        self._seen: dict[str, int] = {}
        self._known: set[Path] = set()
        self._reading = asyncio.Lock()
        self._loaded = asyncio.Event()

    async def load(self) -> None:
        """Load and show the results of earlier runs in the workspace."""
        try:
            await self._load()
        finally:
            self._loaded.set()

    async def _load(self) -> None:
        ls = self._server
        kept = await asyncio.to_thread(load_results, ls.folders())
        self._seen = dict(kept.seen)
        results = Results(kept.scenarios)
        # A run in progress is newer than the kept results.
        in_progress = list(ls.run.judged.values()) if ls.run is not None else []
        for scenario in in_progress:
            results.drop(scenario.scenario_key, scenario.execution)
        results.add(in_progress)
        ls.results = results
        ls.show_results(ls.opened())
        ls.rejudging.results_changed()
        models = dict.fromkeys(scenario.model for scenario in kept.scenarios)
        paths = [*ls.folders(), *filter(None, map(uri_to_path, models))]
        stores = [*map(store_beside, paths), *(RunStore(Path(store)) for store in kept.seen)]
        await self.refresh(stores)
        await ls.store_watching.watch(stores)

    async def loaded(self) -> None:
        """Wait until the results of earlier runs are loaded."""
        await self._loaded.wait()

    async def look_beside(self, *uris: str) -> None:
        """Read the stores of the projects that contain some documents, unless they have already been read."""
        await self.loaded()
        paths = filter(None, map(uri_to_path, uris))
        stores = {store.folder: store for store in map(store_beside, paths)}
        await self._server.store_watching.watch(stores.values())
        await self.refresh([store for folder, store in stores.items() if folder not in self._known])

    async def refresh(self, stores: Iterable[RunStore]) -> None:
        """Show the verdicts of runs that have ended since the stores were last read."""
        ls = self._server
        async with self._reading:
            changed = False
            for store in {store.folder: store for store in stores}.values():
                self._known.add(store.folder)
                key = str(store.folder)
                found, seen, newest = await asyncio.to_thread(_read, store, self._seen.get(key, 0))
                changed = changed or self._seen.get(key, 0) != seen
                self._seen[key] = seen
                for run in found:
                    ls.results.merge(run.scenarios, newest, some_repetitions=run.some_repetitions)
            if changed:
                ls.show_results(ls.opened())
                ls.rejudging.results_changed()
                await self.save()

    async def save(self) -> None:
        """Save the shown results for the next session. In an untrusted workspace, nothing is written."""
        ls = self._server
        if ls.trusted:
            seen = {store: number for store, number in self._seen.items() if number}
            await asyncio.to_thread(save_results, ls.folders(), list(ls.results), seen)


def _read(store: RunStore, seen: int) -> tuple[list[FoundRun], int, int]:
    """Return the results of runs that have not been read yet, the number of the last run read, and the newest run.

    ``seen`` is the number of the last run that was read before. A run that is in progress, and all later runs, are read
    only after that run has ended.
    """
    runs = store.runs()
    newest = runs[-1].number if runs else 0
    # Numbers restart in a store that was deleted.
    seen = seen if seen <= newest else 0
    found: list[FoundRun] = []
    for run in runs:
        if run.number > seen:
            try:
                if run.status().state == RUNNING:
                    break
                found.append(_found(run))
            except (RobbddError, OSError, ValueError, KeyError, TypeError, AttributeError) as error:
                _LOG.info("verdicts of %s are not shown: %s", run.folder, error)
            seen = run.number
    return found, seen, newest


def _found(run: StoredRun) -> FoundRun:
    texts = read_texts(run.folder)
    named, seed, results = texts.named(), run.record().user_seed, run.read_results()
    scenarios: list[JudgedScenario] = []
    if results is None:
        return FoundRun((), texts.some_repetitions)
    vacuous = results.vacuous()
    projects = {text.uri: project_of(text.uri) for text in named.values()}
    for index, result in enumerate(results.scenarios):
        if result.finished is not None:
            text = named[result.spec.model]
            scenario = judged_scenario(
                result.spec, text.uri, text.digests, projects[text.uri], run=run.number, index=index, seed=seed
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
