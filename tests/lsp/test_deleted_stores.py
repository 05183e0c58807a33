"""Verdicts of a store that was deleted disappear from every view, and runs with the same numbers replace them."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest
from lsprotocol import types

from lsp.recorded_projects import MODEL, Window, project, record, until
from lsp_kit import Editor, plain
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.run.store import store_beside

pytestmark = pytest.mark.usefixtures("forks")


def report(opened: Window, *paths: Path) -> None:
    """Send the notifications of a client that watches files: a deleted folder without the files in it."""
    changes = [
        types.FileEvent(path_to_uri(path), getattr(types.FileChangeType, "Changed" if path.exists() else "Deleted"))
        for path in paths
    ]
    opened.client.workspace_did_change_watched_files(types.DidChangeWatchedFilesParams(changes))


async def edited(opened: Window, model: Path) -> Editor:
    """Open a model with one violated clause, which is a problem of the model."""
    editor = Editor(opened.client, model.parent, MODEL)
    editor.open()
    (problem,) = await editor.diagnostics("clause-violated")
    assert "−100 mm" in problem.message
    return editor


@pytest.mark.parametrize("deleted", [".robbdd", ".robbdd/runs and database"])
async def test_the_problems_of_a_run_disappear_with_its_store(window: Any, tmp_path: Path, deleted: str) -> None:
    model = project(tmp_path / "cell")
    record(model, -0.1)
    opened = await window(model.parent)
    editor = await edited(opened, model)
    store = store_beside(model)
    kept = model.parent / ".robbdd" / "results.json"

    async def is_saved() -> bool:
        return kept.exists()

    await until(is_saved)
    if deleted == ".robbdd":
        shutil.rmtree(store.folder.parent)
        report(opened, store.folder.parent)
    else:
        shutil.rmtree(store.folder)
        store.database.unlink()
        report(opened, store.folder, store.database)
    await editor.diagnostics()
    assert await opened.verdicts() == {}
    document = types.TextDocumentIdentifier(uri=editor.uri)
    lenses = await editor.client.text_document_code_lens_async(types.CodeLensParams(text_document=document))
    assert not [lens for lens in lenses or () if lens.command is not None and "passed" in lens.command.title]
    hints = types.InlayHintParams(text_document=document, range=editor.everything())
    assert not [hint for hint in plain(await editor.client.text_document_inlay_hint_async(hints)) or () if hint.data]


async def test_results_that_were_saved_by_the_editor_do_not_outlive_the_store(window: Any, tmp_path: Path) -> None:
    model = project(tmp_path / "cell")
    record(model, -0.1)
    first = await window(model.parent)
    assert await first.verdicts() == {"cell": {"violated"}}
    kept = model.parent / ".robbdd" / "results.json"

    async def is_saved() -> bool:
        return kept.exists() and "violated" in kept.read_text(encoding="utf-8")

    await until(is_saved)
    store = store_beside(model)
    shutil.rmtree(store.folder)
    store.database.unlink()
    later = await window(model.parent)
    assert await later.verdicts() == {}


async def test_a_run_replaces_the_deleted_run_of_the_same_number(window: Any, tmp_path: Path) -> None:
    model = project(tmp_path / "cell")
    record(model, 0.1)
    opened = await window(model.parent)
    assert await opened.verdicts() == {"cell": {"holds"}}
    store = store_beside(model)
    shutil.rmtree(store.folder.parent)
    record(model, -0.1)
    assert [run.number for run in store.runs()] == [1]
    report(opened, store.folder / "1" / "results.json")

    async def is_violated() -> bool:
        return await opened.verdicts() == {"cell": {"violated"}}

    await until(is_violated)


async def test_a_database_that_cannot_be_read_takes_no_verdicts_along(window: Any, tmp_path: Path) -> None:
    model = project(tmp_path / "cell")
    record(model, -0.1)
    opened = await window(model.parent)
    editor = await edited(opened, model)
    store = store_beside(model)
    shutil.rmtree(store.folder)
    store.database.write_bytes(b"no database" * 1000)
    report(opened, store.folder)
    other = project(tmp_path / "other")
    record(other, -0.1)
    report(opened, store_beside(other).folder / "1" / "results.json")

    async def is_read() -> bool:
        return "other" in await opened.verdicts()

    await until(is_read)
    assert (await opened.verdicts())["cell"] == {"violated"}
    await editor.diagnostics("clause-violated")


async def test_the_store_of_one_project_leaves_the_verdicts_of_another(window: Any, tmp_path: Path) -> None:
    left, right = project(tmp_path / "left"), project(tmp_path / "right")
    for model in (left, right):
        record(model, -0.1)
    opened = await window(left.parent, right.parent)
    assert await opened.verdicts() == {"left": {"violated"}, "right": {"violated"}}
    gone = store_beside(left).folder.parent
    shutil.rmtree(gone)
    report(opened, gone)

    async def is_one() -> bool:
        return await opened.verdicts() == {"right": {"violated"}}

    await until(is_one)
