"""Words that other packages add by entry points. A faulty word is left out, so that models without it still work."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from importlib.metadata import EntryPoint

from robbdd_tools.catalog.api import Behaviour, ObjectModel, Predicate, RobotModel
from robbdd_tools.catalog.term_prefixes import PREFIXES

GROUP = "robbdd_tools.catalog"
Word = Predicate | Behaviour | ObjectModel | RobotModel
_KINDS = "a Predicate, Behaviour, ObjectModel or RobotModel"
_IN_PHRASE = re.compile(r"<(\w+)>|[$#](\w+)")
_IN_SENTENCE = re.compile(r"\{(\w+)\}")


class _Fault(Exception):
    """A word cannot be used; the message gives the reason."""


def foreign_words(
    entries: Iterable[EntryPoint], own: Iterable[tuple[str, Word]]
) -> tuple[list[tuple[str, Word]], list[str]]:
    """Return the words of entry points with their origins, and a message for each word that is left out.

    ``own`` are the words of this package with their origins. They take precedence over words with equal names or
    phrases.
    """
    taken, found, problems = list(own), list[tuple[str, Word]](), list[str]()
    for entry in sorted(entries, key=lambda entry: (entry.name, entry.value)):
        try:
            word = _loaded(entry)
            _check_name(word, taken)
            if isinstance(word, Predicate | Behaviour):
                _check_phrases(word, taken)
                _check_terms(word)
        except _Fault as fault:
            package = "a package" if entry.dist is None else f"{entry.dist.name} {entry.dist.version}"
            problems.append(f"the word '{entry.name}' of {package} is left out: {fault}")
        else:
            taken.append((entry.value, word))
            found.append((entry.value, word))
    return found, problems


def _loaded(entry: EntryPoint) -> Word:
    try:
        word: object = entry.load()
    except (Exception, SystemExit) as error:  # the code of another package may do anything
        raise _Fault(f"{entry.value} cannot be loaded: {type(error).__name__}: {error}") from error
    if not isinstance(word, Word):
        raise _Fault(f"{entry.value} is not {_KINDS}")
    return word


def _check_name(word: Word, taken: Sequence[tuple[str, Word]]) -> None:
    for origin, other in taken:
        if type(other) is type(word) and other.name == word.name:
            raise _Fault(f"'{word.name}' is the name of a word in {origin}")


def _check_phrases(word: Predicate | Behaviour, taken: Sequence[tuple[str, Word]]) -> None:
    slots = sorted(slot.name for slot in word.slots)
    for phrase in (word.phrase, *word.aliases):
        if sorted(name or other for name, other in _IN_PHRASE.findall(phrase)) != slots:
            raise _Fault(f"the phrase '{phrase}' must have each of its slots once: {', '.join(slots)}")
        for origin, other in taken:
            if isinstance(other, type(word)) and _outline(phrase) in map(_outline, (other.phrase, *other.aliases)):
                raise _Fault(f"the phrase '{phrase}' is that of '{other.name}' in {origin}")
    if sorted(_IN_SENTENCE.findall(word.sentence)) != slots:
        raise _Fault(f"the sentence '{word.sentence}' must have each slot once, in braces: {', '.join(slots)}")


def _check_terms(word: Predicate | Behaviour) -> None:
    types = (word.rdf_type,) if isinstance(word, Predicate) else word.rdf_types
    for term in (*types, *(slot.property for slot in word.slots)):
        prefix, _, local = term.partition(":")
        if not local.startswith("//") and prefix not in PREFIXES:
            raise _Fault(f"'{term}' must be an IRI, or have a prefix of {', '.join(PREFIXES)}")


def _outline(phrase: str) -> str:
    """Return a phrase without the names of its slots."""
    return _IN_PHRASE.sub("_", phrase)
