"""Folding: multi-line brackets, runs of comments and runs of imports."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Document
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.features.studies import is_study

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration

_SIGNS = re.compile(r"//[^\n]*|\"(?:\\.|[^\"\\\n])*\"?|'(?:\\.|[^'\\\n])*'?|(?P<open>[{(])|(?P<close>[})])")

_LINE_END = re.compile(r"\r\n|\r|\n")


@dataclass(frozen=True, slots=True, order=True)
class Fold:
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
    lines = [line.lstrip() for line in _LINE_END.split(analysis.document.text)]
    found = {
        *_brackets(analysis),
        *_runs(lines, "//", "comment"),
        *_runs(lines, "import", "imports"),
    }
    return sorted(found)


def _brackets(file: FileAnalysis) -> Iterator[Fold]:
    opened: list[int] = []
    if is_study(file.document.uri):
        yield from (
            Fold(first, last - 1, "region") for first, last in _pairs(file.document.text).pairs if last - 1 > first
        )
    for placed in file.parts():
        start = file.document.position(placed.offset).line
        inside = _brackets_in(placed.declaration)
        for first, last in (*inside.pairs, *((opened.pop() - start, last) for last in inside.closed if opened)):
            if last - 1 > first:
                yield Fold(start + first, start + last - 1, "region")
        opened += (start + line for line in inside.opened)


@dataclass(frozen=True, slots=True)
class _Brackets:
    """The line numbers of the brackets in a text, counted from the first line of the text.

    ``pairs`` are the lines of matching brackets. ``closed`` and ``opened`` are the lines of unmatched brackets.
    """

    pairs: tuple[tuple[int, int], ...]
    closed: tuple[int, ...]
    opened: tuple[int, ...]


@kept_with_key
def _brackets_in(declaration: Declaration) -> _Brackets:
    return _pairs(declaration.text)


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
            if opened:
                pairs.append((opened.pop(), line))
            else:
                closed.append(line)
    return _Brackets(tuple(pairs), tuple(closed), tuple(opened))


def _runs(lines: list[str], beginning: str, kind: str) -> Iterator[Fold]:
    first: int | None = None
    for number, line in enumerate([*lines, ""]):
        if line.startswith(beginning):
            first = number if first is None else first
            continue
        if first is not None and number - 1 > first:
            yield Fold(first, number - 1, kind)
        first = None
