"""The end of a run of the command line is noticed from the few changes that a client reports."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from lsprotocol import types

from lsp.recorded_projects import Window, project, record, until
from lsp_kit import plain
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.base.locks import acquire
from robbdd_tools.run.store import LOCK, RunStore, store_beside
from robbdd_tools.run.stored_results import RUNNING

pytestmark = pytest.mark.usefixtures("forks")


def report_database(opened: Window, store: RunStore) -> None:
    change = types.FileEvent(path_to_uri(store.database), types.FileChangeType.Changed)
    opened.client.workspace_did_change_watched_files(types.DidChangeWatchedFilesParams([change]))


def set_state(store: RunStore, state: str) -> str:
    """Change the state of the only run; return the former one."""
    with closing(sqlite3.connect(store.database)) as connection, connection:
        (before,) = connection.execute("SELECT state FROM run").fetchone()
        connection.execute("UPDATE run SET state = ?", (state,))
    return before


async def are_shown(opened: Window, verdicts: set[str]) -> None:
    async def so() -> bool:
        return await opened.verdicts() == {"cell": verdicts}

    await until(so)


async def test_a_change_of_the_database_shows_a_run_whose_own_files_are_not_watched(
    window: Any, tmp_path: Path
) -> None:
    model = project(tmp_path / "cell")
    opened = await window(model.parent)
    assert await opened.verdicts() == {}
    record(model, 0.1)
    report_database(opened, store_beside(model))
    await are_shown(opened, {"holds"})


async def test_a_run_that_ends_after_the_last_report_is_shown(window: Any, tmp_path: Path) -> None:
    model = project(tmp_path / "cell")
    opened = await window(model.parent)
    assert await opened.verdicts() == {}  # the stores of the folder have been read
    record(model, -0.1)
    store = store_beside(model)
    lock = acquire(store.folder / "1" / LOCK)
    assert lock is not None
    ended = set_state(store, RUNNING)
    report_database(opened, store)
    assert await opened.verdicts() == {}
    set_state(store, ended)
    lock.release()
    await are_shown(opened, {"violated"})


async def test_clients_are_asked_for_changes_of_databases(window: Any, tmp_path: Path) -> None:
    opened = await window(project(tmp_path / "cell").parent)

    async def are_asked() -> bool:
        return bool(opened.registered)

    await until(are_asked)
    options = [plain(entry.register_options) for entry in opened.registered]
    kinds = {
        one["globPattern"]: one.get("kind") for each in options for one in each.get("watchers", ())
        if isinstance(one["globPattern"], str)
    }  # fmt: skip
    # Without a kind, all changes are reported.
    assert kinds["**/.robbdd/results.sqlite"] is None
