"""Find the names in a chunk without syntax errors, many times as fast as by parsing it.

The grammar is compiled into regular expressions that match the same texts as the parser. Only recursive rules and
repetitions of names become functions, each of which combines a few expressions. No objects are created.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field
from functools import cache
from itertools import groupby

from robbdd_tools.syntax import grammar
from robbdd_tools.syntax.grammar_files import ROOTS, grammar_text
from robbdd_tools.syntax.peg import BLANK, literal_pattern

NAME = "Name"
"""The grammar rule of the names that a declaration declares."""
GENERATING = frozenset({"BareBehaviour", "BareFluent", "SimilarSet", "Subject", "UnnamedFluent"})
"""Rules of declarations that also declare names that their text does not contain or has before their own name."""
_GROUP = re.compile(r"(?<!\\)\((?!\?)")


@dataclass(slots=True)
class _State:
    """The text that is matched, the names found so far, and the ends of recursive rules by rule and position."""

    text: str
    names: list[str] = field(default_factory=list[str])
    ends: dict[tuple[str, int], int] = field(default_factory=dict[tuple[str, int], int])


@dataclass(frozen=True, slots=True)
class _Pattern:
    """A regular expression without backtracking: its first match is final. Its groups are names."""

    text: str
    has_names: bool = False


Match = Callable[[_State, int], int]
"""Returns the position after the matched text, or -1."""
Piece = _Pattern | Match
"""A part of a sequence."""
_BLANKS = _Pattern(f"(?>{BLANK})")


class _Generated(Exception):
    """The text declares names by a ``GENERATING`` rule."""


def sound_names(language: str, text: str) -> tuple[str, ...] | None:
    """Return the words of the names in a chunk: first the name of its declaration, then the names of its parts.

    Returns ``None`` if the chunk may have a syntax error, or names that its text does not contain. A few words that
    declare nothing may be among the others.
    """
    try:
        match = _matcher(language)
    except grammar.GrammarError:
        return None
    state = _State(text)
    try:
        end = match(state, 0)
    except (_Generated, RecursionError):
        return None
    return tuple(dict.fromkeys(state.names)) if end == len(text) else None


@cache
def _matcher(language: str) -> Match:
    """Return the function that matches a whole chunk, with the white space at its end."""
    rules = grammar.read_grammar(grammar_text(language))
    root = rules[ROOTS.get(language) or next(iter(rules))]
    # The second part of a chunk is text after the declaration, which is an error.
    assert isinstance(root, grammar.Sequence)
    return _joined([*_Compiler(rules).pieces(root.parts[0]), _BLANKS])


class _Compiler:
    """Compiles the rules of a grammar."""

    def __init__(self, rules: Mapping[str, grammar.Expression]) -> None:
        self._rules = rules
        uses = {name: frozenset(_uses(body)) for name, body in rules.items()}
        self._recursive = {name for name in rules if name in _reached(name, uses)}
        self._made: dict[str, Match] = {}

    def pieces(self, expression: grammar.Expression) -> list[Piece]:
        """Return the sequence of pieces that matches an expression."""
        match expression:
            case grammar.Literal(text):
                return [_BLANKS, _Pattern(literal_pattern(text))]
            case grammar.Pattern(pattern):
                return [_BLANKS, _Pattern(f"(?>{_GROUP.sub('(?:', pattern)})")]
            case grammar.Use(rule):
                return self._use(rule)
            case grammar.Sequence(parts):
                return [piece for part in parts for piece in self.pieces(part)]
            case grammar.Choice(options):
                return [_choice([self.pieces(option) for option in options])]
            case grammar.Optional(part):
                return [_optional(self.pieces(part))]
            case grammar.Assignment(_, operator, value, separator):
                one = self.pieces(value)
                if operator == "=":
                    return one
                if operator == "?=":
                    return [_optional(one)]
                between = [] if separator is None else self.pieces(separator)
                several = [*one, _repeated([*between, *one])]
                return several if operator == "+=" else [_optional(several)]

    def _use(self, rule: str) -> list[Piece]:
        if rule in self._recursive:
            return [self._function(rule)]
        pieces = self.pieces(self._rules[rule])
        if rule == NAME:
            return [_BLANKS, _Pattern(f"({_text(pieces[1:])})", has_names=True)]
        return [_refused(_joined(pieces))] if rule in GENERATING else pieces

    def _function(self, rule: str) -> Match:
        """Return the function of a recursive rule. It can be used before the rule is compiled."""
        made = self._made

        def match(state: _State, position: int) -> int:
            key = (rule, position)
            end = state.ends.get(key)
            if end is None:
                if rule not in made:
                    made[rule] = _joined(self.pieces(self._rules[rule]))
                end = state.ends[key] = made[rule](state, position)
            return end

        return match


def _uses(expression: grammar.Expression) -> Iterator[str]:
    match expression:
        case grammar.Use(rule):
            yield rule
        case grammar.Sequence(parts) | grammar.Choice(parts):
            for part in parts:
                yield from _uses(part)
        case grammar.Optional(part):
            yield from _uses(part)
        case grammar.Assignment(value=value):
            yield from _uses(value)
        case _:
            pass


def _reached(rule: str, uses: Mapping[str, Set[str]]) -> set[str]:
    """Return the rules that a rule uses, directly or indirectly."""
    found: set[str] = set()
    waiting = [rule]
    while waiting:
        fresh = uses[waiting.pop()] - found
        found |= fresh
        waiting += fresh
    return found


def _joined(pieces: Sequence[Piece]) -> Match:
    """Return the function that matches a sequence of pieces. Adjacent regular expressions are joined."""
    matches: list[Match] = []
    for are_patterns, group in groupby(pieces, key=lambda piece: isinstance(piece, _Pattern)):
        found = list(group)
        matches += [_expression(found)] if are_patterns else [one for one in found if not isinstance(one, _Pattern)]
    return matches[0] if len(matches) == 1 else _sequence(matches)


def _text(pieces: Sequence[Piece]) -> str:
    return "".join(piece.text for piece in pieces if isinstance(piece, _Pattern))


def _is_text(pieces: Sequence[Piece]) -> bool:
    return all(isinstance(piece, _Pattern) for piece in pieces)


def _has_names(pieces: Sequence[Piece]) -> bool:
    return any(isinstance(piece, _Pattern) and piece.has_names for piece in pieces)


def _expression(pieces: Sequence[Piece]) -> Match:
    match = re.compile(_text(pieces), re.MULTILINE).match

    def matched(state: _State, position: int) -> int:
        found = match(state.text, position)
        return -1 if found is None else found.end()

    def matched_with_names(state: _State, position: int) -> int:
        found = match(state.text, position)
        if found is None:
            return -1
        state.names += filter(None, found.groups())
        return found.end()

    return matched_with_names if _has_names(pieces) else matched


def _sequence(parts: Sequence[Match]) -> Match:
    def matched(state: _State, position: int) -> int:
        for part in parts:
            position = part(state, position)
            if position < 0:
                return -1
        return position

    return matched


def _choice(options: Sequence[Sequence[Piece]]) -> Piece:
    if all(map(_is_text, options)):
        own = [[piece for piece in option if isinstance(piece, _Pattern)] for option in options]
        return _Pattern(_alternatives(own), any(map(_has_names, options)))
    matches: list[Match] = []
    for are_patterns, group in groupby(options, key=_is_text):
        found = list(group)
        matches += [_joined([_choice(found)])] if are_patterns else map(_joined, found)

    def matched(state: _State, position: int) -> int:
        for match in matches:
            end = match(state, position)
            if end >= 0:
                return end
        return -1

    return matched


def _alternatives(options: Sequence[Sequence[_Pattern]]) -> str:
    """Return an expression that matches the first fitting option. Options with the same beginning share it."""
    parts: list[str] = []
    for first, group in groupby(options, key=lambda option: option[:1]):
        found = list(group)
        shared = len(found) > 1 and first
        parts.append(_text(first) + _alternatives([option[1:] for option in found]) if shared else _text(found[0]))
    return f"(?>{'|'.join(parts)})"


def _optional(pieces: Sequence[Piece]) -> Piece:
    if _is_text(pieces):
        return _Pattern(f"(?>(?:{_text(pieces)})?)", _has_names(pieces))
    part = _joined(pieces)

    def matched(state: _State, position: int) -> int:
        end = part(state, position)
        return position if end < 0 else end

    return matched


def _repeated(pieces: Sequence[Piece]) -> Piece:
    # A repeated group keeps only its last match, so names cannot be repeated by an expression.
    if _is_text(pieces) and not _has_names(pieces):
        return _Pattern(f"(?>(?:{_text(pieces)})*)")
    part = _joined(pieces)

    def matched(state: _State, position: int) -> int:
        while (end := part(state, position)) >= 0:
            position = end
        return position

    return matched


def _refused(part: Match) -> Match:
    def matched(state: _State, position: int) -> int:
        if part(state, position) >= 0:
            raise _Generated
        return -1

    return matched
