"""Explain a name before parentheses: only clauses have names, but not groups, negations and quantifiers."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.syntax.declaration import SyntaxFault, SyntaxFix

if TYPE_CHECKING:
    from robbdd_tools.syntax.parsed import Rejected

_NAMED = re.compile(r"(?<![\w\-.])(?P<name>[^\W\d][\w\-]*)\s*:\s*\Z")
LONGEST = 120
"""Maximum number of characters from the name to the parenthesis."""


def name_of_group(text: str, rejected: Rejected) -> Span | None:
    """Return the name, with its colon and the white space after it, of the group at which the parser stopped."""
    offset = rejected.offset
    if "holds" not in rejected.expected.literals or not text.startswith("(", offset):
        return None
    found = _NAMED.search(text, max(0, offset - LONGEST), offset)
    return None if found is None else Span(found.start("name"), offset)


def named_group(text: str, rejected: Rejected) -> SyntaxFault | None:
    """Return the fault of such a name; ``None`` if the parser stopped elsewhere."""
    span = name_of_group(text, rejected)
    if span is None:
        return None
    written = text[span.start : span.end].rstrip()
    message = f"parentheses have no name, but each clause inside has one: remove '{written}'"
    return SyntaxFault(Span(span.start, span.start + len(written)), message, SyntaxFix(span, "", f"Remove '{written}'"))
