"""Watch stores of runs outside of the workspace folders, for example if only a subfolder of a project is open."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from robbdd_tools.base.files import path_to_uri
from robbdd_tools.run.store import RESULTS, RunStore

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer


class StoreWatching:
    """Subscribes to the results of stores outside of the workspace folders, if the client supports it."""

    def __init__(self, server: RobbddServer) -> None:
        self._server = server
        self._watched: set[Path] = set()

    async def watch(self, stores: Iterable[RunStore]) -> None:
        """Watch stores. A store inside of a workspace folder is already watched with the folder."""
        folders = self._server.folders()
        found = {store.folder for store in stores}
        outside = {store for store in found if not any(store.is_relative_to(folder) for folder in folders)}
        new = outside - self._watched
        self._watched |= new
        if not new or not self._supported():
            return
        entries = [
            types.Registration(
                id=f"robbdd-store:{folder}",
                method=types.WORKSPACE_DID_CHANGE_WATCHED_FILES,
                register_options=types.DidChangeWatchedFilesRegistrationOptions(
                    watchers=[
                        types.FileSystemWatcher(types.RelativePattern(path_to_uri(folder), f"*/{RESULTS}")),
                        # Clients report a deleted folder without the files in it.
                        types.FileSystemWatcher(
                            types.RelativePattern(path_to_uri(folder.parent.parent), folder.parent.name),
                            types.WatchKind.Delete,
                        ),
                    ]
                ),
            )
            for folder in sorted(new)
        ]
        # A client may refuse the subscription; then its runs are shown at the next start.
        with suppress(JsonRpcException):
            await self._server.client_register_capability_async(types.RegistrationParams(registrations=entries))

    def _supported(self) -> bool:
        workspace = self._server.client_capabilities.workspace
        watched = workspace.did_change_watched_files if workspace is not None else None
        return watched is not None and bool(watched.dynamic_registration and watched.relative_pattern_support)
