"""Fixes that remove a part of a text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix
from robbdd_tools.base.document import Span

if TYPE_CHECKING:
    from robbdd_tools.base.document import Document


def removal(document: Document, title: str, span: Span) -> Fix:
    """Return the fix that removes a span. Lines that would become empty are removed, too."""
    text = document.text
    start, end = span.start, span.end
    line_start = document.line_starts[document.position(start).line]
    line_end = end + len(document.line_text(document.position(end).line)) - document.position(end).column
    if not text[line_start:start].strip() and not text[end:line_end].strip():
        start, end = line_start, line_end
        if text[end : end + 2] == "\r\n":
            end += 2
        elif end < len(text):
            end += 1
    return Fix(title, (Edit(document.uri, Span(start, end), ""),))
