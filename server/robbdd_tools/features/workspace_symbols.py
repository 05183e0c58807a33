"""Search the names that all model files of the workspace declare, whether or not they are open.

In an unopened file, only the words of names are read first (``syntax/sound_names``). A declaration is parsed if its
words fit the query, or if it may have a syntax error, because the parser may find more names when it repairs the error.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from robbdd_tools.base.checkpoint import checkpoint
from robbdd_tools.base.document import Document
from robbdd_tools.base.files import FileState, file_state, read_text
from robbdd_tools.features.workspace_files import MAX_FILES, model_files
from robbdd_tools.names.index import FileIndex, language_of
from robbdd_tools.syntax.parse import LANGUAGES, parse_declaration
from robbdd_tools.syntax.sound_names import sound_names
from robbdd_tools.syntax.split import split_once

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Symbol, SymbolKind


Words = tuple[int, tuple[str, ...]]
"""The maximum number of names in a qualified name of a declaration, and the names, the declaration's own name first.

If the number is 0, the names are already qualified.
"""
_DEPTHS = {"scene": 2, "bddx": 1, "scenex": 5, "ktree": 5}
"""Language → maximum number of names in a qualified name, such as scene instance, graph, body, frame and pose."""


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
    if isinstance(source, FileIndex):
        paths = [path for path in source.names.entries if _has_letters(path.lower(), letters)]
        for declared in (declared for path in paths for declared in source.declared(path)):
            yield _named(source.document, declared.symbol, declared.offset)
    elif source is None and language_of(uri) in LANGUAGES:
        yield from _on_disk(uri, letters)


def _on_disk(uri: str, letters: str) -> Iterator[Named]:
    """Yield the fitting names of an unopened file. Names with the same path are yielded together."""
    state = file_state(uri)
    words = () if state is None else _words_of(state)
    fitting = [number for number, own in enumerate(words) if _may_fit(own, letters)]
    text = read_text(state.path) if state is not None and fitting else ""
    if not isinstance(text, str) or not fitting:
        return
    document, language = Document(uri, 0, text), language_of(uri)
    chunks = split_once(language, text)
    found: dict[str, list[Named]] = {}
    # The file may have changed since its words were read.
    for chunk in (chunks[number] for number in fitting if number < len(chunks)):
        checkpoint()
        for symbol in parse_declaration(language, chunk.text).symbols:
            if _has_letters(symbol.path.lower(), letters):
                found.setdefault(symbol.path, []).append(_named(document, symbol, chunk.offset))
    for several in found.values():
        yield from several


def _named(document: Document, symbol: Symbol, offset: int) -> Named:
    return Named(document, symbol.path, symbol.kind, symbol.span.shifted(offset))


@lru_cache(maxsize=MAX_FILES)
def _words_of(state: FileState) -> tuple[Words, ...]:
    """Return the words of each declaration of a file."""
    text = read_text(state.path)
    if not isinstance(text, str):
        return ()
    language = language_of(state.uri)
    return tuple(_words_in(language, chunk.text) for chunk in split_once(language, text))


def _words_in(language: str, text: str) -> Words:
    words = sound_names(language, text)
    if words is None:
        return 0, tuple(dict.fromkeys(symbol.path.lower() for symbol in parse_declaration(language, text).symbols))
    # The qualified name of a clause in a story's scenario has three names. In other declarations, parts have two.
    depth = _DEPTHS.get(language) or (3 if text.startswith("User") else 2)
    return depth, tuple(map(_lower, words))


def _may_fit(words: Words, letters: str) -> bool:
    """Return whether a qualified name of a declaration may contain the letters in the given order."""
    depth, names = words
    if not depth:
        return any(_has_letters(path, letters) for path in names)
    wanted, place = _lower(letters), 0
    for level in range(depth):
        fitting = names[1:] if level else names[:1]
        place = max((_letters_in(f"{name}.", wanted, place) for name in fitting), default=place)
    return place == len(wanted)


def _lower(text: str) -> str:
    """Return a text in lower case that does not depend on the following text, unlike a sigma at the end of a word."""
    return text.lower().replace("ς", "σ")


def _letters_in(text: str, letters: str, place: int) -> int:
    """Return how many letters earlier texts and this one contain in order. Earlier texts contain ``place`` of them."""
    position = 0
    while place < len(letters) and (position := text.find(letters[place], position) + 1):
        place += 1
    return place


def _has_letters(text: str, letters: str) -> bool:
    return _letters_in(text, letters, 0) == len(letters)
