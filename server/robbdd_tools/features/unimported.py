"""Model files that a file could import and does not: those that are loaded, and those beside it on disk."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Document
from robbdd_tools.base.files import FileState, file_state, path_to_uri, read_text, uri_to_path
from robbdd_tools.names.imports import IMPORTABLE, import_path
from robbdd_tools.names.index import FileIndex, index_file, language_of

if TYPE_CHECKING:
    from robbdd_tools.names.project import Snapshot

MOST_NEIGHBOURS = 200
"""Model files beside one another that are searched for a name."""


Importable = tuple[str, FileIndex]
"""The path to write, and what it leads to."""


def loaded(snapshot: Snapshot, uri: str) -> list[Importable]:
    """Return the files of the project that a file may still import, in the order of the paths to write."""
    reached = {file.document.uri for file in snapshot.scope(uri).files}
    indices = (source for source in snapshot.sources.values() if isinstance(source, FileIndex))
    return _importable(uri, (index for index in indices if index.document.uri not in reached))


def beside(snapshot: Snapshot, uri: str) -> list[Importable]:
    """Return the files in the folder of a file that it may import and that nobody has loaded yet."""
    unread = (file_on_disk(name) for name in _beside(uri) if name not in snapshot.sources)
    return _importable(uri, (index for index in unread if index is not None))


def _importable(uri: str, indices: Iterable[FileIndex]) -> list[Importable]:
    kinds = IMPORTABLE.get(language_of(uri), ())
    fitting = (index for index in indices if language_of(index.document.uri) in kinds)
    named = ((import_path(uri, index.document.uri), index) for index in fitting)
    return sorted(((path, index) for path, index in named if path is not None), key=lambda entry: entry[0])


def _beside(uri: str) -> list[str]:
    path = uri_to_path(uri)
    if path is None:
        return []
    try:
        entries = sorted(entry for entry in path.parent.iterdir() if language_of(entry.name))
    except OSError:
        return []
    return [path_to_uri(entry) for entry in entries[:MOST_NEIGHBOURS]]


def file_on_disk(uri: str) -> FileIndex | None:
    """Return what a file on disk says, kept until it changes there; ``None`` when it cannot be read."""
    state = file_state(uri)
    return None if state is None else _index_of(state)


@lru_cache(maxsize=MOST_NEIGHBOURS)
def _index_of(state: FileState) -> FileIndex | None:
    text = read_text(state.path)
    return index_file(Document(state.uri, 0, text)) if isinstance(text, str) else None
