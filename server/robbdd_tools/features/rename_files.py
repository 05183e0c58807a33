"""Files that are about to be moved: what their imports, and the imports of them, must say then."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit
from robbdd_tools.features.unimported import import_path

if TYPE_CHECKING:
    from robbdd_tools.names.index import FileIndex


def import_edits(indices: Iterable[FileIndex], moves: Mapping[str, str]) -> list[Edit]:
    """Return the edits of the imports of some files that make them hold after moves.

    ``moves`` map the URIs of files or folders to their new ones; edits are for the texts at their old places.
    """
    edits = [edit for index in indices for edit in _of_file(index, moves)]
    return sorted(edits, key=lambda edit: (edit.uri, edit.span))


def _of_file(index: FileIndex, moves: Mapping[str, str]) -> Iterator[Edit]:
    own = index.document.uri
    here = moved(own, moves)
    for link in index.imports:
        there = moved(link.uri, moves)
        # A file of a package (`name:path`) is found wherever its importer lies.
        if (here, there) == (own, link.uri) or ":" in link.text:
            continue
        path = import_path(here, there)
        if path is not None and path != link.text:
            yield Edit(own, link.span, path)


def moved(uri: str, moves: Mapping[str, str]) -> str:
    """Return where a file will be."""
    for old, new in moves.items():
        if uri == old:
            return new
        if uri.startswith(f"{old.rstrip('/')}/"):
            return new.rstrip("/") + uri[len(old.rstrip("/")) :]
    return uri
