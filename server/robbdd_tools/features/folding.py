"""Folding: brackets over several lines, runs of comments and runs of imports."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.base.document import Document
    from robbdd_tools.names.project import Snapshot

_SIGNS = re.compile(r"//[^\n]*|\"(?:\\.|[^\"\\\n])*\"?|'(?:\\.|[^'\\\n])*'?|(?P<open>[{(])|(?P<close>[})])")


@dataclass(frozen=True, slots=True, order=True)
class Fold:
    """Lines (from 0) that can be folded into the first; ``kind`` is ``region``, ``comment`` or ``imports``."""

    first: int
    last: int
    kind: str


def folds(snapshot: Snapshot, uri: str) -> list[Fold]:
    """Return what can be folded in a file, in the order of the text."""
    analysis = snapshot.file(uri)
    if analysis is None:
        return []
    document = analysis.document
    lines = [document.line_text(line).strip() for line in range(len(document.line_starts))]
    found = {
        *_brackets(document),
        *_runs(lines, "//", "comment"),
        *_runs(lines, "import", "imports"),
    }
    return sorted(found)


def _brackets(document: Document) -> Iterator[Fold]:
    opened: list[int] = []
    for match in _SIGNS.finditer(document.text):
        if match["open"]:
            opened.append(match.start())
        elif match["close"] and opened:
            first = document.position(opened.pop()).line
            last = document.position(match.start()).line - 1
            if last > first:
                yield Fold(first, last, "region")


def _runs(lines: list[str], beginning: str, kind: str) -> Iterator[Fold]:
    first: int | None = None
    for number, line in enumerate([*lines, ""]):
        if line.startswith(beginning):
            first = number if first is None else first
            continue
        if first is not None and number - 1 > first:
            yield Fold(first, number - 1, kind)
        first = None
