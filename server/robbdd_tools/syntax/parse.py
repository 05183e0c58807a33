"""Parse the text of a chunk into a ``Declaration``, which is cached by its text. No other module parses chunks."""

from __future__ import annotations

from collections import OrderedDict
from weakref import WeakValueDictionary

from robbdd_tools.syntax.declaration import Declaration
from robbdd_tools.syntax.faults import trailing_fault
from robbdd_tools.syntax.piece import read_piece
from robbdd_tools.syntax.salvage import salvage, with_lost
from robbdd_tools.syntax.split import forget_scans
from robbdd_tools.syntax.story import forget_scenarios, read_story
from robbdd_tools.syntax.story_cut import cut_story, quotes_cuts
from robbdd_tools.syntax.symbols import references, symbols

CACHED_LETTERS = 100_000
"""Unused declarations stay cached up to this number of characters in total, each of which takes about 100 bytes."""
LANGUAGES = ("bdd", "scene", "scenex", "ktree", "bddx")


class _Kept:
    """Cached declarations by language and text: all that are in use, and the latest unused ones (for undo)."""

    def __init__(self) -> None:
        self._in_use: WeakValueDictionary[tuple[str, str], Declaration] = WeakValueDictionary()
        self._latest: OrderedDict[tuple[str, str], Declaration] = OrderedDict()
        self._letters = 0

    def get(self, key: tuple[str, str]) -> Declaration | None:
        return self._in_use.get(key)

    def put(self, key: tuple[str, str], declaration: Declaration) -> None:
        self._in_use[key] = self._latest[key] = declaration
        self._letters += len(declaration.text)
        while self._letters > CACHED_LETTERS and len(self._latest) > 1:
            _, oldest = self._latest.popitem(last=False)
            self._letters -= len(oldest.text)

    def clear(self) -> None:
        self.__init__()


_kept = _Kept()


def parse_declaration(language: str, text: str) -> Declaration:
    """Parse one chunk. A broken chunk raises no error; its declaration has its faults and the names found in it."""
    key = (language, text)
    found = _kept.get(key)
    if found is None:
        found = _parsed(language, text)
        _kept.put(key, found)
    return found


def forget_declarations() -> None:
    """Clear the cache of declarations."""
    _kept.clear()
    forget_scenarios()
    forget_scans()


def _parsed(language: str, text: str) -> Declaration:
    cut = cut_story(text) if language == "bdd" else None
    if cut is None:
        return _whole(language, text)
    found = read_story(cut)
    if found.faults and quotes_cuts(text):
        whole = _whole(language, text)
        return found if whole.faults else whole
    return found


def _whole(language: str, text: str) -> Declaration:
    piece = read_piece(language, text)
    if piece.tree is None:
        return Declaration(text, None, salvage(text), (), piece.faults)
    declared = symbols(piece.tree)
    if piece.faults:
        declared = with_lost(declared, salvage(text))
    faults = piece.faults if piece.trailing is None else (*piece.faults, trailing_fault(language, text, piece.trailing))
    return Declaration(text, piece.tree, declared, references(piece.tree), faults)
