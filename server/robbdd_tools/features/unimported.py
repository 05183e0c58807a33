"""Model files that a file could import: loaded files, files in its folder, and other files of the workspace."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from robbdd_tools.base.checkpoint import checkpoint
from robbdd_tools.base.document import Document
from robbdd_tools.base.files import FileState, file_state, path_to_uri, read_text, uri_to_path
from robbdd_tools.names.imports import IMPORTABLE, import_path
from robbdd_tools.names.index import FileIndex, index_file, language_of

if TYPE_CHECKING:
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import SymbolKind

Kinds = Mapping[str, "tuple[SymbolKind, ...]"]
"""Qualified name → the kinds of its declarations."""
MAX_NEIGHBOURS = 200
"""Maximum number of model files in one folder that are searched for a name."""


@dataclass(frozen=True, slots=True)
class Importable:
    """A file that can be imported: the path to write in the import, and the kinds of the names that it declares."""

    path: str
    uri: str
    names: Kinds


class Elsewhere:
    """The names in workspace files that were not loaded at the last ``update``."""

    def __init__(self) -> None:
        self._known: dict[str, tuple[FileState, Kinds]] = {}

    def update(self, uris: Iterable[str]) -> None:
        """Set the files to search. Only files that have changed are read again."""
        found = dict.fromkeys(uris)
        for uri in found:
            checkpoint()
            state, known = file_state(uri), self._known.get(uri)
            if state is not None and (known is None or known[0] != state):
                index = file_on_disk(uri)
                if index is not None:
                    self._known[uri] = state, index.names.kinds
        for gone in self._known.keys() - found.keys():
            del self._known[gone]

    def importable(self, snapshot: Snapshot, uri: str) -> list[Importable]:
        """Return the files that a file may import, sorted by import path.

        Loaded files and files in the same folder are left out, because ``loaded`` and ``beside`` return them.
        """
        passed_over = {*snapshot.sources, *_beside(uri)}
        return _importable(uri, ((name, found) for name, (_, found) in self._known.items() if name not in passed_over))


def loaded(snapshot: Snapshot, uri: str) -> list[Importable]:
    """Return the loaded files that a file may import but does not import yet, sorted by import path."""
    reached = {file.document.uri for file in snapshot.scope(uri).files}
    indices = (source for source in snapshot.sources.values() if isinstance(source, FileIndex))
    return _importable(uri, ((i.document.uri, i.names.kinds) for i in indices if i.document.uri not in reached))


def beside(snapshot: Snapshot, uri: str) -> list[Importable]:
    """Return the unloaded files in the folder of a file that the file may import."""
    unread = (file_on_disk(name) for name in _beside(uri) if name not in snapshot.sources)
    return _importable(uri, ((index.document.uri, index.names.kinds) for index in unread if index is not None))


def _importable(uri: str, files: Iterable[tuple[str, Kinds]]) -> list[Importable]:
    languages = IMPORTABLE.get(language_of(uri), ())
    found = [
        Importable(path, other, names)
        for other, names in files
        if language_of(other) in languages and (path := import_path(uri, other)) is not None
    ]
    return sorted(found, key=lambda file: file.path)


def _beside(uri: str) -> list[str]:
    path = uri_to_path(uri)
    if path is None:
        return []
    try:
        entries = sorted(entry for entry in path.parent.iterdir() if language_of(entry.name))
    except OSError:
        return []
    return [path_to_uri(entry) for entry in entries[:MAX_NEIGHBOURS]]


def file_on_disk(uri: str) -> FileIndex | None:
    """Return the index of a file on disk, or ``None`` if it is unreadable. It is cached until the file changes."""
    state = file_state(uri)
    return None if state is None else _index_of(state)


@lru_cache(maxsize=MAX_NEIGHBOURS)
def _index_of(state: FileState) -> FileIndex | None:
    text = read_text(state.path)
    return index_file(Document(state.uri, 0, text)) if isinstance(text, str) else None
