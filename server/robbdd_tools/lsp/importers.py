"""Load importing files from disk into the project, because a search for uses needs all of them, open or not."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable
from functools import partial
from time import monotonic
from typing import TYPE_CHECKING, TypeVar

from robbdd_tools.base.checkpoint import checkpoint
from robbdd_tools.base.files import uri_to_path
from robbdd_tools.features.goto_definition import symbol_at
from robbdd_tools.features.import_graph import ImportGraph
from robbdd_tools.features.unimported import Elsewhere
from robbdd_tools.features.workspace_files import model_files, model_files_near
from robbdd_tools.lsp.analysis_thread import Urgency
from robbdd_tools.lsp.convert import document_of

if TYPE_CHECKING:
    from lsprotocol import types

    from robbdd_tools.lsp.server import RobbddServer
    from robbdd_tools.names.project import Snapshot

Result = TypeVar("Result")
LASTING = 2.0
"""Seconds until the disk is read again, for clients that do not report changes."""
PATIENCE = 0.25
"""Seconds to wait for optional information."""


class Importers:
    """The import graph of the files on disk, as of the last time they were read."""

    def __init__(self, server: RobbddServer) -> None:
        self._server = server
        self._known: dict[str, tuple[float, ImportGraph]] = {}
        self._looking: asyncio.Task[None] | None = None
        self.elsewhere = Elsewhere()
        """The names declared in files of the workspace, whether loaded or not."""

    async def graph(self, uri: str | None = None) -> ImportGraph:
        """Return the imports of the workspace's files.

        For a file outside the workspace, use the files in its folder and below.
        """
        is_inside = uri is None or bool(self._server.folders(uri))
        near = "" if is_inside or uri is None else uri
        at, known = self._known.get(near, (-LASTING, ImportGraph({})))
        if monotonic() - at > LASTING:
            roots = list(self._server.workspace.folders)
            files = partial(model_files_near, near) if near else partial(model_files, roots)
            known = await asyncio.to_thread(lambda: ImportGraph.of(files()))
            self._known[near] = monotonic(), known
        return known

    async def load(self, uris: Iterable[str]) -> None:
        """Load all files that import the given ones, and publish diagnostics that change because of new ones.

        Requests have priority.
        """
        found: set[str] = set()
        for uri in uris:
            if uri_to_path(uri) is not None:
                found |= (await self.graph(uri)).importers(uri)
        project = self._server.project

        def read(_: Snapshot) -> bool:
            fresh = [uri for uri in sorted(found) if not project.has(uri)]
            for uri in fresh:
                checkpoint()
                project.load(uri)
            # Searches for uses read all of them; analyse them before anybody waits.
            loaded = project.snapshot()
            for uri in fresh:
                checkpoint()
                loaded.file(uri)
            return bool(fresh)

        if found and await self._server.analyse(read, Urgency.LATER):
            # Here, not in the search after an edit: a request may have loaded the file first.
            self._server.spawn(self._publish())

    async def _publish(self) -> None:
        for uri in self._server.opened():
            await self._server.publish(uri)

    async def analyse(self, uri: str, position: types.Position, work: Callable[[Snapshot], Result]) -> Result:
        """Load all files that may use the name at a position, then execute ``work``."""
        await self._load_users(uri, position)
        return await self._server.analyse(work)

    async def are_there(self, uri: str, position: types.Position) -> bool:
        """Load the files that may use the name at a position, but wait at most ``PATIENCE`` seconds.

        Returns whether all are loaded. If not, loading continues in the background.
        """
        finished, _ = await asyncio.wait([self._server.spawn(self._load_users(uri, position))], timeout=PATIENCE)
        return bool(finished)

    async def _load_users(self, uri: str, position: types.Position) -> None:
        convert = self._server.convert

        def declaring(snapshot: Snapshot) -> str:
            found = symbol_at(snapshot, uri, convert.offset(document_of(snapshot, uri), position))
            return uri if found is None else found[1].uri

        await self.load([await self._server.analyse(declaring)])

    async def look_around(self) -> None:
        """Load the files on disk that import open files."""
        await self._read_names_after(self._begin())

    def queue_search(self) -> None:
        """Start ``look_around`` in the background. Requests have priority."""
        self._server.spawn(self._read_names_after(self._begin()))

    async def looked_around(self) -> None:
        """Wait for a ``look_around`` that is in progress, because a rename must know all uses of a name."""
        if self._looking is not None:
            await asyncio.wait([self._looking])

    def _begin(self) -> asyncio.Task[None]:
        self._known.clear()
        self._looking = asyncio.get_running_loop().create_task(self.load(list(self._server.opened())))
        return self._looking

    async def _read_names_after(self, loaded: asyncio.Task[None]) -> None:
        await loaded
        files = await asyncio.to_thread(model_files, list(self._server.workspace.folders))
        await self._server.analyse(lambda _: self.elsewhere.update(files), Urgency.IDLE)
