"""Parse a user story scenario by scenario. After an edit inside a scenario, only this scenario is parsed again.

The text of the story is cut at its scenarios. The text around them is parsed with a placeholder for them, and each
scenario is parsed by itself. Both are cached by text. The result is the same as for the whole story at once, because no
scenario affects how another one is parsed. An error stays within its scenario.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import chain

from robbdd_tools.base.document import Span
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import Declaration, Placed, Symbol, SyntaxFault
from robbdd_tools.syntax.faults import last_token, trailing_fault
from robbdd_tools.syntax.move import InPlace, moved_fault, moved_node, moved_reference, moved_symbol
from robbdd_tools.syntax.piece import Piece, read_piece
from robbdd_tools.syntax.recover import HOLE
from robbdd_tools.syntax.salvage import salvage, salvage_scenario, with_lost
from robbdd_tools.syntax.story_cut import Cut, forget_scan
from robbdd_tools.syntax.symbols import references, symbols, variant_symbols

CACHED_FRAMES = 100
CACHED_LETTERS = 30_000
"""Scenarios stay cached up to this total number of characters, in addition to the story that was parsed last."""
STAND_IN = f"Scenario {HOLE}{{template:<{HOLE}>scene:<{HOLE}>variation:var<{HOLE}>:{{}}}}\n"
_WORD = "Scenario"
_NAMELESS = re.compile(rf"{_WORD}\s*{{")


@dataclass(frozen=True, slots=True)
class _Frame:
    """A story without its scenarios. It is parsed with a placeholder for them.

    ``head`` and ``tail`` are the parts of the story before and after the scenarios.
    """

    story: tree.Story | None
    symbols: tuple[Symbol, ...]
    faults: tuple[SyntaxFault, ...]
    head: Declaration
    tail: Declaration


Key = tuple[str, str, str | None]
"""Text, story and namespace."""


class _Kept:
    """Cached scenarios of the latest stories. Those of the latest story are all kept."""

    def __init__(self) -> None:
        self._latest: dict[Key, tuple[Placed, ...]] = {}
        self._older: dict[Key, tuple[Placed, ...]] = {}
        self._letters = 0

    def begin(self) -> None:
        """Begin a new story. Cached scenarios that it does not use may be removed."""
        if self._letters > CACHED_LETTERS:
            self._older, self._latest, self._letters = self._latest, {}, 0

    def get(self, key: Key) -> tuple[Placed, ...]:
        """Return a parsed scenario from the cache, or parse it."""
        found = self._latest.get(key)
        if found is None:
            found = self._older.get(key)
            self._latest[key] = found = _scenarios(key) if found is None else found
            self._letters += len(key[0])
        return found

    def clear(self) -> None:
        """Clear the cache."""
        self.__init__()


_kept = _Kept()


def forget_scenarios() -> None:
    """Clear the cache of scenarios."""
    _kept.clear()
    forget_scan()


def read_story(cut: Cut) -> Declaration:
    """Return the declaration of a story. Only scenarios whose text is new are parsed."""
    _kept.begin()
    frame = _frame(cut.head, cut.tail)
    own = tuple(replace(symbol, extent=_stretched(symbol.extent, cut)) for symbol in frame.symbols)
    path, namespace = (own[0].path, own[0].namespace) if own else ("", None)
    scenarios = [
        Placed(part.declaration, start + part.offset)
        for start, text in cut.scenarios()
        for part in _kept.get((text, path, namespace))
    ]
    outside = (_outside(fault, cut) for fault in frame.faults)
    inside = (moved_fault(fault, part.offset) for part in scenarios for fault in part.declaration.faults)
    story = frame.story
    if story is not None:
        story = replace(story, span=_stretched(story.span, cut), variants=_variants(scenarios))
    every = (Placed(frame.head, 0), *scenarios, Placed(frame.tail, cut.end))
    declared = ((part.offset, part.declaration.symbols) for part in scenarios)
    used = ((part.offset, part.declaration.references) for part in every)
    return Declaration(
        cut.text,
        story,
        InPlace([(0, own), *declared], moved_symbol),
        InPlace(used, moved_reference),
        tuple(sorted(chain(outside, inside), key=lambda fault: fault.span)),
        every,
    )


def _variants(scenarios: Iterable[Placed]) -> InPlace[tree.Variant]:
    trees = ((part.offset, part.declaration.tree) for part in scenarios)
    return InPlace(((offset, (root,)) for offset, root in trees if isinstance(root, tree.Variant)), moved_node)


@lru_cache(maxsize=CACHED_FRAMES)
def _frame(head: str, tail: str) -> _Frame:
    text = head + STAND_IN + tail
    piece = read_piece("bdd", text)
    faults = piece.faults if piece.trailing is None else (*piece.faults, trailing_fault("bdd", text, piece.trailing))
    story = replace(piece.tree, variants=()) if isinstance(piece.tree, tree.Story) else None
    known = () if story is None else tuple(symbol for symbol in symbols(story) if symbol.name != HOLE)
    known = known or salvage(head)[:1]
    used = () if story is None else references(story)
    own = tuple(replace(symbol, extent=Span(symbol.extent.start, len(head))) for symbol in known)
    return _Frame(story, known, faults, Declaration(head, None, own, used, ()), Declaration(tail, None, (), (), ()))


def _outside(fault: SyntaxFault, cut: Cut) -> SyntaxFault:
    """Move a fault of a story's frame to its place in the whole story."""
    start = _unframed(fault.span.start, cut)
    span = Span(start, start + fault.span.end - fault.span.start)
    if fault.span.start == len(cut.head):
        span = Span(start, start + len(_WORD))
    elif len(cut.head) < fault.span.start < len(cut.head) + len(STAND_IN):
        # Only the end of the story can be missing after the placeholder.
        span = last_token(cut.text)
    fix = fault.fix
    if fix is not None:
        place = Span(_unframed(fix.span.start, cut), _unframed(fix.span.end, cut))
        fix = replace(fix, span=place)
    return SyntaxFault(span, fault.message, fix)


def _stretched(span: Span, cut: Cut) -> Span:
    return Span(span.start, _unframed(span.end, cut))


def _unframed(offset: int, cut: Cut) -> int:
    """Map an offset in a story's frame to the whole story."""
    behind = len(cut.head) + len(STAND_IN)
    if offset <= len(cut.head):
        return offset
    return cut.end if offset < behind else offset - behind + cut.end


def _scenarios(key: Key) -> tuple[Placed, ...]:
    """Parse a text that starts with a scenario. After its end, the text may contain another scenario."""
    text, path, namespace = key
    found: list[Placed] = []
    start = 0
    while True:
        rest = text[start:]
        piece = _read_scenario(rest)
        faults = (trailing_fault("bdd", rest, 0),) if piece.tree is None and found else piece.faults
        own = rest[: piece.trailing]
        found.append(Placed(_scenario(piece.tree, own, faults, path, namespace), start))
        if piece.trailing is None:
            return tuple(found)
        start += piece.trailing


def _read_scenario(text: str) -> Piece:
    """Parse a text that starts with a scenario. If its name is not typed yet, a placeholder replaces it."""
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
