"""Edit imports when files are renamed: imports in the moved files, and imports of the moved files."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from robbdd_tools.base.diagnostic import Edit
from robbdd_tools.base.document import Document
from robbdd_tools.base.files import read_text, uri_to_path
from robbdd_tools.base.spellings import Spellings
from robbdd_tools.features.import_graph import imports_on_disk
from robbdd_tools.names.imports import import_path
from robbdd_tools.names.index import FileIndex, ImportPath, imports_of


@dataclass(frozen=True, slots=True)
class ImportLines:
    """A text and its imports."""

    document: Document
    imports: tuple[ImportPath, ...]


def affected_files(files: Iterable[str], moves: Mapping[str, str]) -> Iterator[ImportLines]:
    """Yield the model files on disk that move, and those that directly import a file that moves."""
    spellings = Spellings()
    for old in moves:
        spellings.of(old)
    for uri in files:
        imported = [spellings.of(one) for one in imports_on_disk(uri)]
        path = uri_to_path(uri)
        if path is None or not imported or all(moved(one, moves) == one for one in (uri, *imported)):
            continue
        text = read_text(path)
        if isinstance(text, str):
            document = Document(uri, 0, text)
            links = imports_of(document)
            yield ImportLines(document, tuple(replace(link, uri=spellings.of(link.uri)) for link in links))


def import_edits(files: Iterable[FileIndex | ImportLines], moves: Mapping[str, str]) -> list[Edit]:
    """Return the edits that keep imports valid after files move.

    ``moves`` maps the URI of a file or folder to its new URI. The edits are for the files at their old URIs.
    """
    edits = [edit for file in files for edit in _of_file(file, moves)]
    return sorted(edits, key=lambda edit: (edit.uri, edit.span))


def _of_file(file: FileIndex | ImportLines, moves: Mapping[str, str]) -> Iterator[Edit]:
    own = file.document.uri
    here = moved(own, moves)
    for link in file.imports:
        there = moved(link.uri, moves)
        # Imports of package files (`name:path`) do not depend on the importer's place.
        if (here, there) == (own, link.uri) or ":" in link.text:
            continue
        path = import_path(here, there)
        if path is not None and path != link.text:
            yield Edit(own, link.span, path)


def moved(uri: str, moves: Mapping[str, str]) -> str:
    """Return the URI of a file after the moves."""
    for old, new in moves.items():
        if uri == old:
            return new
        if uri.startswith(f"{old.rstrip('/')}/"):
            return new.rstrip("/") + uri[len(old.rstrip("/")) :]
    return uri
