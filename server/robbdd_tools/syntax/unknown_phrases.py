"""Find the catalog phrases that are nearest to an unknown phrase. Synonyms of their words count, too."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from functools import cache
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.syntax.declaration import SyntaxFault, SyntaxFix

if TYPE_CHECKING:
    from robbdd_tools.syntax.parsed import Rejected

MAX_NEAREST = 3
"""Maximum number of phrases that a message lists."""
NEAR = 0.6
"""Minimum similarity ratio of a listed phrase."""
_SYNONYM = 0.75
"""Similarity of a phrase that is found by a synonym. A phrase with a spelling mistake is nearer."""
_SAME_SLOTS = 0.1
"""This is added to the similarity of a phrase that has the same kinds of slots in the same order."""
LONGEST = 300
"""Maximum number of characters between ``holds(`` and an error."""
_WHOLE_WORD = r"(?<![\w\-]){}(?![\w\-])"
_BEGIN = re.compile(rf"holds\s*\(|{_WHOLE_WORD.format('whenever')}|{_WHOLE_WORD.format('and')}")
_WRITTEN = re.compile(r"[^,()\n\"]*")
_SUBJECT = re.compile(r"\s*(?P<subject><[^<>\n]*>)\s*")
_REST = re.compile(rf"[^,()\n]*?(?=\s*(?:,|\)|\n|\Z|{_WHOLE_WORD.format('whenever')}))")
_UNIT = r"(?:m/s|deg/s|deg|rad|mm|cm|ms|kg|g|m|s|N|%)?(?![\w\-/])"
_PIECE = re.compile(rf"(?P<slot><[^<>\n]*>)|(?P<amount>[-+]?[\d.]+\s*{_UNIT})|(?P<word>[\w\-']+)")
_OF_PHRASE = re.compile(r"(?P<slot><\w+>)|[#](?P<amount>\w+)|[$](?P<name>\w+)|(?P<word>\w+)")

_AMOUNT = re.compile(r"[#$](\w+)")


@dataclass(frozen=True, slots=True)
class UnknownPhrase:
    """A phrase in a clause that the catalog does not contain.

    ``whole`` is its place including its subject, and ``words`` is its place without the subject. ``nearest`` are the
    phrases that it may mean, the most likely first. ``fix`` is the text that replaces ``words``, if it is certain where
    the values belong.
    ``may_be_text`` is true if the grammar accepts a text predicate at its place.
    """

    whole: Span
    words: Span
    nearest: tuple[str, ...]
    fix: str | None
    may_be_text: bool


def unknown_phrase(text: str, rejected: Rejected) -> UnknownPhrase | None:
    """Return the unknown phrase in which the parser stopped, or ``None`` if it stopped elsewhere."""
    offset, expected = rejected.offset, rejected.expected.literals
    if not _is_in_phrase(expected) or not text[offset : offset + 1].isalpha():
        return None
    begin = list(_BEGIN.finditer(text, max(0, offset - LONGEST), offset))[-1:]
    if not begin or not _WRITTEN.fullmatch(text, begin[0].end(), offset):
        return None
    start = begin[0].end()
    rest = _REST.match(text, offset)
    end = offset if rest is None else rest.end()
    subject = _SUBJECT.match(text, start, end)
    if subject is None or subject.end() > offset:
        return None
    words = Span(subject.end(), end)
    nearest = nearest_phrases(text[words.start : words.end], _phrases())
    fix = next((fix for _, fix in nearest[:1] if fix), None)
    whole = Span(subject.start("subject"), end)
    may_be_text = begin[0][0].startswith("holds")
    return UnknownPhrase(whole, words, tuple(phrase for phrase, _ in nearest), fix, may_be_text)


def phrase_fault(text: str, rejected: Rejected) -> SyntaxFault | None:
    """Return the fault of an unknown phrase, or ``None`` if the parser stopped elsewhere."""
    found = unknown_phrase(text, rejected)
    if found is None:
        return None
    written = " ".join(text[found.words.start : found.words.end].split())
    listed = ", ".join(f"'{phrase}'" for phrase in found.nearest)
    message = f"there is no phrase '{written}': " + (
        f"the nearest {'are' if len(found.nearest) > 1 else 'is'} {listed}"
        if listed
        else "define it by 'Predicate (ns=…) <a> my-phrase <b>: ( … )', or write 'pred(\"{x} …\", x=<variable>)'"
    )
    fix = None if found.fix is None else SyntaxFix(found.words, found.fix, f"Change to '{found.fix}'")
    return SyntaxFault(found.words, message, fix)


def _is_in_phrase(expected: frozenset[str]) -> bool:
    """Return whether the parser expects words of phrases, but neither a value nor the end of a phrase."""
    return not expected.isdisjoint(_words_of_catalog()) and expected.isdisjoint({",", "<", "holds"})


@cache
def _words_of_catalog() -> frozenset[str]:
    phrases = (phrase for phrase, _ in _phrases())
    return frozenset(match["word"] for phrase in phrases for match in _OF_PHRASE.finditer(phrase) if match["word"])


@cache
def _phrases() -> tuple[tuple[str, tuple[str, ...]], ...]:
    """Return the phrases of predicates that begin with a subject, each with its synonyms."""
    every = ((one, word) for word in load_catalog().predicates.values() for one in (word.phrase, *word.aliases))
    return tuple((phrase, tuple(map(str, word.synonyms))) for phrase, word in every if phrase.startswith("<"))


def nearest_phrases(written: str, phrases: Sequence[tuple[str, tuple[str, ...]]]) -> list[tuple[str, str | None]]:
    """Return the nearest of some phrases, each with the text that replaces the written one if the values fit.

    ``written`` is the text after the subject. Each phrase comes with its synonyms.
    """
    pieces = list(_PIECE.finditer(written))
    words = " ".join(piece["word"] for piece in pieces if piece["word"]).lower()
    values = [(piece.lastgroup or "", piece[0]) for piece in pieces if not piece["word"]]
    ranked: list[tuple[float, str, str | None]] = []
    for phrase, synonyms in phrases:
        own = list(_OF_PHRASE.finditer(phrase))[1:]
        ratio = SequenceMatcher(None, words, " ".join(one["word"] for one in own if one["word"])).ratio()
        said = max((len(one) for one in synonyms if re.search(rf"(?<!\w){re.escape(one)}(?!\w)", words)), default=0)
        fits = [one.lastgroup for one in own if not one["word"]] == [kind for kind, _ in values]
        score = max(ratio, _SYNONYM + said / 1000 if said else 0.0) + (_SAME_SLOTS if fits else 0.0)
        if score >= NEAR:
            # With another verb, such as 'grips' for 'is held by', the subject may be another one, too.
            certain = fits and (ratio >= NEAR or words.partition(" ")[0] == own[0]["word"])
            ranked.append((-score, _AMOUNT.sub(r"<\1>", phrase), _filled(own, values) if certain else None))
    return [(phrase, fix) for _, phrase, fix in sorted(ranked)[:MAX_NEAREST]]


def _filled(own: list[re.Match[str]], values: list[tuple[str, str]]) -> str:
    left: Iterator[str] = (value for _, value in values)
    return " ".join(one["word"] or next(left) for one in own)
