"""Follow the unsaved texts of files that models use: Python code, steps, and descriptions of robots (MJCF, URDF).

If a client supports dynamic registration, the server registers for exactly those files that a model of the workspace
names, so that the client sends no other file of the user. Any client may open such a file at the server.
"""

from __future__ import annotations

import asyncio
import re
from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from robbdd_tools.base.files import path_to_uri, uri_to_path
from robbdd_tools.base.source_texts import use_unsaved
from robbdd_tools.features.outside_files import NAMING, outside_uris
from robbdd_tools.lsp.analysis_thread import Urgency
from robbdd_tools.names.index import language_of

if TYPE_CHECKING:
    from pathlib import Path

    from robbdd_tools.lsp.server import RobbddServer
    from robbdd_tools.names.project import Snapshot

SUFFIXES = (".py", ".xml", ".mjcf", ".urdf", ".srdf", ".xacro")
"""Endings of files that models may use."""
_METHODS = (types.TEXT_DOCUMENT_DID_OPEN, types.TEXT_DOCUMENT_DID_CHANGE, types.TEXT_DOCUMENT_DID_CLOSE)
_GLOB = re.compile(r"[\[\]{}*?]")


def is_source(uri: str) -> bool:
    """Return whether a document's ending is that of a file that models may use."""
    return PurePosixPath(uri).suffix.lower() in SUFFIXES


class SourceDocuments:
    """The unsaved texts of files that models use, and the models that name these files."""

    def __init__(self, server: RobbddServer) -> None:
        self._server = server
        self._texts: dict[str, str] = {}
        self._named: dict[str, frozenset[str]] = {}
        """The files that each model names."""
        self._registered: frozenset[str] = frozenset()
        self._registering = asyncio.Lock()

    def texts(self) -> dict[Path, str]:
        """Return the unsaved texts by their paths."""
        return {path: text for uri, text in self._texts.items() if (path := uri_to_path(uri)) is not None}

    async def edited(self, uri: str, text: str) -> None:
        """Use the text of an open document instead of the file on disk."""
        self._texts[_usual(uri)] = text
        await self._use(uri)

    async def closed(self, uri: str) -> None:
        """Use the file on disk again."""
        self._texts.pop(_usual(uri), None)
        await self._use(uri)

    async def _use(self, uri: str) -> None:
        texts = self.texts()
        await self._server.analyse(lambda _: use_unsaved(texts))
        await self.changed([uri])

    async def changed(self, uris: Iterable[str]) -> None:
        """Check the models that name one of these files again."""
        changed = set(map(_usual, uris))
        models = [model for model, named in self._named.items() if not named.isdisjoint(changed)]
        if models:
            self._server.survey.schedule(changed)
            # Steps also judge the clauses of imported templates.
            concerned = await self._server.analyse(lambda snapshot: _with_imports(snapshot, models))
            for model in filter(self._server.is_open, concerned):
                await self._server.publish(model)
            if self._server.pulls:
                await self._server.show_diagnostics(concerned)
            # Since then, a file may include other files, or may have been created.
            await self._follow(models)
            self._server.spawn(self._subscribe())

    def follow_soon(self, model: str) -> None:
        """Schedule the search for the files that an edited model names. It runs when the server is idle."""
        if language_of(model) in NAMING and not (language_of(model) == "bdd" and model in self._named):
            self._server.spawn(self._follow([model]))

    async def _follow(self, models: Iterable[str]) -> None:

        def find(snapshot: Snapshot) -> dict[str, frozenset[str]]:
            return {model: outside_uris(snapshot, model) for model in models}

        self.learn(await self._server.analyse(find, Urgency.LATER))

    def learn(self, named: Mapping[str, frozenset[str]]) -> None:
        """Record the files that models name, and subscribe to their texts."""
        if any(self._named.get(model, frozenset()) != files for model, files in named.items()):
            before = frozenset(uri for files in self._named.values() for uri in files)
            self._named |= named
            self._server.spawn(self._subscribe())
            # Texts that were edited before it was known that a model names them.
            late = [uri for files in named.values() for uri in files - before if uri in self._texts]
            if late:
                self._server.spawn(self.changed(late))

    async def _subscribe(self) -> None:
        """Subscribe to the texts of exactly those named files that exist."""
        document = self._server.client_capabilities.text_document
        able = document.synchronization if document is not None else None
        if able is None or not able.dynamic_registration:
            return
        async with self._registering:
            wanted = frozenset(uri for named in self._named.values() for uri in named if _exists(uri))
            gone, fresh = self._registered - wanted, wanted - self._registered
            self._registered = wanted
            # A client may refuse; then the files on disk count.
            with suppress(JsonRpcException):
                if fresh:
                    begun = [_registration(method, uri) for uri in sorted(fresh) for method in _METHODS]
                    await self._server.client_register_capability_async(types.RegistrationParams(begun))
                if gone:
                    ended = [
                        types.Unregistration(_id(method, uri), method) for uri in sorted(gone) for method in _METHODS
                    ]
                    await self._server.client_unregister_capability_async(types.UnregistrationParams(ended))


def _with_imports(snapshot: Snapshot, models: Iterable[str]) -> list[str]:
    """Return some files and the files that they import."""
    return list(dict.fromkeys(other for model in models for other in snapshot.reachability.walk(model)))


def _registration(method: str, uri: str) -> types.Registration:
    path = uri_to_path(uri)
    assert path is not None
    # Characters with a meaning in patterns stand for themselves in brackets.
    pattern = _GLOB.sub(lambda found: f"[{found[0]}]", path.as_posix())
    selector = [types.TextDocumentFilterPattern(scheme="file", pattern=pattern)]
    if method == types.TEXT_DOCUMENT_DID_CHANGE:
        options = types.TextDocumentChangeRegistrationOptions(
            sync_kind=types.TextDocumentSyncKind.Incremental, document_selector=selector
        )
    else:
        options = types.TextDocumentRegistrationOptions(document_selector=selector)
    return types.Registration(id=_id(method, uri), method=method, register_options=options)


def _id(method: str, uri: str) -> str:
    return f"robbdd:{method}:{uri}"


def _exists(uri: str) -> bool:
    path = uri_to_path(uri)
    return path is not None and path.is_file()


def _usual(uri: str) -> str:
    """Return our spelling of a URI; clients escape other characters."""
    path = uri_to_path(uri)
    return uri if path is None else path_to_uri(path)
