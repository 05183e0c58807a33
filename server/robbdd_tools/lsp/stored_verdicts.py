"""Show the verdicts of stored runs.

These include runs of the command line and of servers that ended during a run.
"""

from __future__ import annotations

import asyncio
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import uri_to_path
from robbdd_tools.features.run_verdicts import JudgedScenario, Results
from robbdd_tools.lsp.saved_results import load_results, save_results
from robbdd_tools.run.store import FOLDER, RunStore, store_beside
from robbdd_tools.workbench.found_runs import NOTHING_SEEN, Seen, read_store

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer

PAUSE = 2.0
"""While a run is in progress, its store is read again after this many seconds."""


class StoredVerdicts:
    """Updates the results of the server from the stores of its projects."""

    def __init__(self, server: RobbddServer) -> None:
        self._server = server
        self._seen: dict[str, Seen] = {}
        self._known: set[Path] = set()
        self._in_use: set[Path] = set()
        """Stores that are read again, because a run in them was in progress."""
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
        in_progress = self._in_progress()
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
        """Show the verdicts of runs that have ended since the stores were last read.

        The verdicts of a store that was deleted are removed.
        """
        ls = self._server
        async with self._reading:
            changed = False
            for store in {store.folder: store for store in stores}.values():
                self._known.add(store.folder)
                key = str(store.folder)
                before = self._seen.get(key, NOTHING_SEEN)
                read = await asyncio.to_thread(read_store, store, before)
                dropped = read.is_replaced and self._drop(store)
                changed = changed or dropped or before != read.seen
                if read.seen.number < read.newest:
                    self._read_again(store)
                self._seen[key] = read.seen
                for run in read.found:
                    ls.results.merge(run.scenarios, read.newest, some_repetitions=run.some_repetitions)
            if changed:
                ls.show_results(ls.opened())
                ls.rejudging.results_changed()
                await self.save()

    def _read_again(self, store: RunStore) -> None:
        """Read a store again after a pause, because the last report about a run may arrive before the run has ended."""
        if store.folder not in self._in_use:
            self._in_use.add(store.folder)
            self._server.spawn(self._refresh_later(store))

    async def _refresh_later(self, store: RunStore) -> None:
        await asyncio.sleep(PAUSE)
        self._in_use.discard(store.folder)
        await self.refresh([store])

    async def save(self) -> None:
        """Save the shown results for the next session. In an untrusted workspace, nothing is written."""
        ls = self._server
        if ls.trusted:
            seen = {store: seen for store, seen in self._seen.items() if seen.number}
            await asyncio.to_thread(save_results, ls.folders(), list(ls.results), seen)

    def _drop(self, store: RunStore) -> bool:
        """Remove the results of a store whose runs no longer exist, and return whether there were any."""
        ls, kept = self._server, {id(scenario) for scenario in self._in_progress()}
        projects = {
            project for one in ls.results if (project := one.project) and Path(project) / FOLDER == store.folder
        }
        projects = {project for project in projects if not ls.stores.keeps_elsewhere(Path(project))}
        gone = [one for one in ls.results if one.project in projects and id(one) not in kept]
        for scenario in gone:
            ls.results.discard(scenario)
        return bool(gone)

    def _in_progress(self) -> list[JudgedScenario]:
        run = self._server.run
        return [] if run is None else list(run.judged.values())
