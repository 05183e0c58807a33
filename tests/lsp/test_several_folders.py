"""Runs are found wherever a project lies: several folders, nested projects, a subfolder of a project."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from lsprotocol import types

from lsp.recorded_projects import MODEL, project, record, until
from lsp_kit import Editor
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.run.store import store_beside

pytestmark = pytest.mark.usefixtures("forks")


async def test_each_of_several_folders_shows_its_own_runs(window: Any, tmp_path: Path) -> None:
    record(project(tmp_path / "left"), 0.1)
    record(project(tmp_path / "right"), -0.1)
    opened = await window(tmp_path / "left", tmp_path / "right")
    assert await opened.verdicts() == {"left": {"holds"}, "right": {"violated"}}
    assert opened.watched_stores() == []


async def test_a_project_inside_of_another_keeps_its_runs_to_itself(window: Any, tmp_path: Path) -> None:
    outer = project(tmp_path / "outer")
    inner = project(tmp_path / "outer" / "inner")
    record(outer, 0.1)
    record(inner, -0.1)
    assert store_beside(outer).folder != store_beside(inner).folder
    opened = await window(tmp_path / "outer")
    Editor(opened.client, inner.parent, MODEL).open()

    async def are_shown() -> bool:
        return await opened.verdicts() == {"outer": {"holds"}, "inner": {"violated"}}

    await until(are_shown)


async def test_a_subfolder_shows_the_runs_of_its_project_and_follows_them(window: Any, tmp_path: Path) -> None:
    (tmp_path / "robbdd.toml").touch()
    model = project(tmp_path / "cells" / "one", marked=False)
    record(model, 0.1)
    opened = await window(model.parent)
    assert await opened.verdicts() == {"one": {"holds"}}
    store = store_beside(model).folder
    assert store.parent.parent == tmp_path

    async def is_watched() -> bool:
        return opened.watched_stores() == [path_to_uri(store), path_to_uri(tmp_path)]

    await until(is_watched)
    record(model, -0.1)
    change = types.FileEvent(path_to_uri(store / "2" / "results.json"), types.FileChangeType.Created)
    opened.client.workspace_did_change_watched_files(types.DidChangeWatchedFilesParams([change]))

    async def is_violated() -> bool:
        return await opened.verdicts() == {"one": {"violated"}}

    await until(is_violated)
