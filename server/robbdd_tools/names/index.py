"""One file by itself: its declarations, the names it declares and the files it imports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import TYPE_CHECKING
from urllib.parse import quote, urljoin

from robbdd_tools.base.document import Document, Span
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.parse import LANGUAGES, parse_declaration
from robbdd_tools.syntax.split import split

if TYPE_CHECKING:
    from robbdd_tools.syntax.declaration import Declaration, Symbol


@dataclass(frozen=True, slots=True)
class ImportPath:
    """The path of an import as it was written (absolute ``span`` without quotes) and the URI that it means."""

    span: Span
    text: str
    uri: str


@dataclass(frozen=True, slots=True)
class Placed:
    """A declaration and where it stands."""

    declaration: Declaration
    offset: int


@dataclass(frozen=True, slots=True)
class Declared:
    """A symbol and the offset of its declaration."""

    symbol: Symbol
    offset: int


@dataclass(frozen=True, eq=False)
class FileIndex:
    """What a file says without looking at any other; a function of its document only."""

    document: Document
    declarations: tuple[Placed, ...]
    declared: Mapping[str, Declared]
    repeated: tuple[Declared, ...]
    imports: tuple[ImportPath, ...]


def language_of(uri: str) -> str:
    """Return the language of a file by its ending; ``""`` for a kind that is not ours."""
    ending = PurePosixPath(uri).suffix.removeprefix(".").lower()
    return ending if ending in LANGUAGES else ""


def index_file(document: Document) -> FileIndex:
    """Split and parse a document; unchanged chunks come from the cache."""
    language = language_of(document.uri)
    chunks = split(language, document.text) if language else ()
    declarations = tuple(Placed(parse_declaration(language, chunk.text), chunk.offset) for chunk in chunks)
    declared: dict[str, Declared] = {}
    repeated: list[Declared] = []
    for placed in declarations:
        for symbol in placed.declaration.symbols:
            entry = Declared(symbol, placed.offset)
            first = declared.setdefault(symbol.path, entry)
            if first is not entry and not _same_variable(first, entry):
                repeated.append(entry)
    return FileIndex(document, declarations, declared, tuple(repeated), _imports(document, declarations))


def _same_variable(first: Declared, second: Declared) -> bool:
    """Tell whether two quantifiers of one declaration use one variable name, which is no clash."""
    variable = first.symbol.kind is second.symbol.kind is SymbolKind.VARIABLE
    return variable and first.offset == second.offset and second.symbol.span == second.symbol.extent


def _imports(document: Document, declarations: tuple[Placed, ...]) -> tuple[ImportPath, ...]:
    found: list[ImportPath] = []
    for placed in declarations:
        if isinstance(placed.declaration.tree, tree.Import):
            path = placed.declaration.tree.path
            span = Span(path.span.start + 1, path.span.end - 1).shifted(placed.offset)
            found.append(ImportPath(span, path.value, urljoin(document.uri, quote(path.value))))
    return tuple(found)
