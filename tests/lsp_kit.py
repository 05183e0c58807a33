"""A client of the language server for tests: documents that are open, edited and asked about."""

from __future__ import annotations

import asyncio
import shutil
from pathlib import Path
from typing import Any, cast

import pytest
from lsprotocol import types
from pytest_lsp import LanguageClient

from kit import EXAMPLES
from robbdd_tools.base.files import path_to_uri

PATIENCE = 300.0
"""Seconds that a test waits for an expected message, far more than a slow machine needs."""
CLIENTS = pytest.mark.parametrize("client", ["visual-studio-code", "neovim", "emacs"], indirect=True)
"""For tests whose answer depends on the client's capabilities."""
ASKED = (
    types.WORKSPACE_INLAY_HINT_REFRESH,
    types.WORKSPACE_CODE_LENS_REFRESH,
    types.WORKSPACE_SEMANTIC_TOKENS_REFRESH,
    types.WORKSPACE_DIAGNOSTIC_REFRESH,
    types.CLIENT_REGISTER_CAPABILITY,
)
"""Requests of the server whose answer is empty."""


async def begin_session(
    client: LanguageClient,
    folder: Path,
    capabilities: types.ClientCapabilities,
    asked: list[str],
    options: dict[str, bool] | None = None,
) -> types.InitializeResult:
    """Open a folder with a copy of the example; ``asked`` gets the methods that the server asks of the client."""

    def listen(method: str) -> None:
        def hear(*_: object) -> None:
            asked.append(method)

        # In place of what pytest-lsp may do by itself; pygls leaves the type of its table open.
        client.protocol.fm.features[method] = hear  # pyright: ignore[reportUnknownMemberType]

    for method in ASKED:
        listen(method)
    shutil.copytree(EXAMPLES / "pickplace", folder / "pickplace")
    folders = [types.WorkspaceFolder(uri=path_to_uri(folder), name="test")]
    return await client.initialize_session(
        types.InitializeParams(capabilities=capabilities, workspace_folders=folders, initialization_options=options)
    )


def plain(value: Any) -> Any:
    """An object of the client, as the JSON that it was."""
    if hasattr(value, "_asdict"):
        return {name: plain(entry) for name, entry in value._asdict().items()}
    return list(map(plain, cast(list[Any], value))) if isinstance(value, list) else value


class Editor:
    """A document open in a client."""

    def __init__(self, client: LanguageClient, folder: Path, model: str = "pickplace/pickplace.bdd") -> None:
        self.client = client
        self.path = folder / model
        self.uri = path_to_uri(self.path)
        self.text = self.path.read_text(encoding="utf-8")
        self.version = 0

    def open(self, text: str | None = None) -> None:
        self.text = self.text if text is None else text
        item = types.TextDocumentItem(uri=self.uri, language_id="bdd", version=self.version, text=self.text)
        self.client.text_document_did_open(types.DidOpenTextDocumentParams(text_document=item))

    def change(self, old: str, new: str) -> None:
        assert old in self.text
        start, end = self.position(old), self.position(old, after=True)
        self.text = self.text.replace(old, new, 1)
        self.version += 1
        edit = types.TextDocumentContentChangePartial(range=types.Range(start=start, end=end), text=new)
        document = types.VersionedTextDocumentIdentifier(uri=self.uri, version=self.version)
        self.client.text_document_did_change(
            types.DidChangeTextDocumentParams(text_document=document, content_changes=[edit])
        )

    def position(self, text: str, after: bool = False) -> types.Position:
        offset = self.text.index(text) + (len(text) if after else 0)
        line = self.text.count("\n", 0, offset)
        column = offset - (self.text.rfind("\n", 0, offset) + 1)
        return types.Position(line=line, character=column)

    def at(self, text: str, after: bool = False) -> dict[str, Any]:
        document = types.TextDocumentIdentifier(uri=self.uri)
        return {"text_document": document, "position": self.position(text, after)}

    def everything(self) -> types.Range:
        end = types.Position(line=self.text.count("\n") + 1, character=0)
        return types.Range(start=types.Position(line=0, character=0), end=end)

    async def diagnostics(self, *codes: str) -> list[types.Diagnostic]:
        """Wait until exactly these codes are published for the document."""
        async with asyncio.timeout(PATIENCE):
            while True:
                found = list(self.client.diagnostics.get(self.uri, []))
                if self.uri in self.client.diagnostics and sorted(str(entry.code) for entry in found) == sorted(codes):
                    return found
                await asyncio.sleep(0.02)
