"""Find all syntax errors of a chunk, and a tree of its valid parts, by repairing its text until it parses.

Each repair keeps the length of the text: a symbol replaces white space, a misspelt keyword is overwritten into the
white space after it, and text that cannot be repaired is blanked. So every span of the tree is a span of the user's
text. A repair is valid if the parser then gets beyond the error. The smallest repair with which the whole chunk parses
is chosen or, if there is none, the repair with which the parser gets furthest.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from difflib import SequenceMatcher
from itertools import islice

from robbdd_tools.base.document import Span
from robbdd_tools.syntax.chunk import parse_chunk
from robbdd_tools.syntax.joined import joined_clauses
from robbdd_tools.syntax.named_groups import name_of_group
from robbdd_tools.syntax.parsed import Expectation, Parsed, Rejected
from robbdd_tools.syntax.quantified_sets import written_set
from robbdd_tools.syntax.unknown_phrases import unknown_phrase

MAX_FAULTS = 12
MAX_PARSES = 48
"""Maximum number of attempts per chunk. It is small because an editor needs the errors after each keystroke."""
ALIKE = 0.6
"""Similarity ratio from which a word counts as a misspelt keyword."""
HOLE = "\u02ad"
"""Placeholder for a missing name. The grammar reads it as a letter, but no alphabet uses it."""
NOTHING = 'pred("")'
"""A predicate without content; no rule checks it."""
_SET_OF_VALUES = re.compile(r"\b(?P<set>set)\s+var\s*<[^<>]*>\s*:\s*\{\s*\Z")
_TYPE = re.compile(r"\bvar\s+[^\W\d][\w\-]*\s*(?P<type>:\s*[\w\-]+)")
_VALUE = re.compile(r"\bvar\s*<[^<>]*>\s*:\s+(?P<value><[^<>]*>)")
_UNFINISHED_COLUMNS = re.compile(r"(\bwith|,)\s*\Z")
_JOINING = re.compile(r"(?:\s|//[^\n]*\n)*(?:and|or)\b")
_COMMENTS = re.compile(r"(?P<comment>//[^\n]*)|\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'")
_BRACKETS = re.compile(r"//[^\n]*|\"(?:\\.|[^\"\\\n])*\"?|'(?:\\.|[^'\\\n])*'?|(?P<open>[{(])|(?P<close>[})])")


@dataclass(frozen=True, slots=True)
class Repair:
    """A repaired text, which has the same length as the original. ``span`` is the part that was changed.

    ``text`` is the fix to offer for that part; ``None`` if the part was blanked. ``title`` describes the fix; empty if
    the text does. ``is_certain`` is true if no other repair is better, although this one has no text.
    """

    repaired: str
    span: Span
    text: str | None
    title: str = ""
    is_certain: bool = False


@dataclass(frozen=True, slots=True)
class Fault:
    """An error: where the parser stopped, the expected tokens and, if it is certain, the text that repairs it."""

    rejected: Rejected
    repair: Repair | None


@dataclass(frozen=True, slots=True)
class Recovered:
    """All errors found, the repaired text, and its parse result, which is ``None`` if no repair helped."""

    faults: tuple[Fault, ...]
    text: str
    parsed: Parsed | None


def recover(language: str, text: str, first: Rejected) -> Recovered:
    """Repair a rejected chunk. No text of a user raises an error."""
    faults: list[Fault] = []
    repaired, result, left, shadow = text, first, MAX_PARSES, -1
    while len(faults) < MAX_FAULTS:
        # An error in text that an earlier repair changed is the same error, or a consequence of it.
        if result.offset > shadow:
            faults.append(Fault(result, None))
            shadow = _word(repaired, result.offset).end
        step = _best(language, repaired, result, left)
        if step is None:
            break
        left -= step.parses
        if step.repair.text is not None and faults[-1].rejected is result:
            faults[-1] = Fault(result, step.repair)
        if isinstance(step.result, Parsed):
            return Recovered(tuple(faults), step.repair.repaired, step.result)
        repaired, result = step.repair.repaired, step.result
        if step.repair.text is None:
            behind = len(repaired) - len(repaired[step.repair.span.end :].lstrip())
            shadow = max(shadow, behind)
    return Recovered(tuple(faults), repaired, None)


@dataclass(frozen=True, slots=True)
class _Step:
    """The repair chosen for one error, the parse result after it, and the number of attempts."""

    repair: Repair
    result: Parsed | Rejected
    parses: int


def _best(language: str, text: str, stopped: Rejected, most: int) -> _Step | None:
    best: _Step | None = None
    furthest = stopped.offset
    own = _word(text, stopped.offset).end
    next_word = _word(text, own + len(text[own:]) - len(text[own:].lstrip())).end
    for parses, repair in enumerate(islice(_repairs(language, text, stopped), most), start=1):
        found = _parse(language, repair.repaired)
        # Repaired text beats blanked text, even if the parser then gets further by misreading the rest. An inserted
        # symbol needs more evidence than a keyword, because it may fit by chance.
        enough = next_word if repair.span.start == repair.span.end else own
        if isinstance(found, Parsed) or ((repair.is_certain or repair.text is not None) and found.offset > enough):
            return _Step(repair, found, parses)
        if found.offset > max(furthest, repair.span.end - 1):
            furthest = found.offset
            best = _Step(repair, found, 0)
        best = best and replace(best, parses=parses)
    return best


def _parse(language: str, text: str) -> Parsed | Rejected:
    """Parse a repaired chunk. Text after its end is an error; otherwise one extra bracket would repair everything."""
    found = parse_chunk(language, text)
    if isinstance(found, Parsed) and found.trailing is not None:
        return Rejected(found.trailing, Expectation(frozenset(), frozenset()))
    return found


def _repairs(language: str, text: str, stopped: Rejected) -> Iterator[Repair]:
    """Yield the repairs of one error, the most likely first."""
    offset = stopped.offset
    found = _word(text, offset)
    literals = sorted(stopped.expected.literals)
    yield from _parentheses(language, text, stopped)
    yield from _text_predicate(text, stopped)
    yield from _written_set(text, offset)
    name = name_of_group(text, stopped)
    if name is not None:
        yield replace(_blanked(text, name), is_certain=True)
    yield from _single_values(text, offset)
    yield from _typed_variable(text, offset)
    yield from _value_without_braces(text, offset)
    yield from _missing_column(text, stopped)
    yield from (repair for sign in literals if not sign[0].isalpha() for repair in _insertion(text, offset, sign))
    if any(rule == "NameText" or rule.endswith("Path") for rule in stopped.expected.rules):
        yield from _hole(text, offset)
    yield from (repair for word in literals if word[0].isalpha() for repair in _spelling(text, found, word))
    yield from _lines(text, offset, ((0, 0),))
    if found.end > found.start:
        yield _blanked(text, found)
    if ")" in literals:
        yield from _rest_of_brackets(text, offset)
    yield from _lines(text, offset, ((1, 0), (0, 1), (1, 1), (2, 0)))
    yield from _blocks(text, offset)


def _text_predicate(text: str, stopped: Rejected) -> Iterator[Repair]:
    """Replace a phrase that the catalog lacks by a text without content, so that the clause keeps its place."""
    found = unknown_phrase(text, stopped)
    if found is not None and found.may_be_text and found.whole.end - found.whole.start >= len(NOTHING):
        blank = NOTHING.ljust(found.whole.end - found.whole.start)
        repaired = text[: found.whole.start] + blank + text[found.whole.end :]
        yield Repair(repaired, found.words, None, is_certain=True)


def _written_set(text: str, offset: int) -> Iterator[Repair]:
    """Put the placeholder of a missing name in place of a set that is written out in a quantifier."""
    found = written_set(text, offset)
    if found is not None:
        blank = f"<{HOLE}>".ljust(found.span.end - found.span.start)
        if len(blank) == found.span.end - found.span.start:
            yield Repair(text[: found.span.start] + blank + text[found.span.end :], found.span, None, is_certain=True)


def _single_values(text: str, offset: int) -> Iterator[Repair]:
    """Read 'set var <v>: { … }' with single values as 'var <v>: { … }'."""
    found = _SET_OF_VALUES.search(text, max(0, offset - 200), offset)
    if found:
        yield _blanked(text, Span(*found.span("set")))


def _typed_variable(text: str, offset: int) -> Iterator[Repair]:
    """Leave out the type of a variable."""
    for found in _TYPE.finditer(text, max(0, offset - 200), offset + 200):
        if found.start("type") == offset:
            yield replace(_blanked(text, Span(*found.span("type"))), is_certain=True)


def _value_without_braces(text: str, offset: int) -> Iterator[Repair]:
    """Put the only value of a variable into braces."""
    for found in _VALUE.finditer(text, max(0, offset - 200), offset + 200):
        start, end = found.span("value")
        if start == offset and text[end : end + 1].isspace():
            repaired = f"{text[: start - 1]}{{{found['value']}}}{text[end + 1 :]}"
            yield Repair(repaired, Span(start, end), None, is_certain=True)


def _missing_column(text: str, stopped: Rejected) -> Iterator[Repair]:
    """Leave out 'with', or the comma after a column, where the name of a property is missing."""
    found = _UNFINISHED_COLUMNS.search(text, max(0, stopped.offset - 200), stopped.offset)
    if found and "ColumnNameText" in stopped.expected.rules:
        yield _blanked(text, Span(*found.span(1)))


def _parentheses(language: str, text: str, stopped: Rejected) -> Iterator[Repair]:
    """Put clauses joined by 'and' or 'or' into parentheses, unless both words occur, which would be ambiguous."""
    joined = joined_clauses(language, text, stopped)
    if joined is None or joined.end is None:
        return
    start, end = joined.start, joined.end
    around = text[start - 1 : start] + (text[end : end + 1] or " ")
    if around.isspace() and len(around) == 2 and not _JOINING.match(text, end):
        clauses = text[start:end]
        repaired = f"{text[: start - 1]}({clauses}){text[end + 1 :]}"
        yield Repair(repaired, Span(start, end), f"({clauses})", "Put the clauses into parentheses")


def _insertion(text: str, offset: int, sign: str) -> Iterator[Repair]:
    """Put a symbol into the white space before the error, or after the end of the text."""
    place = _behind_words(text, offset)
    room = text[place : place + len(sign)]
    if place == len(text):
        yield Repair(text + sign, Span(place, place), sign)
    elif room.isspace() and len(room) == len(sign):
        yield Repair(text[:place] + sign + text[place + len(sign) :], Span(place, place), sign)


def _behind_words(text: str, offset: int) -> int:
    """Return the end of the last word or symbol before ``offset``, but not in a comment.

    Text that is inserted after a comment would become a part of the comment.
    """
    found = (match for match in _COMMENTS.finditer(text, 0, offset) if match["comment"])
    comments = {match.start() + len(match[0].rstrip()): match.start() for match in found}
    place = len(text[:offset].rstrip())
    while place in comments:
        place = len(text[: comments[place]].rstrip())
    return place


def _hole(text: str, offset: int) -> Iterator[Repair]:
    """Put a placeholder for a missing name into the white space before the error."""
    place = _behind_words(text, offset)
    if not _continues(text, place - 1) and not (text[place:] and _continues(text, place + 1)):
        for repair in _insertion(text, offset, HOLE):
            yield Repair(repair.repaired, repair.span, None)


def _spelling(text: str, found: Span, keyword: str) -> Iterator[Repair]:
    """Write a keyword over a similar word, and over adjacent white space if the keyword is longer."""
    word = text[found.start : found.end]
    if not word or SequenceMatcher(None, word.lower(), keyword.lower()).ratio() < ALIKE:
        return
    start, end = found.start, found.end
    while end - start < len(keyword) and text[end : end + 1].isspace() and not _continues(text, end + 1):
        end += 1
    while end - start < len(keyword) and start > 0 and text[start - 1].isspace() and _may_end(text, start - 2):
        start -= 1
    if end - start >= len(keyword):
        yield Repair(text[:start] + keyword.ljust(end - start) + text[end:], found, keyword)


def _may_end(text: str, place: int) -> bool:
    """Return whether a word may follow ``place`` without white space. A number may be followed by its unit."""
    return not _continues(text, place) or text[place].isdigit()


def _continues(text: str, place: int) -> bool:
    """Return whether a word that ends at ``place`` would run into the character that follows."""
    letter = text[place : place + 1] if place >= 0 else ""
    return letter.isalnum() or letter in {"_", "-"}


def _lines(text: str, offset: int, windows: tuple[tuple[int, int], ...]) -> Iterator[Repair]:
    """Blank the line of the error, together with non-empty lines before and after it."""
    lines = [match.span() for match in re.finditer(r"[^\n]*\S[^\n]*", text)]
    own = next((index for index, (_, end) in enumerate(lines) if offset <= end), len(lines) - 1)
    # The first line holds the declaration's head, without which nothing can be parsed.
    for before, after in windows:
        if own - before > 0 and own + after < len(lines):
            yield _blanked(text, Span(lines[own - before][0], lines[own + after][1]))


def _rest_of_brackets(text: str, offset: int) -> Iterator[Repair]:
    """Blank the text from the error up to the closing bracket around it, as for 'or c' in '( a and b or c )'."""
    depth = 0
    for match in _BRACKETS.finditer(text, offset):
        if match["open"]:
            depth += 1
        elif match["close"] and depth:
            depth -= 1
        elif match["close"]:
            if match["close"] == ")":
                yield _blanked(text, Span(offset, match.start()))
            return


def _blocks(text: str, offset: int) -> Iterator[Repair]:
    """Blank brackets around the error with the line on which they open: innermost first, but never the outermost."""
    opened: list[int] = []
    around: list[tuple[int, int]] = []
    for match in _BRACKETS.finditer(text):
        if match["open"]:
            opened.append(match.start())
        elif match["close"] and opened:
            start = opened.pop()
            if start <= offset <= match.end() and opened:
                around.append((start, match.end()))
    for start, end in around:
        yield _blanked(text, Span(text.rfind("\n", 0, start) + 1, end))


def _blanked(text: str, span: Span) -> Repair:
    blank = re.sub(r"[^\n]", " ", text[span.start : span.end])
    return Repair(text[: span.start] + blank + text[span.end :], span, None)


def _word(text: str, offset: int) -> Span:
    end = offset
    while end < len(text) and (text[end].isalnum() or text[end] in "_-"):
        end += 1
    return Span(offset, end if end > offset else min(offset + 1, len(text)))
