"""Search the names declared in all model files of the workspace, open or not."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from robbdd_tools.base.checkpoint import checkpoint
from robbdd_tools.base.files import FileState, file_state
from robbdd_tools.features.unimported import file_on_disk
from robbdd_tools.features.workspace_files import MAX_FILES, model_files
from robbdd_tools.names.index import FileIndex

if TYPE_CHECKING:
    from robbdd_tools.base.document import Document, Span
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import SymbolKind


@dataclass(frozen=True, slots=True)
class Named:
    """A declared name: its qualified name, and the absolute span of the name in its document."""

    document: Document
    path: str
    kind: SymbolKind
    span: Span


def workspace_symbols(snapshot: Snapshot, folders: Iterable[str], query: str, most: int = 200) -> list[Named]:
    """Return the names that contain the letters of the query in their order.

    The project's loaded files and the files on disk below ``folders`` are searched.
    """
    found: list[Named] = []
    for uri in sorted({*model_files(folders), *snapshot.sources}):
        checkpoint()
        for named in _fitting(snapshot, uri, query.lower()):
            found.append(named)
            if len(found) == most:
                return found
    return found


def _fitting(snapshot: Snapshot, uri: str, letters: str) -> Iterator[Named]:
    source = snapshot.sources.get(uri)
    paths = source.names.entries if isinstance(source, FileIndex) else () if source is not None else _paths(uri)
    fitting = [path for path in paths if _has_letters(path.lower(), letters)]
    index = source if isinstance(source, FileIndex) else file_on_disk(uri) if fitting else None
    if index is None:
        return
    for path in fitting:
        for declared in index.declared(path):
            symbol = declared.symbol
            yield Named(index.document, path, symbol.kind, symbol.span.shifted(declared.offset))


def _paths(uri: str) -> tuple[str, ...]:
    """Return the names that a file on disk declares. Many more files are cached than by ``file_on_disk``."""
    state = file_state(uri)
    return () if state is None else _paths_of(state)


@lru_cache(maxsize=MAX_FILES)
def _paths_of(state: FileState) -> tuple[str, ...]:
    index = file_on_disk(state.uri)
    return () if index is None else tuple(index.names.entries)


def _has_letters(text: str, letters: str) -> bool:
    position = 0
    for letter in letters:
        position = text.find(letter, position) + 1
        if position == 0:
            return False
    return True
