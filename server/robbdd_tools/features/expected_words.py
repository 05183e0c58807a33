"""Determine the tokens and the keyword sequences that the grammar accepts at a cursor."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from robbdd_tools.syntax.chunk import parse_chunk
from robbdd_tools.syntax.grammar_files import grammar_text
from robbdd_tools.syntax.joined import joined_clauses
from robbdd_tools.syntax.parsed import Parsed

if TYPE_CHECKING:
    from robbdd_tools.syntax.parsed import Expectation

MAX_BROKEN_LINES = 50
"""Maximum number of unparsable lines skipped before a cursor."""


_MAX_HEADS = 2
"""Maximum number of section heads above a line that may belong to empty sections."""


@dataclass(frozen=True, slots=True)
class Place:
    """A place in a text.

    - ``before``: the text that was parsed. Lines that cannot be parsed are blanked, and clauses joined by 'and' or 'or'
      or negated by 'not' have their parentheses.
    - ``expected``: the tokens that the grammar accepts after it; ``None`` if the text could not be parsed.
    - ``opened``: the places of the missing parentheses that are still open at the end of the text, as distances from
      this end.
    """

    before: str
    expected: Expectation | None
    opened: tuple[int, ...] = ()


def place_after(language: str, before: str) -> Place:
    """Return the place at the end of a text, with the tokens that the grammar accepts there."""
    opened: list[int] = []
    for _ in range(MAX_BROKEN_LINES):
        parsed = parse_chunk(language, before)
        if isinstance(parsed, Parsed):
            # After a complete declaration, another one starts. Its first words may already be typed.
            return place_after(language, before[parsed.trailing :] if parsed.trailing is not None else "")
        joined = joined_clauses(language, before, parsed)
        if joined is not None:
            if joined.end is None:
                opened.append(len(before) - joined.start)
            else:
                before = f"{before[: joined.end]}){before[joined.end :]}"
            before = f"{before[: joined.start]}({before[joined.start :]}"
            continue
        if not before[parsed.offset :].strip():
            return Place(before, parsed.expected, tuple(opened))
        blanked = _without_faulty_line(language, before, parsed.offset)
        if blanked is None:
            break
        before = blanked
    return Place(before, None)


def _without_faulty_line(language: str, before: str, offset: int) -> str | None:
    """Return a text without the line at which the parser stopped; ``None`` if the cursor is in this line.

    If the section above is empty and the parser gets further without its heading (``Given:``), the heading is removed
    instead. Removed text is replaced by spaces.
    """
    start, end = before.rfind("\n", 0, offset) + 1, before.find("\n", offset)
    if end < 0 or not before[start:end].strip():
        return None
    choices = [_blanked(before, start, end)]
    above = before[:start].rstrip()
    while above.endswith(":") and len(choices) <= _MAX_HEADS:
        head = above.rfind("\n") + 1
        choices.append(_blanked(before, head, len(above)))
        above = before[:head].rstrip()
    return max(choices, key=lambda text: _parsed_length(language, text)) if len(choices) > 1 else choices[0]


def _blanked(text: str, start: int, end: int) -> str:
    return text[:start] + " " * (end - start) + text[end:]


def _parsed_length(language: str, text: str) -> int:
    found = parse_chunk(language, text)
    return len(text) if isinstance(found, Parsed) else found.offset


def keyword_phrases(language: str, before: str, expected: Expectation) -> list[str]:
    """Return each accepted keyword together with the keywords that must follow it."""
    found: set[str] = set()
    for literal in expected.literals:
        if not literal[:1].isalpha():
            continue
        runs = _keyword_runs(language).get(literal, ())
        fitting = [run for run in runs if is_accepted(language, before, run)]
        found.update(fitting or [literal])
    return sorted(found)


def is_accepted(language: str, before: str, following: str) -> bool:
    """Return whether the grammar accepts a text after another one."""
    text = f"{before}{following} "
    parsed = parse_chunk(language, text)
    while isinstance(parsed, Parsed) and parsed.trailing is not None:
        # Text after a complete declaration must begin another one.
        text = text[parsed.trailing :]
        parsed = parse_chunk(language, text)
    return isinstance(parsed, Parsed) or not text[parsed.offset :].strip()


@cache
def _keyword_runs(language: str) -> dict[str, tuple[str, ...]]:
    """Map each keyword to the keyword sequences in the grammar that start with it (``is`` → ``is located at`` …)."""
    runs: dict[str, dict[str, None]] = {}
    for match in re.finditer(r"'[^\W\d]\w*'(?:\s+'[^\W\d]\w*')+", grammar_text(language)):
        words = re.findall(r"\w+", match[0])
        runs.setdefault(words[0], {})[" ".join(words)] = None
    return {word: tuple(found) for word, found in runs.items()}
