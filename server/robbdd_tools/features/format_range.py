"""Format a range of lines, and format lines while the user types."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit
from robbdd_tools.base.document import Span
from robbdd_tools.features.layout import laid_out

if TYPE_CHECKING:
    from robbdd_tools.base.document import Document
    from robbdd_tools.features.layout import LaidOut

_HERE = "here_it_goes_on"
_ENDING = re.compile(r"\r\n|\r|\n")


def format_range(document: Document, within: Span) -> list[Edit]:
    """Return the edits that lay out the lines of a range as in the formatted document."""
    first, last = document.position(within.start).line, document.position(within.end).line
    if last > first and document.position(within.end).column == 0:
        last -= 1
    return list(_changes(document, first, last))


def format_on_type(document: Document, offset: int, typed: str) -> list[Edit]:
    """Return the edits to make after the user typed a character.

    After ``}``, its line is formatted. After ``|``, its line and the table rows above it are formatted. After a line
    break, the new line is indented.
    """
    line = document.position(offset).line
    if typed != "\n":
        first = line
        while typed == "|" and first > 0 and document.line_text(first - 1).lstrip().startswith("|"):
            first -= 1
        return list(_changes(document, first, line))
    text = document.line_text(line)
    start = document.line_starts[line]
    blank = len(text) - len(text.lstrip())
    marked = document.text[: start + blank] + _HERE + document.text[start + blank :]
    found = next((entry.text for entry in laid_out(marked) if _HERE in entry.text), "")
    indent = found[: found.index(_HERE)] if _HERE in found else ""
    if indent.strip() or text[:blank] == indent:
        return []
    return [Edit(document.uri, Span(start, start + blank), indent)]


def _changes(document: Document, first: int, last: int) -> Iterator[Edit]:
    """Yield the edits that turn some lines into the lines of the formatted text. Line endings stay unchanged."""
    end = 0
    for line in laid_out(document.text):
        yield from _without(document, max(end, first), min(line.first, last + 1))
        if line.first > last:
            return
        if first <= line.first and line.end <= last + 1:
            yield from _replaced(document, line)
        end = line.end
    yield from _without(document, max(end, first), last + 1)


def _without(document: Document, first: int, end: int) -> Iterator[Edit]:
    """Yield the edit that removes some lines."""
    span = Span(_start(document, first), _start(document, end))
    if span.start < span.end:
        yield Edit(document.uri, span, "")


def _replaced(document: Document, line: LaidOut) -> Iterator[Edit]:
    start = _start(document, line.first)
    written = document.text[start : _start(document, line.end)]
    content = written.rstrip("\r\n")
    text = line.text if content != written else f"{line.text}\n"
    if _ENDING.sub("\n", content) != text:
        ending = _ENDING.search(document.text)
        yield Edit(document.uri, Span(start, start + len(content)), text.replace("\n", ending[0] if ending else "\n"))


def _start(document: Document, line: int) -> int:
    return document.line_starts[line] if line < len(document.line_starts) else len(document.text)
