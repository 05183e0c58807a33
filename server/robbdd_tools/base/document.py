"""Documents and the offsets, spans and positions inside them (all in code points)."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property


@dataclass(frozen=True, slots=True, order=True)
class Span:
    """Half-open range ``[start, end)`` of code-point offsets in one document."""

    start: int
    end: int

    def shifted(self, offset: int) -> Span:
        """Return the same span counted from ``offset`` code points earlier."""
        return Span(self.start + offset, self.end + offset)

    def contains(self, offset: int) -> bool:
        """Return whether ``offset`` lies inside or at either end (a cursor just after a name is on the name)."""
        return self.start <= offset <= self.end


@dataclass(frozen=True, slots=True, order=True)
class Position:
    """Line and column, both from 0, the column in code points."""

    line: int
    column: int


@dataclass(frozen=True)
class Document:
    """One revision of one text. ``uri`` is a ``file:`` URI or an editor's own (``untitled:``)."""

    uri: str
    version: int
    text: str

    @cached_property
    def line_starts(self) -> tuple[int, ...]:
        """Offset of the first code point of each line; ``\\n``, ``\\r\\n`` and a lone ``\\r`` end a line."""
        starts = [0]
        text = self.text
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

    def position(self, offset: int) -> Position:
        """Convert an offset (clamped to the text) to a position."""
        offset = min(max(offset, 0), len(self.text))
        line = bisect_right(self.line_starts, offset) - 1
        return Position(line, offset - self.line_starts[line])

    def offset(self, position: Position) -> int:
        """Convert a position to an offset, clamped to the line and the text."""
        if position.line >= len(self.line_starts):
            return len(self.text)
        return self.line_starts[position.line] + min(position.column, len(self.line_text(position.line)))

    def line_text(self, line: int) -> str:
        """Return one line without its line ending."""
        start = self.line_starts[line]
        end = self.line_starts[line + 1] if line + 1 < len(self.line_starts) else len(self.text)
        return self.text[start:end].rstrip("\r\n")


def edited_part(old: str, new: str) -> tuple[int, int]:
    """Return start and end in ``old`` of the smallest part that has to be replaced to get ``new``."""
    start = _common(old, new)
    return start, len(old) - _common(old[start:][::-1], new[start:][::-1])


def _common(one: str, other: str) -> int:
    """Return the length of the longest common prefix, by bisection."""
    low, high = 0, min(len(one), len(other))
    while low < high:
        middle = (low + high + 1) // 2
        if one[low:middle] == other[low:middle]:
            low = middle
        else:
            high = middle - 1
    return low
