"""What each word of a text is, in the language's own concepts: what editors colour by meaning.

Words are told by tokens of the text, names by the trees and by what they lead to. So broken text keeps the colours
of all that is still understood.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.names.index import language_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.chunk import grammar_text
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration, Reference

COMMENT, STRING, NUMBER, KEYWORD = "comment", "string", "number", "keyword"
KEPT_DECLARATIONS = 2000
NAME = "name"
"""A name that is used; only what it leads to tells its concept, so that no token carries this one."""
PREDICATE, ACTION, TIME, ARGUMENT, CODE = "predicate", "action", "time constraint", "argument", "python"
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
    """A piece of one line (absolute span): ``concept`` is a constant of this module or the kind of a symbol."""

    span: Span
    concept: str
    is_declaration: bool = False


def semantic_tokens(snapshot: Snapshot, uri: str, within: Span | None = None) -> list[Token]:
    """Return the tokens of a file, or of the declarations that touch a part of it, in order and apart."""
    analysis = snapshot.file(uri)
    if analysis is None:
        return []
    text = analysis.document.text
    found: list[Token] = []
    end = 0
    for placed in analysis.declarations:
        found += _lead(text, end, placed.offset)
        end = placed.span.end
        if within is None or (placed.offset <= within.end and within.start <= end):
            found += _of_declaration(snapshot, analysis, placed)
    found += _lead(text, end, len(text))
    lined = [piece for token in found for piece in _lines(text, token)]
    if within is None:
        return lined
    return [token for token in lined if token.span.start < within.end and within.start < token.span.end]


def _of_declaration(snapshot: Snapshot, file: FileAnalysis, placed: PlacedDeclaration) -> Iterator[Token]:
    used = {reference.ref.span: reference for reference in placed.declaration.references}
    for token in _own(language_of(file.document.uri), placed.declaration):
        span = token.span.shifted(placed.offset)
        if token.concept != NAME:
            yield Token(span, token.concept, token.is_declaration)
            continue
        reference = used.get(token.span)
        if reference is None:
            yield from _unread(snapshot, file, span)
        else:
            yield from _reference(snapshot, file, placed, reference)


def _reference(
    snapshot: Snapshot, file: FileAnalysis, placed: PlacedDeclaration, reference: Reference
) -> Iterator[Token]:
    """Yield a token for each segment of a qualified name, as far as it leads somewhere."""
    ref = reference.ref
    target = placed.targets.get(ref)
    if target is None:
        return
    start = ref.span.start + placed.offset
    *outer, last = ref.path.split(".")
    home = snapshot.file(target.uri)
    prefix = target.symbol.path.split(".")[: -1 - len(outer)] if len(outer) < target.symbol.path.count(".") else []
    for number, segment in enumerate(outer):
        path = ".".join([*prefix, *outer[: number + 1]])
        owner = home.definitions.get(path) if home is not None else None
        kind = owner.kind if owner is not None else _kind(snapshot, file, ".".join(outer[: number + 1]))
        if kind is not None:
            yield Token(Span(start, start + len(segment)), kind)
        start += len(segment) + 1
    yield Token(Span(start, start + len(last)), target.kind)


def _unread(snapshot: Snapshot, file: FileAnalysis, span: Span) -> Iterator[Token]:
    """Yield the tokens of a name in angle brackets that the parser did not get to."""
    start = span.start
    path = file.document.text[span.start : span.end]
    segments = path.split(".")
    for number, segment in enumerate(segments):
        kind = _kind(snapshot, file, ".".join(segments[: number + 1]))
        if kind is not None and segment:
            yield Token(Span(start, start + len(segment)), kind)
        start += len(segment) + 1


def _kind(snapshot: Snapshot, file: FileAnalysis, path: str) -> str | None:
    return next((declared.symbol.kind for _, declared in snapshot.scope(file.document.uri).find(path)), None)


@lru_cache(maxsize=KEPT_DECLARATIONS)
def _own(language: str, declaration: Declaration) -> tuple[Token, ...]:
    """Return what a declaration tells by itself; spans count from its start."""
    concepts = dict(_concepts(declaration))
    used = {reference.ref.span for reference in declaration.references}
    keywords = _keywords(language)
    found: list[Token] = []
    end = 0
    for match in _WORDS.finditer(declaration.text):
        group = match.lastgroup or ""
        span = Span(match.start(group), match.end(group))
        if span.start < end:
            continue
        told = concepts.get(span.start)
        if group == "reference" or span in used:
            found.append(Token(span, NAME))
        elif told is not None:
            found.append(told)
        elif group != "word":
            found.append(Token(span, group))
        elif match[group] in keywords:
            found.append(Token(span, KEYWORD))
        else:
            continue
        end = found[-1].span.end
    return tuple(found)


def _concepts(declaration: Declaration) -> Iterator[tuple[int, Token]]:
    """Yield what the tree says of words, by where they start; what is told later wins."""
    nodes = list(walk(declaration.tree)) if declaration.tree is not None else []
    for node in nodes:
        match node:
            case tree.PhraseUse():
                concept = ACTION if node.word in load_catalog().behaviours else PREDICATE
                yield from _words_in(declaration.text, node, concept)
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


def _names(node: tree.Node) -> Iterator[tuple[tree.Name, str]]:
    """Yield the names in a node that neither declare nor refer to anything of the model."""
    match node:
        case tree.PhraseUse():
            yield from ((value, ARGUMENT) for _, value in node.arguments if isinstance(value, tree.Name))
        case tree.TextArgument():
            yield node.name, ARGUMENT
        case tree.PythonAttribute():
            yield node.module, CODE
            yield node.attribute, CODE
        case _:
            pass


def _words_in(text: str, node: tree.Node, concept: str) -> Iterator[tuple[int, Token]]:
    for match in _WORD.finditer(text, node.span.start, node.span.end):
        yield match.start(), Token(Span(match.start(), match.end()), concept)


@cache
def _keywords(language: str) -> frozenset[str]:
    return frozenset(re.findall(r"'([^\W\d][^']*)'", grammar_text(language)))


def _lead(text: str, start: int, end: int) -> Iterator[Token]:
    """Yield the comments between two declarations."""
    for match in re.finditer(r"//[^\n]*", text[start:end]):
        yield Token(Span(match.start() + start, match.end() + start), COMMENT)


def _lines(text: str, token: Token) -> Iterator[Token]:
    """Cut a token at the ends of its lines: few clients take one that spans several."""
    if "\n" not in text[token.span.start : token.span.end]:
        yield token
        return
    start = token.span.start
    for line in text[token.span.start : token.span.end].splitlines(keepends=True):
        length = len(line.rstrip("\r\n"))
        if length:
            yield Token(Span(start, start + length), token.concept, token.is_declaration)
        start += len(line)
