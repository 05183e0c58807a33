"""Reads a user story scenario by scenario, so that an edit inside one parses that one only, however long the story is.

The story's text is cut at its scenarios. What stands around them is parsed with a stand-in in their place, and each
scenario by itself; both are kept by their texts. The result is that of parsing the whole, for nothing in a scenario
tells how another one is to be read; and an error costs no more than its own scenario.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import chain, pairwise
from typing import Generic, TypeVar

from robbdd_tools.base.document import Span
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import Declaration, Placed, Reference, Symbol, SyntaxFault, SyntaxFix
from robbdd_tools.syntax.faults import last_token, trailing_fault
from robbdd_tools.syntax.move import moved_fault, moved_node, moved_reference, moved_symbol
from robbdd_tools.syntax.piece import Piece, read_piece
from robbdd_tools.syntax.recover import HOLE
from robbdd_tools.syntax.salvage import salvage, salvage_scenario, with_lost
from robbdd_tools.syntax.symbols import references, symbols, variant_symbols

KEPT_FRAMES = 1000
KEPT_LETTERS = 500_000
"""Letters of scenarios that are kept beside those of the story that was read last, however long that is."""
STAND_IN = f"Scenario {HOLE}{{template:<{HOLE}>scene:<{HOLE}>variation:var<{HOLE}>:{{}}}}\n"
_NAME = r"[^\W\d][\w\-]*"
_STRING = r"\"(?:\\.|[^\"\\\n])*\"?|'(?:\\.|[^'\\\n])*'?"
_SCANNER = re.compile(
    rf"(?=[/\"'{{}}S])(?://[^\n]*|{_STRING}|(?P<open>{{)|(?P<close>}})"
    rf"|(?<![\w\-.<])(?P<scenario>Scenario(?![\w\-])(?P<header>(?:\s+Variant(?=\s+{_NAME}))?\s+{_NAME}\s*{{)?))"
)
_LONG_STRINGS = re.compile(r"//[^\n]*|\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'")
_HEADER_LINE = re.compile(rf"\n\s*Scenario\s+{_NAME}[^\n]*{{")
_WORD = "Scenario"
_NAMELESS = re.compile(rf"{_WORD}\s*{{")
_STORY = re.compile(r"User\s+Story\b")


@dataclass(frozen=True, slots=True)
class Cut:
    """A story's text in parts: where its scenarios begin, and where what closes the story begins."""

    text: str
    starts: tuple[int, ...]
    end: int

    @property
    def head(self) -> str:
        """The text before the first scenario."""
        return self.text[: self.starts[0]]

    @property
    def tail(self) -> str:
        """The text behind the last scenario."""
        return self.text[self.end :]

    def scenarios(self) -> Iterator[tuple[int, str]]:
        """Yield each scenario's offset and text, with what stands between it and the next."""
        return ((start, self.text[start:end]) for start, end in pairwise((*self.starts, self.end)))


def cut_story(text: str) -> Cut | None:
    """Return where a story's scenarios are, ``None`` for the text of anything but a story with scenarios.

    A scenario begins at its word directly inside the story's braces or, with its name and brace, at the beginning of
    a line wherever that line is: a missing brace then costs one scenario.
    """
    if not _STORY.match(text):
        return None
    starts: list[int] = []
    depth, end = 0, None
    for match in _SCANNER.finditer(text):
        if match["open"]:
            depth += 1
        elif match["close"]:
            depth -= 1
            if depth == 0 and end is None:
                end = match.start()
        elif match["scenario"] and (depth == 1 or (match["header"] and _starts_line(text, match.start()))):
            starts.append(match.start())
            depth, end = (2 if match["header"] else 1), None
    if not starts:
        return None
    return Cut(text, tuple(starts), _closing_line(text, starts[-1]) if end is None else end)


def quotes_scenario(text: str) -> bool:
    """Tell whether a string of several lines holds what would otherwise begin a scenario, which ``cut_story`` misses.

    A quote that is not closed, as while one types, looks like that as well.
    """
    return any("\n" in match[0] and _HEADER_LINE.search(match[0]) for match in _LONG_STRINGS.finditer(text))


def without_earlier_scenarios(text: str) -> str:
    """Return the text of a story that ends at a cursor without the scenarios before the one at the cursor."""
    cut = cut_story(text)
    return text if cut is None else cut.head + text[cut.starts[-1] :]


def _starts_line(text: str, offset: int) -> bool:
    """Tell whether only white space stands before a place in its line."""
    return not text[text.rfind("\n", 0, offset) + 1 : offset].strip()


def _closing_line(text: str, start: int) -> int:
    """Return where a story with too few braces is closed: at a brace further left than its last scenario."""
    if _starts_line(text, start):
        column = start - text.rfind("\n", 0, start) - 1
        for line in re.finditer(r"^([ \t]*)}", text[start:], re.MULTILINE):
            if len(line[1]) < column:
                return start + line.end() - 1
    return len(text)


@dataclass(frozen=True, slots=True)
class _Frame:
    """What a story says around its scenarios, with spans in a text where a stand-in has their place.

    ``head`` and ``tail`` are the parts of the story before and behind them.
    """

    story: tree.Story | None
    symbols: tuple[Symbol, ...]
    references: tuple[Reference, ...]
    faults: tuple[SyntaxFault, ...]
    head: Declaration
    tail: Declaration


@dataclass(frozen=True, slots=True)
class _Moved:
    """What one scenario says, at its place in the story; ``variant`` is ``None`` where it cannot be told."""

    variant: tree.Variant | None
    symbols: tuple[Symbol, ...]
    references: tuple[Reference, ...]
    faults: tuple[SyntaxFault, ...]


Key = tuple[str, str, str | None]
"""Text, story and namespace."""
KeyInPlace = tuple[str, Key, int]
"""The text once more, and where it stands in its story."""
_AnyKey = TypeVar("_AnyKey", Key, KeyInPlace)
_Read = TypeVar("_Read")


class _Kept(Generic[_AnyKey, _Read]):
    """Scenarios as they were read: those of the latest stories, never only a part of the latest one."""

    def __init__(self, read: Callable[[_AnyKey], tuple[_Read, ...]]) -> None:
        self._read = read
        self._latest: dict[_AnyKey, tuple[_Read, ...]] = {}
        self._older: dict[_AnyKey, tuple[_Read, ...]] = {}
        self._letters = 0

    def begin(self) -> None:
        """Begin to read a story: what it does not use may be forgotten."""
        if self._letters > KEPT_LETTERS:
            self._older, self._latest, self._letters = self._latest, {}, 0

    def get(self, key: _AnyKey) -> tuple[_Read, ...]:
        """Return what was read before, else read it."""
        found = self._latest.get(key)
        if found is None:
            found = self._older.get(key)
            self._latest[key] = found = self._read(key) if found is None else found
            self._letters += len(key[0])
        return found


def read_story(cut: Cut) -> Declaration:
    """Return the declaration of a story, of which only scenarios with a new text are parsed."""
    _kept.begin()
    _kept_in_place.begin()
    frame = _frame(cut.head, cut.tail)
    own = [replace(symbol, extent=_stretched(symbol.extent, cut)) for symbol in frame.symbols]
    path, namespace = (own[0].path, own[0].namespace) if own else ("", None)
    keys = [((text, path, namespace), start) for start, text in cut.scenarios()]
    parts = (Placed(part.declaration, start + part.offset) for key, start in keys for part in _kept.get(key))
    found = [moved for key, start in keys for moved in _kept_in_place.get((key[0], key, start))]
    outside = (_outside(fault, cut) for fault in frame.faults)
    faults = sorted(chain(outside, *(one.faults for one in found)), key=lambda fault: fault.span)
    story = frame.story
    if story is not None:
        variants = tuple(one.variant for one in found if one.variant is not None)
        story = replace(story, span=_stretched(story.span, cut), variants=variants)
    return Declaration(
        cut.text,
        story,
        tuple(chain(own, *(one.symbols for one in found))),
        tuple(chain(frame.references, *(one.references for one in found))),
        tuple(faults),
        (Placed(frame.head, 0), *parts, Placed(frame.tail, cut.end)),
    )


@lru_cache(maxsize=KEPT_FRAMES)
def _frame(head: str, tail: str) -> _Frame:
    text = head + STAND_IN + tail
    piece = read_piece("bdd", text)
    faults = piece.faults if piece.trailing is None else (*piece.faults, trailing_fault(text, piece.trailing))
    story = replace(piece.tree, variants=()) if isinstance(piece.tree, tree.Story) else None
    known = () if story is None else tuple(symbol for symbol in symbols(story) if symbol.name != HOLE)
    known = known or salvage(head)[:1]
    used = () if story is None else references(story)
    own = tuple(replace(symbol, extent=Span(symbol.extent.start, len(head))) for symbol in known)
    return _Frame(
        story, known, used, faults, Declaration(head, None, own, used, ()), Declaration(tail, None, (), (), ())
    )


def _outside(fault: SyntaxFault, cut: Cut) -> SyntaxFault:
    """Return a fault of a frame at its place in the whole story."""
    start = _unframed(fault.span.start, cut)
    span = Span(start, start + fault.span.end - fault.span.start)
    if fault.span.start == len(cut.head):
        span = Span(start, start + len(_WORD))
    elif len(cut.head) < fault.span.start < len(cut.head) + len(STAND_IN):
        # Nothing but the end of the story is missed behind the stand-in.
        span = last_token(cut.text)
    fix = fault.fix
    if fix is not None:
        place = Span(_unframed(fix.span.start, cut), _unframed(fix.span.end, cut))
        fix = SyntaxFix(place, fix.text)
    return SyntaxFault(span, fault.message, fix)


def _stretched(span: Span, cut: Cut) -> Span:
    return Span(span.start, _unframed(span.end, cut))


def _unframed(offset: int, cut: Cut) -> int:
    """Return the place in the whole story of a place in its frame."""
    behind = len(cut.head) + len(STAND_IN)
    if offset <= len(cut.head):
        return offset
    return cut.end if offset < behind else offset - behind + cut.end


def _moved(place: KeyInPlace) -> tuple[_Moved, ...]:
    _, key, start = place
    return tuple(
        _Moved(
            moved_node(part.declaration.tree, start + part.offset),
            tuple(moved_symbol(symbol, start + part.offset) for symbol in part.declaration.symbols),
            tuple(moved_reference(reference, start + part.offset) for reference in part.declaration.references),
            tuple(moved_fault(fault, start + part.offset) for fault in part.declaration.faults),
        )
        for part in _kept.get(key)
    )


def _scenarios(key: Key) -> tuple[Placed, ...]:
    """Return what a text says that begins with a scenario; what stands behind its end may be another one."""
    text, path, namespace = key
    found: list[Placed] = []
    start = 0
    while True:
        rest = text[start:]
        piece = _read_scenario(rest)
        faults = (trailing_fault(rest, 0),) if piece.tree is None and found else piece.faults
        own = rest[: piece.trailing]
        found.append(Placed(_scenario(piece.tree, own, faults, path, namespace), start))
        if piece.trailing is None:
            return tuple(found)
        start += piece.trailing


_kept = _Kept[Key, Placed](_scenarios)
_kept_in_place = _Kept[KeyInPlace, _Moved](_moved)


def _read_scenario(text: str) -> Piece:
    """Parse a text that begins with a scenario; one whose name is still to be typed is read with a stand-in for it."""
    nameless = _NAMELESS.match(text)
    if nameless is None:
        return read_piece("scenario", text)
    by = -len(HOLE) - 1
    piece = read_piece("scenario", f"{_WORD} {HOLE}{text[len(_WORD) :]}")
    fault = SyntaxFault(Span(nameless.end() - 1, nameless.end()), "unexpected '{': expected a name")
    variant: tree.Variant | None = moved_node(piece.tree, by)
    if variant is not None:
        variant = replace(variant, span=Span(0, variant.span.end))
    trailing = None if piece.trailing is None else piece.trailing + by
    return Piece(variant, (fault, *(moved_fault(fault, by) for fault in piece.faults)), trailing)


def _scenario(
    variant: tree.Variant | None, text: str, faults: tuple[SyntaxFault, ...], path: str, namespace: str | None
) -> Declaration:
    declared = variant_symbols(variant, path, namespace) if variant is not None and path else ()
    if faults and path:
        declared = with_lost(declared, salvage_scenario(text, path, namespace))
    used = references(variant, (path,)) if variant is not None else ()
    return Declaration(text, variant, declared, used, faults)
