"""A window of an editor with some folders open, and projects with recorded runs."""

from __future__ import annotations

import asyncio
import shutil
from collections.abc import Awaitable, Callable, Iterable
from pathlib import Path
from typing import Any

from lsprotocol import types
from pytest_lsp import client_capabilities, make_test_lsp_client

from fork_kit import ROBBDD_LSP
from kit import EXAMPLES
from lsp_kit import PATIENCE, plain
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.names.clause_places import clauses_in
from robbdd_tools.names.project import Project
from robbdd_tools.protocol.specs import ClauseSpec
from robbdd_tools.run.store import store_beside
from robbdd_tools.workbench.judged_text import judged_texts, write_texts
from run.recorded import record_run

MODEL = "pickplace.bdd"


class Window:
    """A client with some folders open. ``registered`` are the subscriptions of its server."""

    def __init__(self) -> None:
        self.client = make_test_lsp_client()
        self.registered: list[types.Registration] = []

    async def start(self, folders: Iterable[Path]) -> Window:
        client: Any = self.client
        await client.start_io(*ROBBDD_LSP, "--stdio")

        def register(params: types.RegistrationParams) -> None:
            self.registered += params.registrations

        # In place of what pytest-lsp may do by itself; pygls leaves the type of its table open.
        client.protocol.fm.features[types.CLIENT_REGISTER_CAPABILITY] = register
        open_folders = [types.WorkspaceFolder(uri=path_to_uri(folder), name=folder.name) for folder in folders]
        capabilities = client_capabilities("visual-studio-code")
        assert capabilities.workspace is not None
        capabilities.workspace.did_change_watched_files = types.DidChangeWatchedFilesClientCapabilities(
            dynamic_registration=True, relative_pattern_support=True
        )
        await client.initialize_session(
            types.InitializeParams(capabilities=capabilities, workspace_folders=open_folders)
        )
        return self

    async def verdicts(self) -> dict[str, set[str]]:
        """Return the shown verdicts of each model, by the name of its folder."""
        answer = plain(await self.client.protocol.send_request_async("robbdd/testResults", {}))
        found: dict[str, set[str]] = {}
        for scenario in answer["scenarios"]:
            folder = scenario["uri"].rsplit("/", 2)[-2]
            found.setdefault(folder, set()).update(clause["verdict"] for clause in scenario["clauses"])
        return found

    def watched_stores(self) -> list[str]:
        """Return the folders that the server watches in addition to the open ones."""
        watchers = [
            watcher for entry in self.registered for watcher in plain(entry.register_options).get("watchers", ())
        ]
        return [pattern["baseUri"] for one in watchers if isinstance(pattern := one["globPattern"], dict)]


def project(folder: Path, *, marked: bool = True) -> Path:
    """Create a folder with the example; return its model."""
    shutil.copytree(EXAMPLES / "pickplace", folder)
    if marked:
        (folder / "robbdd.toml").touch()
    return folder / MODEL


def record(model: Path, margin: float) -> None:
    """Record a run in which the goal clause has a margin (m)."""
    texts = Project()
    uri = path_to_uri(model)
    texts.load(uri)
    snapshot = texts.snapshot()
    iri = next(clause.iri for clause in clauses_in(snapshot, uri) if clause.name == "at-goal")
    place = record_run(store_beside(model), [margin], clauses=(ClauseSpec(5, iri, "at-goal", "then", "at goal"),))
    write_texts(judged_texts([("", snapshot, uri)]), place.folder)


async def until(so: Callable[[], Awaitable[bool]]) -> None:
    async with asyncio.timeout(PATIENCE):
        while not await so():
            await asyncio.sleep(0.02)
