"""Handle changes outside of open documents: changes of files on disk, and of the workspace folders."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from robbdd_tools.base.files import uri_to_path
from robbdd_tools.lsp.client_settings import read_settings
from robbdd_tools.lsp.refresh import LENSES
from robbdd_tools.lsp.source_documents import SUFFIXES, is_source
from robbdd_tools.run.database import NAME
from robbdd_tools.run.store import FOLDER, RESULTS, RunStore
from robbdd_tools.run.study_schema import NAME as STUDY
from robbdd_tools.syntax.parse import LANGUAGES

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer

WATCHED = (
    f"**/{{{','.join((*(f'*.{name}' for name in LANGUAGES), '*.ttl', '*.jsonld', 'robbdd.toml', 'pyproject.toml'))}}}"
)
"""Models, and files that may hold a project's own rules about them."""
SOURCES = f"**/*{{{','.join(SUFFIXES)}}}"
"""Files that models may name. The errors of code from a run are outdated when it changes."""
RUNS = f"**/{FOLDER.as_posix()}/*/{RESULTS}"
"""Results file of a stored run, including runs of the command line."""
DATABASE = f"**/{FOLDER.parent}/{NAME}"
"""Results of all runs of a store, which change at the end of every run. Clients may miss the files in folders that were
just made, such as those of the first run."""
STUDIES = f"**/{FOLDER.parent}/{{studies,studies/*,studies/**/{STUDY}}}"
"""Results of a study, because its lenses depend on them, and the folders that are made for the first result."""
STORES = f"**/{{{FOLDER.parent},{FOLDER.as_posix()}}}"
"""The folders of a store. Clients report a deleted folder without the files in it."""


def register_watching(server: RobbddServer) -> None:
    """Add the methods to a server."""

    @server.feature(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    async def files(ls: RobbddServer, params: types.DidChangeWatchedFilesParams) -> None:
        # No analysis depends on runs.
        every = [change.uri for change in params.changes]
        stores = {uri: store for uri in every if (store := _store_of(uri)) is not None}
        studies = [uri for uri in every if f"/{FOLDER.parent}/studies" in uri]
        changed = [uri for uri in every if uri not in stores and uri not in studies and not is_source(uri)]
        if stores or studies:
            ls.refreshes.want(LENSES)
        if stores:
            ls.spawn(ls.stored_verdicts.refresh(stores.values()))
        if any(uri.endswith(".py") for uri in every):
            await ls.user_errors.code_changed()
        await ls.sources.changed(filter(is_source, every))
        if changed:
            await ls.files_changed(changed)

    @server.feature(types.WORKSPACE_DID_CHANGE_WORKSPACE_FOLDERS)
    async def folders(ls: RobbddServer, _: types.DidChangeWorkspaceFoldersParams) -> None:
        await read_settings(ls)
        ls.survey.schedule()
        await ls.importers.look_around()
        await ls.stored_verdicts.load()


def _store_of(uri: str) -> RunStore | None:
    """Return the store to which a changed file or folder belongs; ``None`` for other files."""
    path = uri_to_path(uri)
    if path is None:
        return None
    if path.name == RESULTS:
        return RunStore(path.parent.parent)
    if path.name == NAME:
        return RunStore(path.parent / FOLDER.name)
    if path.parts[-len(FOLDER.parts) :] == FOLDER.parts:
        return RunStore(path)
    return RunStore(path / FOLDER.name) if path.name == FOLDER.parent.name else None


async def watch_files(ls: RobbddServer) -> None:
    """Subscribe to file changes if the client supports it."""
    workspace = ls.client_capabilities.workspace
    watched = workspace.did_change_watched_files if workspace is not None else None
    if watched is None or not watched.dynamic_registration:
        return
    options = types.DidChangeWatchedFilesRegistrationOptions(
        watchers=[
            *(types.FileSystemWatcher(glob_pattern=pattern) for pattern in (WATCHED, SOURCES, RUNS, DATABASE)),
            types.FileSystemWatcher(STORES, types.WatchKind.Delete),
            types.FileSystemWatcher(STUDIES, types.WatchKind.Create | types.WatchKind.Delete),
        ]
    )
    entry = types.Registration(
        id="robbdd-files", method=types.WORKSPACE_DID_CHANGE_WATCHED_FILES, register_options=options
    )
    # A client may refuse the subscription; then changes on disk go unnoticed.
    with suppress(JsonRpcException):
        await ls.client_register_capability_async(types.RegistrationParams(registrations=[entry]))
