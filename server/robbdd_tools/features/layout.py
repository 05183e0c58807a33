"""Canonical layout of a text: indentation, spacing and aligned tables. Line breaks stay.

The layout is computed from tokens instead of syntax trees. So comments keep their place, and broken text is formatted
as far as possible.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import chain

INDENT = "    "
_STRING = r"\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'"
_TOKEN = re.compile(
    r"(?P<comment>//[^\n]*)"
    rf"|(?P<string>{_STRING})"
    r"|(?P<reference><\s*[^\W\d][\w\-.]*\s*>)"
    r"|(?P<word>[^\W](?:[\w\-.+*^]|/(?!/))*|[-+.]?\d[\w.+\-]*)"
    r"|(?P<sign>\S)",
    re.DOTALL,
)
_LABEL = re.compile(r"(?:Given|When|Then|Scenarios|variation)\s*:|for\s+all\b")
_CONTINUED = re.compile(r"- |for\s*<")
_NAMESPACE = re.compile(r"\(\s*ns\s*=\s*([^\W\d][\w\-]*)\s*\)")


@dataclass(frozen=True, slots=True)
class Line:
    """One formatted line.

    Its comment and the cells of a table row are stored separately. The line was made from the source lines from
    ``first`` up to, but excluding, ``end``.
    """

    text: str
    comment: str
    first: int
    end: int
    cells: tuple[str, ...] = ()

    @property
    def written(self) -> str:
        """The text of the line with its comment."""
        return f"{self.text}  {self.comment}" if self.text and self.comment else self.text or self.comment


@dataclass(frozen=True, slots=True)
class LaidOut:
    """A line in canonical layout, made from the source lines from ``first`` up to, but excluding, ``end``."""

    text: str
    first: int
    end: int


@dataclass(slots=True)
class _Levels:
    """The brackets that are open at a line.

    ``labelled`` states for each bracket whether a label indents the lines inside the bracket.
    """

    labelled: list[bool] = field(default_factory=lambda: [False])

    def indentation(self, text: str) -> str:
        """Return the indentation of a line. A closing bracket has the indentation of the line that opened it."""
        closing = len(text) - len(text.lstrip("})"))
        inner = self.labelled[: max(1, len(self.labelled) - closing)]
        depth = len(inner) - 1 + sum(inner)
        if inner[-1] and _LABEL.match(text):
            depth -= 1
        if _CONTINUED.match(text):
            depth += 1
        return INDENT * depth

    def pass_over(self, text: str) -> None:
        """Update the brackets and the label with a line."""
        label = _LABEL.match(text)
        if label:
            self.labelled[-1] = not text[label.end() :].strip()
        for match in _TOKEN.finditer(text):
            if match["sign"] in ("{", "("):
                self.labelled.append(False)
            elif match["sign"] in ("}", ")") and len(self.labelled) > 1:
                self.labelled.pop()


def lay_out(text: str) -> str:
    """Return a text in canonical layout. A text that is already in canonical layout stays unchanged."""
    return "".join(f"{line.text}\n" for line in laid_out(text))


def laid_out(text: str) -> Iterator[LaidOut]:
    """Yield the lines of a text in canonical layout.

    Consecutive blank lines are merged, and blank lines at both ends of the text are removed.
    """
    begun = False
    blank: LaidOut | None = None
    for line in _indented(text):
        if not line.text:
            blank = blank or line
            continue
        if begun and blank is not None:
            yield blank
        yield line
        begun, blank = True, None


def _indented(text: str) -> Iterator[LaidOut]:
    levels = _Levels()
    block: list[Line] = []
    for line in chain(_rows(_lines(text)), (None,)):
        if line is not None and line.cells:
            block.append(line)
            continue
        for row, aligned in zip(block, _aligned(block) if block else (), strict=True):
            yield LaidOut(levels.indentation("|") + aligned, row.first, row.end)
        block = []
        if line is not None:
            indentation = levels.indentation(line.text) if line.written else ""
            yield LaidOut(indentation + line.written, line.first, line.end)
            levels.pass_over(line.text)


def _lines(text: str) -> Iterator[Line]:
    """Yield the lines of a text with single spaces between words. A string keeps its own line breaks."""
    pieces: list[str] = []
    comment = ""
    first = number = 0
    end = 0
    for match in _TOKEN.finditer(text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")):
        gap = match.string[end : match.start()]
        for _ in range(gap.count("\n")):
            yield _line(pieces, comment, first, number + 1)
            pieces, comment = [], ""
            first = number = number + 1
        if pieces and gap:
            pieces.append(" ")
        if match["comment"] is not None and not gap and pieces[-1:] == [":"]:
            # This is the end of an IRI. A missing quote further up has put it outside its string.
            pieces.append(match["comment"].rstrip())
        elif match["comment"] is not None:
            comment = match["comment"].rstrip()
        elif match["reference"] is not None:
            pieces.append("<" + match["reference"][1:-1].strip() + ">")
        else:
            pieces.append(match[0])
        number += match[0].count("\n")
        end = match.end()
    yield _line(pieces, comment, first, number + 1)


def _line(pieces: list[str], comment: str, first: int, end: int) -> Line:
    spaced: list[str] = []
    for index, piece in enumerate(pieces):
        following = pieces[index + 1] if index + 1 < len(pieces) else ""
        if piece == " " and following in (",", ":"):
            continue
        spaced.append(piece)
        if piece == "," and following not in ("", " ", ",", ":"):
            spaced.append(" ")
    text = _NAMESPACE.sub(r"(ns=\1)", "".join(spaced).strip())
    return Line(text, comment, first, end)


def _rows(lines: Iterator[Line]) -> Iterator[Line]:
    """Join the lines of a table row that was broken into several lines, unless there is a comment between them."""
    row: Line | None = None
    for line in lines:
        if row is not None and not row.comment and line.text.endswith("|") and not line.text.startswith("|"):
            row = Line(f"{row.text} {line.text}", line.comment, row.first, line.end)
            continue
        if row is not None:
            yield _with_cells(row)
            row = None
        if line.text.startswith("|"):
            row = line
        else:
            yield line
    if row is not None:
        yield _with_cells(row)


def _with_cells(row: Line) -> Line:
    cells = [""]
    for match in re.finditer(rf"{_STRING}|[^|\"']+|\||.", row.text, re.DOTALL):
        if match[0] == "|":
            cells.append("")
        else:
            cells[-1] += match[0]
    inner = tuple(cell.strip() for cell in cells[1:-1]) if row.text.endswith("|") else ()
    return replace(row, cells=inner)


def _aligned(block: list[Line]) -> Iterator[str]:
    """Yield the rows of a table with aligned columns. The dashes under the header fill each column."""
    columns = max(len(row.cells) for row in block)
    widths = [3] * columns
    for row in block:
        if not _is_rule(row):
            for column, cell in enumerate(row.cells):
                widths[column] = max(widths[column], len(cell))
    for row in block:
        if _is_rule(row):
            text = "|" + "|".join("-" * (width + 2) for width in widths) + "|"
        else:
            padded = (cell.ljust(widths[column]) for column, cell in enumerate(row.cells))
            text = "| " + " | ".join(padded) + " |"
        yield f"{text}  {row.comment}" if row.comment else text


def _is_rule(row: Line) -> bool:
    return all(cell and not cell.strip("-") for cell in row.cells)
