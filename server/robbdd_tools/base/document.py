"""Documents and the offsets, spans and positions inside them (all in code points)."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import accumulate, count
from operator import add

LATEST = 16
"""Number of texts whose lines are kept."""


@dataclass(frozen=True, slots=True, order=True)
class Span:
    """A half-open range ``[start, end)`` of code-point offsets in one document."""

    start: int
    end: int

    def shifted(self, offset: int) -> Span:
        """Return the span moved by ``offset`` code points."""
        return Span(self.start + offset, self.end + offset)

    def contains(self, offset: int) -> bool:
        """Return whether ``offset`` is inside the span or at one of its ends.

        A cursor just after a name is on the name.
        """
        return self.start <= offset <= self.end


@dataclass(frozen=True, slots=True, order=True)
class Position:
    """A line and a column. Both count from 0, and the column counts code points."""

    line: int
    column: int


@dataclass(frozen=True)
class Document:
    """One revision of one text. ``uri`` is a ``file:`` URI, or one that an editor assigns (``untitled:``)."""

    uri: str
    version: int
    text: str

    @cached_property
    def line_starts(self) -> tuple[int, ...]:
        """The offset of the first code point of each line. ``\n``, ``\r\n`` and a lone ``\r`` end a line."""
        return _line_starts(self.text)

    def line_at(self, offset: int) -> int:
        """Return the line of an offset in the text."""
        return bisect_right(self.line_starts, offset) - 1

    def position(self, offset: int) -> Position:
        """Return the position of an offset. An offset beyond the text is moved to its end."""
        offset = min(max(offset, 0), len(self.text))
        line = self.line_at(offset)
        return Position(line, offset - self.line_starts[line])

    def offset(self, position: Position) -> int:
        """Return the offset of a position. A position beyond its line or the text is moved to the end of it."""
        if position.line >= len(self.line_starts):
            return len(self.text)
        return self.line_starts[position.line] + min(position.column, len(self.line_text(position.line)))

    def line_text(self, line: int) -> str:
        """Return one line without its line ending."""
        start = self.line_starts[line]
        end = self.line_starts[line + 1] if line + 1 < len(self.line_starts) else len(self.text)
        return self.text[start:end].rstrip("\r\n")


@lru_cache(maxsize=LATEST)
def _line_starts(text: str) -> tuple[int, ...]:
    """Return the offsets of the lines. Several documents have the same text, such as the one that a client has open."""
    if "\r" not in text:
        lengths = map(len, text.split("\n")[:-1])
        return tuple(map(add, accumulate(lengths, initial=0), count()))
    starts = [0]
    index = 0
    while True:
        newline = text.find("\n", index)
        carriage = text.find("\r", index, newline if newline >= 0 else len(text))
        if carriage >= 0 and carriage + 1 != newline:
            index = carriage + 1
        elif newline >= 0:
            index = newline + 1
        else:
            return tuple(starts)
        starts.append(index)


def edited_part(old: str, new: str) -> tuple[int, int]:
    """Return the start and the end of the smallest part of ``old`` that must be replaced to obtain ``new``."""
    start = common_prefix(old, new)
    return start, len(old) - common_prefix(old[start:][::-1], new[start:][::-1])


def common_prefix(one: Sequence[object], other: Sequence[object]) -> int:
    """Return the length of the longest common prefix of two texts or tuples. It is found by bisection."""
    low, high = 0, min(len(one), len(other))
    while low < high:
        middle = (low + high + 1) // 2
        if one[low:middle] == other[low:middle]:
            low = middle
        else:
            high = middle - 1
    return low
