"""A client learns which words of other packages are left out."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import pytest
from lsprotocol import types

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.lsp import reported_words
from robbdd_tools.lsp.server import RobbddServer


async def test_each_left_out_word_is_a_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[tuple[str, types.MessageType]] = []
    server = RobbddServer()

    def warn(message: str, kind: types.MessageType) -> None:
        shown.append((message, kind))

    monkeypatch.setattr(server, "warn", warn)
    whole = load_catalog()
    for problems in ((), ("'a' is left out", "'b' is left out")):
        shown.clear()
        catalog = replace(whole, problems=problems)
        monkeypatch.setattr(reported_words, "load_catalog", partial(replace, catalog))
        await reported_words.report_words(server)
        assert shown == [(problem, types.MessageType.Warning) for problem in problems]
