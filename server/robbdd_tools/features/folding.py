"""Folding: multi-line brackets, runs of comments and runs of imports."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from robbdd_tools.base.document import Document
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.features.studies import is_study

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration

_SIGNS = re.compile(r"//[^\n]*|\"(?:\\.|[^\"\\\n])*\"?|'(?:\\.|[^'\\\n])*'?|(?P<open>[{(])|(?P<close>[})])")

_BEGINNINGS = (("//", "comment"), ("import", "imports"))


class Fold(NamedTuple):
    """A range of lines (from 0) that can be folded into its first line.

    ``kind`` is ``region``, ``comment`` or ``imports``.
    """

    first: int
    last: int
    kind: str


def folds(snapshot: Snapshot, uri: str) -> list[Fold]:
    """Return the folds of a file, in text order."""
    analysis = snapshot.file(uri)
    if analysis is None:
        return []
    return sorted({*_brackets(analysis), *_runs(analysis.document)})


def _brackets(file: FileAnalysis) -> Iterator[Fold]:
    opened: list[int] = []
    if is_study(file.document.uri):
        yield from (Fold(first, last - 1, "region") for first, last in _pairs(file.document.text).pairs)
    for placed in file.parts():
        inside = _brackets_in(placed.declaration)
        if inside is _NONE:
            continue
        start = file.document.line_at(placed.offset)
        for first, last in inside.pairs:
            yield Fold(start + first, start + last - 1, "region")
        for last in inside.closed if opened else ():
            first = opened.pop() if opened else start + last
            if start + last - 1 > first:
                yield Fold(first, start + last - 1, "region")
        opened += (start + line for line in inside.opened)


@dataclass(frozen=True, slots=True)
class _Brackets:
    """The line numbers of the brackets in a text, counted from the first line of the text.

    ``pairs`` are the lines of matching brackets with at least one line between them. ``closed`` and ``opened`` are the
    lines of unmatched brackets.
    """

    pairs: tuple[tuple[int, int], ...]
    closed: tuple[int, ...]
    opened: tuple[int, ...]


_NONE = _Brackets((), (), ())


@kept_with_key
def _brackets_in(declaration: Declaration) -> _Brackets:
    found = _pairs(declaration.text)
    return _NONE if found == _NONE else found


def _pairs(text: str) -> _Brackets:
    document = Document("", 0, text)
    pairs: list[tuple[int, int]] = []
    closed: list[int] = []
    opened: list[int] = []
    for match in _SIGNS.finditer(document.text):
        if match["open"]:
            opened.append(document.position(match.start()).line)
        elif match["close"]:
            line = document.position(match.start()).line
            if not opened:
                closed.append(line)
            elif line - 1 > (first := opened.pop()):
                pairs.append((first, line))
    return _Brackets(tuple(pairs), tuple(closed), tuple(opened))


def _runs(document: Document) -> Iterator[Fold]:
    """Yield the runs of at least two lines that are comments, or imports."""
    for beginning, kind in _BEGINNINGS:
        first, last = 0, -1
        for line in _lines_with(document, beginning):
            if line != last + 1:
                if last > first:
                    yield Fold(first, last, kind)
                first = line
            last = line
        if last > first:
            yield Fold(first, last, kind)


def _lines_with(document: Document, beginning: str) -> Iterator[int]:
    """Yield the numbers of the lines that begin with a text, after white space."""
    text, starts = document.text, document.line_starts
    # This is many times as fast as a test of each line.
    found = text.find(beginning)
    while found >= 0:
        line = document.position(found).line
        if not text[starts[line] : found].strip():
            yield line
        after = starts[line + 1] if line + 1 < len(starts) else len(text)
        found = text.find(beginning, after)
