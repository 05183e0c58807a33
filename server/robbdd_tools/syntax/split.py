"""Split a text into chunks, one per top-level declaration, without parsing it.

A declaration starts where its opening words occur outside all braces, or at the beginning of a line anywhere: a missing
closing brace then breaks one declaration, not the rest of the file.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

from robbdd_tools.base.document import edited_part

_NAME = r"[^\W\d][\w\-]*"
_GAP = r"(?:\s|//[^\n]*\n)"
"""Separator between two words: white space and comments."""
_SHARED_STARTERS = (r"import\s*[\"']", rf"ns\s+{_NAME}\s*=")
_STARTERS = {
    "scene": (
        *_SHARED_STARTERS,
        r"similar\s+(?:obj|ws|agn)\s+set\b",
        rf"(?:obj|ws|agn)\s+set(?:\s*\(|\s+{_NAME})",
        rf"(?:comp|scene)(?:\s*\(|\s+{_NAME})",
    ),
    "bdd": (
        *_SHARED_STARTERS,
        rf"(?:Event|Task)(?:\s*\(|\s+{_NAME})",
        r"Behaviour\s+Tree\b",
        r"const\s+set\b",
        r"Scenario\s+Template\b",
        r"User\s+Story\b",
    ),
    "scenex": (
        *_SHARED_STARTERS,
        r"distrib\s*\(",
        r"scene\s+inst\b",
        rf"ktree(?:\s*\(|\s+{_NAME})",
    ),
    "bddx": (
        *_SHARED_STARTERS,
        r"bhv\s+impl\b",
        r"obs\s+(?:provider|policy)\b",
        r"observation\s*\(",
        r"Scenario\s+Exec\b",
    ),
}
_STARTERS["ktree"] = _STARTERS["scenex"]


@dataclass(frozen=True, slots=True)
class Chunk:
    """The text from the first word of a declaration up to the next declaration, and its offset."""

    offset: int
    text: str


def split(language: str, text: str) -> tuple[Chunk, ...]:
    """Return the chunks of a text in order. Text before the first declaration is a chunk if it is not blank."""
    starts = list(_starts(language, text))
    first = starts[0] if starts else len(text)
    lead = len(text) - len(_LEAD.sub("", text, count=1))
    if lead < first:
        starts.insert(0, lead)
    return tuple(Chunk(start, text[start:end]) for start, end in pairwise((*starts, len(text))))


def resplit(language: str, old: str, chunks: tuple[Chunk, ...], new: str) -> tuple[Chunk, ...]:
    """Return ``split(language, new)``, given the chunks of ``old``: only the text around the edit is scanned.

    The splitter's state at the start of a chunk is always the same. So it can restart at a chunk before the edit (the
    one before the edited chunk, whose end may have moved) and stop when, after the edit, it reaches the start of an old
    chunk.
    """
    edited, behind_edit = edited_part(old, new)
    first = bisect_left(chunks, edited, key=lambda chunk: chunk.offset) - 2
    if first < 0:
        return split(language, new)
    shift = len(new) - len(old)
    behind = {chunk.offset + shift: index for index, chunk in enumerate(chunks) if chunk.offset >= behind_edit}
    begin = chunks[first].offset
    starts = [begin]
    rest: tuple[Chunk, ...] = ()
    for start in _starts(language, new, begin):
        if start == begin:
            continue
        if start in behind:
            rest = tuple(Chunk(chunk.offset + shift, chunk.text) for chunk in chunks[behind[start] :])
            break
        starts.append(start)
    end = rest[0].offset if rest else len(new)
    between = (Chunk(start, new[start:stop]) for start, stop in pairwise((*starts, end)))
    return (*chunks[:first], *between, *rest)


_LEAD = re.compile(r"\A(?:\s|\ufeff|//[^\n]*)+")


@cache
def _scanner(language: str) -> re.Pattern[str]:
    """Matches comments, strings, braces and starters; everything else is skipped."""
    starters = "|".join(_STARTERS[language]).replace(r"\s", _GAP)
    string = r"\"(?:\\.|[^\"\\\n])*\"?|'(?:\\.|[^'\\\n])*'?"
    # Testing first letters skips nearly all of a text quickly.
    letters = (re.findall(r"(?:^\(\?:|^|\|)([A-Za-z])", starter) for starter in _STARTERS[language])
    first = "".join(sorted({letter for found in letters for letter in found}))
    return re.compile(
        rf"(?=[/\"'{{}}(){first}])"
        rf"(?://[^\n]*|(?P<start>(?<![\w\-.<])(?:{starters}))|{string}|(?P<open>[{{(])|(?P<close>[}})]))"
    )


def _starts(language: str, text: str, position: int = 0) -> Iterator[int]:
    depth = 0
    scan = _scanner(language).search
    while match := scan(text, position):
        position = match.end()
        if match["open"]:
            depth += 1
        elif match["close"]:
            depth = max(0, depth - 1)
        elif match["start"]:
            begin = match.start()
            # The starter may include an opening bracket or quote: scan it again.
            position = begin + len(match["start"].rstrip("(\"'"))
            if depth == 0 or _starts_line(text, begin):
                depth = 0
                yield begin


def _starts_line(text: str, offset: int) -> bool:
    return not text[text.rfind("\n", 0, offset) + 1 : offset].strip()
