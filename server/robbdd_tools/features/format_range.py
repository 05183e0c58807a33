"""Layout of a part of a text, and of the lines that were just typed."""

from __future__ import annotations

from collections.abc import Iterator
from difflib import SequenceMatcher
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit
from robbdd_tools.base.document import Span
from robbdd_tools.features.layout import lay_out

if TYPE_CHECKING:
    from robbdd_tools.base.document import Document

_HERE = "here_it_goes_on"


def format_range(document: Document, within: Span) -> list[Edit]:
    """Return the edits that lay out the lines of a part of a text as the whole would be laid out."""
    first, last = document.position(within.start).line, document.position(within.end).line
    if last > first and document.position(within.end).column == 0:
        last -= 1
    return list(_changes(document, first, last))


def format_on_type(document: Document, offset: int, typed: str) -> list[Edit]:
    """Return the edits behind a typed character: ``}`` and ``|`` lay out their lines, a new line is indented."""
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
    found = next((entry for entry in lay_out(marked).split("\n") if _HERE in entry), "")
    indent = found[: found.index(_HERE)] if _HERE in found else ""
    if indent.strip() or text[:blank] == indent:
        return []
    return [Edit(document.uri, Span(start, start + blank), indent)]


def _changes(document: Document, first: int, last: int) -> Iterator[Edit]:
    """Yield the differences to the whole text laid out that lie within some lines."""
    before = document.text.splitlines(keepends=True)
    after = lay_out(document.text).splitlines(keepends=True)
    starts = [*document.line_starts, len(document.text)]
    for kind, low, high, new, end in SequenceMatcher(None, before, after, autojunk=False).get_opcodes():
        if kind == "equal":
            continue
        if high - low == end - new:
            for line in range(max(low, first), min(high, last + 1)):
                if before[line] != after[new + line - low]:
                    yield Edit(document.uri, Span(starts[line], starts[line + 1]), after[new + line - low])
        elif first <= low and high <= last + 1:
            yield Edit(document.uri, Span(starts[low], starts[high]), "".join(after[new:end]))
