"""Split a text into chunks, one per top-level declaration, without parsing it.

A declaration starts where its opening words occur outside all braces, or at the beginning of a line anywhere: a missing
closing brace then breaks one declaration, not the rest of the file.
"""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from collections import OrderedDict
from dataclasses import dataclass
from functools import cache
from itertools import islice, pairwise

from robbdd_tools.base.document import edited_part

CACHED_SCANS = 4
"""Number of texts whose scans are kept."""
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
        rf"(?:Event|Task|Requirement)(?:\s*\(|\s+{_NAME})",
        rf"Predicate(?:\s*[(<]|\s+{_NAME})",
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
        r"robot\s+log\b",
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
    return _chunks(text, scanned(language, text).starts)


def split_once(language: str, text: str) -> tuple[Chunk, ...]:
    """Return ``split(language, text)`` for a text that is not edited: nothing is cached."""
    scan = Scan(text, [], [], [])
    _continue(language, scan)
    return _chunks(text, scan.starts)


def _chunks(text: str, starts: list[int]) -> tuple[Chunk, ...]:
    first = starts[0] if starts else len(text)
    lead = len(text) - len(_LEAD.sub("", text, count=1))
    if lead < first:
        starts = [lead, *starts]
    return tuple(Chunk(start, text[start:end]) for start, end in pairwise((*starts, len(text))))


def resplit(language: str, old: str, chunks: tuple[Chunk, ...], new: str) -> tuple[Chunk, ...]:
    """Return ``split(language, new)``, given the chunks of ``old``: only the text around the edit is scanned.

    The edited chunk and the one before it, whose end may have moved, are made again. Earlier chunks stay the same, and
    so do later chunks from the first old start that is found again.
    """
    edited, behind_edit = edited_part(old, new)
    first = bisect_left(chunks, edited, key=lambda chunk: chunk.offset) - 2
    if first < 0:
        return _chunks(new, scanned(language, new, (old, edited, behind_edit)).starts)
    shift = len(new) - len(old)
    behind = {chunk.offset + shift: index for index, chunk in enumerate(chunks) if chunk.offset >= behind_edit}
    begin = chunks[first].offset
    starts = [begin]
    rest: tuple[Chunk, ...] = ()
    every = scanned(language, new, (old, edited, behind_edit)).starts
    for start in islice(every, bisect_right(every, begin), None):
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


@dataclass(frozen=True, slots=True)
class Scan:
    """The starts of all chunks of a text, and the splitter's states.

    ``marks`` are the offsets just after each bracket, and ``depths`` are the numbers of open brackets there. No token
    extends over a bracket, so from a mark on, the result depends only on the depth and on the following text.
    """

    text: str
    starts: list[int]
    marks: list[int]
    depths: list[int]


_scans: OrderedDict[tuple[str, str], Scan] = OrderedDict()


def forget_scans() -> None:
    """Clear the cache of scans."""
    _scans.clear()


def scanned(language: str, text: str, edit: tuple[str, int, int] | None = None) -> Scan:
    """Return the scan of a text.

    ``edit`` is an earlier text and the part of it that was replaced. If its scan is cached, only that part is scanned.
    """
    found = _scans.get((language, text))
    if found is None:
        known = None if edit is None else _scans.get((language, edit[0]))
        if edit is None or known is None:
            found = Scan(text, [], [], [])
            _continue(language, found)
        else:
            found = _until(known, edit[1], text)
            _continue(language, found, known, edit[2])
    _scans[language, text] = found
    _scans.move_to_end((language, text))
    if len(_scans) > CACHED_SCANS:
        _scans.popitem(last=False)
    return found


def _until(known: Scan, edited: int, text: str) -> Scan:
    """Return the part of a known scan up to the last bracket before the edit, as the start of the scan of ``text``."""
    count = bisect_right(known.marks, edited)
    end = known.marks[count - 1] if count else 0
    return Scan(text, known.starts[: bisect_left(known.starts, end)], known.marks[:count], known.depths[:count])


def _continue(language: str, scan: Scan, known: Scan | None = None, edit_end: int = 0) -> None:
    """Complete a scan. After the edit, the known scan is used from the first bracket at which it has the same depth."""
    text, starts, marks, depths = scan.text, scan.starts, scan.marks, scan.depths
    position, depth = (marks[-1], depths[-1]) if marks else (0, 0)
    shift = 0 if known is None else len(text) - len(known.text)
    search = _scanner(language).search
    while match := search(text, position):
        position = match.end()
        if match["start"]:
            begin = match.start()
            # The starter may include an opening bracket or quote: scan it again.
            position = begin + len(match["start"].rstrip("(\"'"))
            if depth == 0 or _starts_line(text, begin):
                depth = 0
                starts.append(begin)
        elif match["open"] or match["close"]:
            depth = depth + 1 if match["open"] else max(0, depth - 1)
            marks.append(position)
            depths.append(depth)
            if known is not None and position - shift > edit_end:
                index = bisect_left(known.marks, position - shift)
                if known.marks[index : index + 1] == [position - shift] and known.depths[index] == depth:
                    rest = known.starts[bisect_left(known.starts, position - shift) :]
                    starts += [start + shift for start in rest]
                    marks += [mark + shift for mark in known.marks[index + 1 :]]
                    depths += known.depths[index + 1 :]
                    return


def _starts_line(text: str, offset: int) -> bool:
    return not text[text.rfind("\n", 0, offset) + 1 : offset].strip()
