"""Semantic tokens: the concept of each word, for colouring by meaning.

Keywords are found by tokenising the text. Names are found in the syntax trees and by their definitions. So the readable
parts of broken text keep their colours.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache, lru_cache
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

from robbdd_tools.base.checkpoint import checkpoint
from robbdd_tools.base.document import Span
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.names.index import language_of
from robbdd_tools.names.name_table import changed_paths
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.grammar_files import grammar_text
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.name_table import NameTable
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.names.resolve import Resolution
    from robbdd_tools.syntax.declaration import Declaration, Reference

COMMENT, STRING, NUMBER, KEYWORD = "comment", "string", "number", "keyword"
CACHED_COMMENTS = 200
NAME = "name"
"""Temporary concept of a used name. The definition of the name determines the concept in the final token."""
PREDICATE, ACTION, TIME, ARGUMENT, CODE = "predicate", "action", "time constraint", "argument", "python"
PROPERTY = "property"
_WORDS = re.compile(
    r"(?P<comment>//[^\n]*)"
    r"|(?P<string>\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'|[\"'][^\n]*)"
    r"|<\s*(?P<reference>[^\W\d][\w\-.]*)"
    r"|(?P<word>[^\W\d](?:[\w\-^*]|/(?!/))*)"
    r"|(?P<number>[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?)",
    re.DOTALL,
)
_WORD = re.compile(r"[^\W\d][\w\-]*")


@dataclass(frozen=True, slots=True, order=True)
class Token:
    """A part of one line (absolute span).

    ``concept`` is a constant of this module or the kind of a symbol.
    """

    span: Span
    concept: str
    is_declaration: bool = False


@dataclass(frozen=True, eq=False, slots=True, weakref_slot=True)
class Coloured:
    """The tokens of a text, in order and without overlap. Their spans count from the start of the text."""

    tokens: tuple[Token, ...]


@dataclass(frozen=True, slots=True)
class _Known:
    """The cached colours of a declaration.

    The colours depend on the targets of references, and on the names ``paths``, which were looked up in ``tables``.
    """

    tables: tuple[NameTable, ...]
    paths: frozenset[str]
    coloured: Coloured


def semantic_tokens(snapshot: Snapshot, uri: str, within: Span | None = None) -> list[Token]:
    """Return the semantic tokens of a file, in order and without overlap.

    If ``within`` is given, only tokens that touch this span are returned.
    """
    return [
        Token(token.span.shifted(offset), token.concept, token.is_declaration)
        for offset, piece in coloured(snapshot, uri, within)
        for token in piece.tokens
        if within is None or (token.span.start + offset < within.end and within.start < token.span.end + offset)
    ]


def coloured(snapshot: Snapshot, uri: str, within: Span | None = None) -> list[tuple[int, Coloured]]:
    """Return the tokens of a file piece by piece, each as a pair of the piece's offset and its tokens.

    With ``within``, only pieces that touch this span are returned. The tokens of a piece that an edit did not change
    stay the same object.
    """
    analysis = snapshot.file(uri)
    if analysis is None:
        return []
    text, tables = analysis.document.text, snapshot.scope(uri).tables
    found: list[tuple[int, Coloured]] = []
    end = 0
    for placed in analysis.parts():
        checkpoint()
        if end < placed.offset:
            found.append((end, _between(text[end : placed.offset])))
        end = placed.offset + len(placed.declaration.text)
        if within is None or (placed.offset <= within.end and within.start <= end):
            found.append((placed.offset, _of_declaration(snapshot, analysis, placed, tables)))
    found.append((end, _between(text[end:])))
    return found


def _of_declaration(
    snapshot: Snapshot, file: FileAnalysis, placed: PlacedDeclaration, tables: tuple[NameTable, ...]
) -> Coloured:
    """Return the colours of a declaration. They are cached until one of its dependencies changes."""
    known = _known.get(placed.targets.resolution)
    if known is not None and known.tables == tables:
        return known.coloured
    if known is not None and known.paths.isdisjoint(_changed(known.tables, tables)):
        found, paths = known.coloured, known.paths
    else:
        reader = _Names(snapshot, file, placed)
        found = Coloured(tuple(piece for token in reader.tokens() for piece in _lines(placed.declaration.text, token)))
        paths = frozenset(reader.paths)
    _known[placed.targets.resolution] = _Known(tables, paths, found)
    return found


_known: WeakKeyDictionary[Resolution, _Known] = WeakKeyDictionary()


@lru_cache(maxsize=2)
def _changed(before: tuple[NameTable, ...], after: tuple[NameTable, ...]) -> frozenset[str]:
    pairs = zip(before, after, strict=True)
    return frozenset(path for old, new in pairs for path in changed_paths(old, new))


@dataclass(slots=True)
class _Names:
    """Determines the concepts of names in a declaration. ``paths`` are the names that it looked up."""

    snapshot: Snapshot
    file: FileAnalysis
    placed: PlacedDeclaration
    paths: set[str] = field(default_factory=set[str])

    def tokens(self) -> Iterator[Token]:
        """Yield the tokens of the declaration; spans count from its start."""
        declaration = self.placed.declaration
        used = {reference.ref.span: reference for reference in declaration.references}
        for token in _own(language_of(self.file.document.uri), declaration):
            checkpoint()
            if token.concept != NAME:
                yield token
                continue
            reference = used.get(token.span)
            if reference is None:
                yield from self._unread(token.span)
            else:
                yield from self._reference(reference)

    def _reference(self, reference: Reference) -> Iterator[Token]:
        """Yield a token for each resolved segment of a qualified name."""
        ref = reference.ref
        target = self.placed.targets.get(ref)
        if target is None:
            return
        start = ref.span.start
        *outer, last = ref.path.split(".")
        home = self.snapshot.file(target.uri)
        prefix = target.symbol.path.split(".")[: -1 - len(outer)] if len(outer) < target.symbol.path.count(".") else []
        for number, segment in enumerate(outer):
            path = ".".join([*prefix, *outer[: number + 1]])
            self.paths.add(path)
            owner = home.definitions.get(path) if home is not None else None
            kind = owner.kind if owner is not None else self._kind(".".join(outer[: number + 1]))
            if kind is not None:
                yield Token(Span(start, start + len(segment)), kind)
            start += len(segment) + 1
        yield Token(Span(start, start + len(last)), target.kind)

    def _unread(self, span: Span) -> Iterator[Token]:
        """Yield the tokens of a name in angle brackets that was not parsed."""
        start = span.start
        segments = self.placed.declaration.text[span.start : span.end].split(".")
        for number, segment in enumerate(segments):
            kind = self._kind(".".join(segments[: number + 1]))
            if kind is not None and segment:
                yield Token(Span(start, start + len(segment)), kind)
            start += len(segment) + 1

    def _kind(self, path: str) -> str | None:
        self.paths.add(path)
        found = self.snapshot.scope(self.file.document.uri).find(path)
        return next((declared.symbol.kind for _, declared in found), None)


_own_tokens: WeakKeyDictionary[Declaration, tuple[Token, ...]] = WeakKeyDictionary()


def _own(language: str, declaration: Declaration) -> tuple[Token, ...]:
    """Return the tokens that depend on the declaration alone. They are cached with the declaration.

    Spans count from the start of the declaration.
    """
    found = _own_tokens.get(declaration)
    if found is None:
        found = _own_tokens[declaration] = _read_tokens(language, declaration)
    return found


def _read_tokens(language: str, declaration: Declaration) -> tuple[Token, ...]:
    concepts = dict(_concepts(declaration))
    used = {reference.ref.span for reference in declaration.references}
    keywords = words_of_grammar(language)
    found: list[Token] = []
    end = 0
    for match in _WORDS.finditer(declaration.text):
        checkpoint()
        group = match.lastgroup or ""
        span = Span(match.start(group), match.end(group))
        if span.start < end:
            continue
        kind_of_word = concepts.get(span.start)
        if group == "reference" or span in used:
            found.append(Token(span, NAME))
        elif kind_of_word is not None:
            found.append(kind_of_word)
        elif group != "word":
            found.append(Token(span, group))
        elif match[group] in keywords:
            found.append(Token(span, KEYWORD))
        else:
            continue
        end = found[-1].span.end
    return tuple(found)


def _concepts(declaration: Declaration) -> Iterator[tuple[int, Token]]:
    """Map the start offset of each word to its concept, according to the syntax tree.

    A later entry replaces an earlier one.
    """
    nodes: list[tree.Node] = []
    for node in walk(declaration.tree) if declaration.tree is not None else ():
        checkpoint()
        nodes.append(node)
        match node:
            case tree.PhraseUse():
                concept = ACTION if node.word in load_catalog().behaviours else PREDICATE
                yield from _words_in(declaration.text, node, concept)
            case tree.NamedPredicate() | tree.NamedUse():
                for piece in node.pieces:
                    yield from ((word.span.start, Token(word.span, PREDICATE)) for word in piece.words)
            case tree.During() | tree.Before() | tree.After():
                yield from _words_in(declaration.text, node, TIME)
            case tree.TextPredicate():
                yield node.span.start, Token(Span(node.span.start, node.span.start + len("pred")), PREDICATE)
            case _:
                pass
    for node in nodes:
        for name, concept in _names(node):
            yield name.span.start, Token(name.span, concept)
    for symbol in reversed(declaration.symbols):
        if symbol.span.start < symbol.span.end:
            yield symbol.span.start, Token(symbol.span, symbol.kind, is_declaration=True)


def _names(node: tree.Node) -> Iterator[tuple[tree.Node, str]]:
    """Yield the words in a node that neither declare nor refer to anything in the model."""
    match node:
        case tree.PhraseUse():
            yield from ((value, ARGUMENT) for _, value in node.arguments if isinstance(value, tree.Name))
        case tree.TextArgument():
            yield node.name, ARGUMENT
        case tree.PropertyCondition():
            yield node.name, PROPERTY
            if isinstance(node.value, tree.Text | tree.Truth):
                yield node.value, STRING if isinstance(node.value, tree.Text) else KEYWORD
        case tree.Columns():
            yield from ((name, PROPERTY) for name in node.names)
        case tree.Property():
            yield node.name, PROPERTY
            yield from ((value, STRING) for value in node.values if isinstance(value, tree.Text))
            yield from ((value, KEYWORD) for value in node.values if isinstance(value, tree.Truth))
        case tree.PythonAttribute():
            yield node.module, CODE
            yield node.attribute, CODE
        case _:
            pass


def _words_in(text: str, node: tree.Node, concept: str) -> Iterator[tuple[int, Token]]:
    for match in _WORD.finditer(text, node.span.start, node.span.end):
        yield match.start(), Token(Span(match.start(), match.end()), concept)


@cache
def words_of_grammar(language: str) -> frozenset[str]:
    """Return the words of a language's grammar."""
    return frozenset(re.findall(r"'([^\W\d][^']*)'", grammar_text(language)))


@lru_cache(maxsize=CACHED_COMMENTS)
def _between(text: str) -> Coloured:
    """Return the tokens of the comments between two declarations."""
    found = re.finditer(r"//[^\n]*", text)
    return Coloured(tuple(Token(Span(match.start(), match.end()), COMMENT) for match in found))


def _lines(text: str, token: Token) -> Iterator[Token]:
    """Split a token at line breaks, because few clients accept tokens of several lines."""
    if "\n" not in text[token.span.start : token.span.end]:
        yield token
        return
    start = token.span.start
    for line in text[token.span.start : token.span.end].splitlines(keepends=True):
        length = len(line.rstrip("\r\n"))
        if length:
            yield Token(Span(start, start + length), token.concept, token.is_declaration)
        start += len(line)
