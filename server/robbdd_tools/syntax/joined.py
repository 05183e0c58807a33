"""Find clauses joined by 'and' or 'or', or negated by 'not', without the parentheses that the language demands."""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.syntax.chunk import parse_chunk
from robbdd_tools.syntax.parsed import Rejected

if TYPE_CHECKING:
    from collections.abc import Iterator

MAX_STARTS = 24
"""Maximum number of places tried as the start of the first joined clause. A clause has fewer words."""
_SPACE = r"(?:\s|//[^\n]*\n)"
_WORD = re.compile(rf"(?<=[)>}}\"']){_SPACE}*(?<![\w\-.])(?P<word>and|or){_SPACE}*\Z")
_NOT = re.compile(rf"(?<![\w\-.<])(?P<word>not){_SPACE}*\Z")
_TOKEN = re.compile(r"//[^\n]*|\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'|[\w\-.]+|\S")
_OPENING, _CLOSING = frozenset("({"), frozenset(")}")
_MAX_LENGTH = 4000


@dataclass(frozen=True, slots=True)
class Joined:
    """Clauses that lack parentheses around them.

    - ``start``: the start of the first clause, or of the 'not' before a single clause.
    - ``word``: the place of the first 'and' or 'or' between them, or of the 'not'.
    - ``end``: the end of the last clause; ``None`` if the text ends before a clause is complete.
    """

    start: int
    word: Span
    end: int | None


def joining_word(text: str, offset: int) -> Span | None:
    """Return the place of the 'and' or 'or' that follows a clause and ends directly before an offset, if any."""
    match = _WORD.search(text, max(0, offset - _MAX_LENGTH), offset)
    return None if match is None else Span(*match.span("word"))


def joined_clauses(language: str, text: str, stopped: Rejected) -> Joined | None:
    """Return the clauses around the place where the parser stopped, or ``None`` if it stopped for another reason."""
    if ":" not in stopped.expected.literals:
        return None
    negation = _NOT.search(text, max(0, stopped.offset - _MAX_LENGTH), stopped.offset)
    # After '(not', the parser accepts a clause. Without the parenthesis, it reads 'not' as a clause's name.
    if negation is not None and "(" not in stopped.expected.literals:
        start, end = negation.span("word")
        return Joined(start, Span(start, end), _end(language, text, start))
    word = joining_word(text, stopped.offset)
    if word is None:
        return None
    for start in islice(_starts(text, word.start), MAX_STARTS):
        # The text up to the end of the word shows whether a clause starts here. The rest may have more errors.
        begun = f"{text[:start]}({text[start : word.end]} "
        found = parse_chunk(language, begun)
        if isinstance(found, Rejected) and not begun[found.offset :].strip():
            return Joined(start, word, _end(language, text, start))
    return None


def _starts(text: str, offset: int) -> Iterator[int]:
    """Yield the places before an offset where a clause may start in the same brackets, nearest first."""
    first = max(0, offset - _MAX_LENGTH)
    depth = 0
    for token in reversed(list(_TOKEN.finditer(text, text.rfind("\n", 0, first) + 1, offset))):
        if token[0] in _CLOSING:
            depth += 1
        elif token[0] in _OPENING:
            depth -= 1
        if depth < 0:
            return
        if depth == 0 and not token[0].startswith("//"):
            yield token.start()


def _end(language: str, text: str, start: int) -> int | None:
    """Return the end of the joined clauses that start at an offset; ``None`` if the parser stops before it."""
    opened = f"{text[:start]}({text[start:]}"
    found = parse_chunk(language, opened)
    if not isinstance(found, Rejected) or ")" not in found.expected.literals or found.offset >= len(opened):
        return None
    end = start
    for token in _TOKEN.finditer(text, start, found.offset - 1):
        if not token[0].startswith("//"):
            end = token.end()
    return end
