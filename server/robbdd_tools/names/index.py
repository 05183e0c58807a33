"""The index of a single file: its declarations, the names that it declares, and the files that it imports."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Document, Span
from robbdd_tools.names.imports import BACKSLASH, import_uri
from robbdd_tools.names.name_table import Entry, NameTable, make_table, update_table
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import Placed
from robbdd_tools.syntax.parse import LANGUAGES, parse_declaration
from robbdd_tools.syntax.split import Chunk, resplit, split
from robbdd_tools.syntax.study_content import STUDY
from robbdd_tools.syntax.study_text import read_study

if TYPE_CHECKING:
    from robbdd_tools.syntax.declaration import Symbol


@dataclass(frozen=True, slots=True)
class ImportPath:
    """The path of an import as written. ``span`` is absolute and excludes the quotes.

    ``written`` is the URI of the path. ``uri`` is the URI that represents the imported file (see ``Spellings``).
    """

    span: Span
    text: str
    uri: str
    written: str


@dataclass(frozen=True, slots=True)
class Declared:
    """A symbol and the offset of its declaration."""

    symbol: Symbol
    offset: int


@dataclass(frozen=True, eq=False)
class FileIndex:
    """The contents of a file without its imports. They depend on the document of the file only."""

    document: Document
    chunks: tuple[Chunk, ...]
    declarations: tuple[Placed, ...]
    names: NameTable
    imports: tuple[ImportPath, ...]

    def declared(self, path: str) -> Iterator[Declared]:
        """Yield the declarations of a qualified name in text order."""
        for entry in self.names.entries.get(path, ()):
            yield self.at(entry)

    def at(self, entry: Entry) -> Declared:
        """Return the declaration to which an entry of the name table belongs."""
        placed = self.declarations[entry.declaration]
        return Declared(placed.declaration.symbols[entry.symbol], placed.offset)


@lru_cache(maxsize=20_000)
def language_of(uri: str) -> str:
    """Return the language of a file according to its extension; ``""`` for other files.

    ``study`` is the language of studies. They declare nothing, so their index contains only imports.
    """
    ending = PurePosixPath(uri).suffix.removeprefix(".").lower()
    return ending if ending in LANGUAGES or ending == STUDY else ""


def index_file(document: Document, previous: FileIndex | None = None) -> FileIndex:
    """Split and parse a document. Parts that have not changed since the ``previous`` revision are reused."""
    language = language_of(document.uri)
    if language == STUDY:
        return FileIndex(document, (), (), make_table([]), _study_imports(document))
    if not language:
        chunks: tuple[Chunk, ...] = ()
    elif previous is None:
        chunks = split(language, document.text)
    else:
        chunks = resplit(language, previous.document.text, previous.chunks, document.text)
    declarations = tuple(Placed(parse_declaration(language, chunk.text), chunk.offset) for chunk in chunks)
    parsed = [placed.declaration for placed in declarations]
    if previous is None:
        names = make_table(parsed)
    else:
        names = update_table(previous.names, [placed.declaration for placed in previous.declarations], parsed)
    return FileIndex(document, chunks, declarations, names, _imports(document, declarations))


def imports_of(document: Document) -> tuple[ImportPath, ...]:
    """Return the imports of a file. Nothing else in the file is parsed."""
    language = language_of(document.uri)
    if language == STUDY:
        return _study_imports(document)
    chunks = (
        chunk for chunk in (split(language, document.text) if language else ()) if chunk.text.startswith("import")
    )
    return _imports(document, (Placed(parse_declaration(language, chunk.text), chunk.offset) for chunk in chunks))


# All other escapes are of quotes and backslashes.
_WINDOWS_PATH = re.compile(r"\\[^\\\"']")


def _study_imports(document: Document) -> tuple[ImportPath, ...]:
    """Return the files that a study names: its models, and the scene instances that are levels of a factor."""
    content, found = read_study(document)[0], list[ImportPath]()
    for word in (*content.imports, *content.scenes):
        uri = import_uri(document.uri, word.text)
        found.append(ImportPath(word.span, word.text, uri, uri))
    return tuple(found)


def _imports(document: Document, declarations: Iterable[Placed]) -> tuple[ImportPath, ...]:
    found: list[ImportPath] = []
    for placed in declarations:
        if isinstance(placed.declaration.tree, tree.Import):
            path = placed.declaration.tree.path
            span = Span(path.span.start + 1, path.span.end - 1).shifted(placed.offset)
            # In a string, a backslash is an escape, so the value lacks the backslashes of a Windows path. Use the
            # written text.
            written = document.text[span.start : span.end]
            meant = written if _WINDOWS_PATH.search(written) and BACKSLASH not in path.value else path.value
            uri = import_uri(document.uri, meant)
            found.append(ImportPath(span, path.value, uri, uri))
    return tuple(found)
