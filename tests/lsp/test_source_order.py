"""A file may be edited before the server knows that a model names it."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any

import pytest

from robbdd_tools.lsp.source_documents import SourceDocuments

MODEL, CODE = "file:///cell/tidy.bddx", "file:///cell/carrying.py"


@pytest.mark.parametrize(("edited", "expected"), [(CODE, [{CODE}]), ("file:///cell/other.py", [])])
async def test_a_model_that_turns_out_to_name_an_edited_file_is_checked_again(
    edited: str, expected: list[set[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    async def analyse(_: object) -> None:
        pass

    checked: list[set[str]] = []

    async def changed(_: SourceDocuments, uris: list[str]) -> None:
        checked.append(set(uris))

    server: Any = SimpleNamespace(
        analyse=analyse, spawn=asyncio.create_task, client_capabilities=SimpleNamespace(text_document=None)
    )
    sources = SourceDocuments(server)
    await sources.edited(edited, "class Carrying: pass")
    monkeypatch.setattr(SourceDocuments, "changed", changed)
    named: Mapping[str, frozenset[str]] = {MODEL: frozenset({CODE})}
    sources.learn(named)
    sources.learn(named)
    await asyncio.sleep(0)
    assert checked == expected
