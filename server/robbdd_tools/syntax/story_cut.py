"""Cut the text of a user story at its scenarios, without parsing it.

After an edit, only the text around it is scanned.
"""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from robbdd_tools.base.document import edited_part

_NAME = r"[^\W\d][\w\-]*"
_STRING = r"\"(?:\\.|[^\"\\\n])*\"?|'(?:\\.|[^'\\\n])*'?"
_SCANNER = re.compile(
    rf"(?=[/\"'{{}}S])(?://[^\n]*|{_STRING}|(?P<open>{{)|(?P<close>}})"
    rf"|(?<![\w\-.<])(?P<scenario>Scenario(?![\w\-])(?P<header>(?:\s+Variant(?=\s+{_NAME}))?\s+{_NAME}\s*{{)?))"
)
_LONG_STRINGS = re.compile(r"//[^\n]*|\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'")
_CUTTING = re.compile(r"[{}]|\bScenario\b")
_STORY = re.compile(r"User\s+Story\b")


@dataclass(frozen=True, slots=True)
class Cut:
    """The parts of a story's text: the starts of its scenarios, and the start of its closing part."""

    text: str
    starts: tuple[int, ...]
    end: int

    @property
    def head(self) -> str:
        """The text before the first scenario."""
        return self.text[: self.starts[0]]

    @property
    def tail(self) -> str:
        """The text after the last scenario."""
        return self.text[self.end :]

    def scenarios(self) -> Iterator[tuple[int, str]]:
        """Yield the offset and the text of each scenario. The text extends to the next scenario."""
        return ((start, self.text[start:end]) for start, end in pairwise((*self.starts, self.end)))


def cut_story(text: str) -> Cut | None:
    """Return the parts of a story, or ``None`` if the text is not a story with scenarios.

    A scenario starts at its keyword directly inside the story's braces. With its name and brace, it also starts at the
    beginning of any line, so a missing brace breaks only one scenario.
    """
    if not _STORY.match(text):
        return None
    global _latest_scan
    found = _scan_story(text, _latest_scan)
    _latest_scan = found
    starts, end = found.starts, found.end
    if not starts:
        return None
    return Cut(text, tuple(starts), _closing_line(text, starts[-1]) if end is None else end)


@dataclass(slots=True)
class _Scan:
    """The starts of the scenarios in a text, and the offset of the brace that closes the story.

    ``marks`` are the offsets just after the headers of scenarios, and ``counts`` are the numbers of starts up to there.
    From a mark on, the scan depends only on the following text.
    """

    text: str
    starts: list[int]
    marks: list[int]
    counts: list[int]
    end: int | None


_latest_scan: _Scan | None = None


def _scan_story(text: str, known: _Scan | None) -> _Scan:
    """Return the scan of a text. Only the part that differs from the text of the known scan is scanned."""
    scan = _Scan(text, [], [], [], None)
    depth, position, edit_end, shift = 0, 0, 0, 0
    if known is not None:
        edited, edit_end = edited_part(known.text, text)
        shift = len(text) - len(known.text)
        if count := bisect_right(known.marks, edited):
            scan.marks, scan.counts = known.marks[:count], known.counts[:count]
            scan.starts = known.starts[: scan.counts[-1]]
            depth, position = 2, scan.marks[-1]
    for match in _SCANNER.finditer(text, position):
        if match["open"]:
            depth += 1
        elif match["close"]:
            depth -= 1
            if depth == 0 and scan.end is None:
                scan.end = match.start()
        elif match["scenario"] and (depth == 1 or (match["header"] and _starts_line(text, match.start()))):
            scan.starts.append(match.start())
            depth, scan.end = (2 if match["header"] else 1), None
            if match["header"] and match["scenario"].endswith("{"):
                scan.marks.append(match.end())
                scan.counts.append(len(scan.starts))
                if known is not None and match.start() - shift > edit_end and _goes_on(scan, known, shift):
                    return scan
    return scan


def _goes_on(scan: _Scan, known: _Scan, shift: int) -> bool:
    """Complete a scan with the rest of a known one, if that has a header at the same place after the edit."""
    index = bisect_left(known.marks, scan.marks[-1] - shift)
    if known.marks[index : index + 1] != [scan.marks[-1] - shift]:
        return False
    more = len(scan.starts) - known.counts[index]
    scan.starts += [start + shift for start in known.starts[known.counts[index] :]]
    scan.marks += [mark + shift for mark in known.marks[index + 1 :]]
    scan.counts += [count + more for count in known.counts[index + 1 :]]
    scan.end = None if known.end is None else known.end + shift
    return True


def forget_scan() -> None:
    """Clear the cached scan of the latest story."""
    global _latest_scan
    _latest_scan = None


def quotes_cuts(text: str) -> bool:
    """Return whether a multi-line string contains a brace or *Scenario*, which would mislead ``cut_story``.

    A quote that is not closed yet has the same effect.
    """
    return any("\n" in match[0] and _CUTTING.search(match[0]) for match in _LONG_STRINGS.finditer(text))


def _starts_line(text: str, offset: int) -> bool:
    """Return whether there is only white space before a place in its line."""
    return not text[text.rfind("\n", 0, offset) + 1 : offset].strip()


def _closing_line(text: str, start: int) -> int:
    """Return the end of a story with too few closing braces: the first brace further left than its last scenario."""
    if _starts_line(text, start):
        column = start - text.rfind("\n", 0, start) - 1
        for line in re.finditer(r"^([ \t]*)}", text[start:], re.MULTILINE):
            if len(line[1]) < column:
                return start + line.end() - 1
    return len(text)
