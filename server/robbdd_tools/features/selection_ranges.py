"""Selection ranges: the word, the enclosing syntax node, and so on up to the whole text."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.names.project import Snapshot

_PIECE = re.compile(r"[\w\-]+")
_BRACKETS = re.compile(r"//[^\n]*|\"(?:\\.|[^\"\\\n])*\"?|'(?:\\.|[^'\\\n])*'?|(?P<open>[{(<])|(?P<close>[})>])")


def selections(snapshot: Snapshot, uri: str, offset: int) -> list[Span]:
    """Return growing spans around an offset, smallest first. In broken text, the spans follow the brackets."""
    file = snapshot.file(uri)
    if file is None:
        return []
    text = file.document.text
    found = {Span(0, len(text))}
    placed = next((entry for entry in reversed(file.declarations) if entry.offset <= offset), None)
    if placed is not None:
        found.add(Span(placed.offset, placed.offset + len(placed.declaration.text.rstrip())))
        found.update(span.shifted(placed.offset) for span in _brackets(placed.declaration.text))
        if placed.declaration.tree is not None:
            found.update(node.span.shifted(placed.offset) for node in walk(placed.declaration.tree))
    line = file.document.line_starts[file.document.position(offset).line]
    found.update(Span(match.start(), match.end()) for match in _PIECE.finditer(text, line) if match.start() <= offset)
    return _nested(span for span in found if span.contains(offset) and span.start < span.end)


def _brackets(text: str) -> list[Span]:
    """Return two spans for each pair of brackets in a text: with the brackets and without them."""
    opened: list[int] = []
    found: list[Span] = []
    for match in _BRACKETS.finditer(text):
        if match["open"]:
            opened.append(match.start())
        elif match["close"] and opened:
            start = opened.pop()
            found += (Span(start, match.end()), Span(start + 1, match.start()))
    return found


def _nested(spans: Iterable[Span]) -> list[Span]:
    chain: list[Span] = []
    for span in sorted(spans, key=lambda span: (span.end - span.start, span.start)):
        if not chain or (span.start <= chain[-1].start and chain[-1].end <= span.end):
            chain.append(span)
    return chain
