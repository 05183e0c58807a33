"""Read textX grammars into plain data. Only the notation that the grammars of RobBDD use is supported.

textX remains the reference for the meaning of the notation. Tests compare the two on random texts.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

_TOKEN = re.compile(
    r"\s+|//[^\n]*"
    r"|(?P<text>'(?:\\.|[^'\\])*')"
    r"|/(?P<pattern>(?:\\.|[^/\\])*)/"
    r"|(?P<word>[^\W\d]\w*)"
    r"|(?P<sign>\+=|\*=|\?=|[:;|()\[\]=?*+])"
)


@dataclass(frozen=True, slots=True)
class Literal:
    """A keyword or symbol."""

    text: str


@dataclass(frozen=True, slots=True)
class Pattern:
    """A regular expression."""

    pattern: str


@dataclass(frozen=True, slots=True)
class Use:
    """A reference to another rule."""

    rule: str


@dataclass(frozen=True, slots=True)
class Sequence:
    """Parts in a row."""

    parts: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Choice:
    """The first alternative that matches."""

    options: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Optional:
    """An optional part."""

    part: Expression


@dataclass(frozen=True, slots=True)
class Assignment:
    """An assignment to an attribute of the rule's object. ``operator`` is ``=``, ``?=``, ``+=`` or ``*=``."""

    attribute: str
    operator: str
    value: Literal | Pattern | Use
    separator: Literal | None


Expression = Literal | Pattern | Use | Sequence | Choice | Optional | Assignment


class GrammarError(Exception):
    """The grammar uses notation that is not supported. The message names the place."""


def read_grammar(text: str) -> dict[str, Expression]:
    """Return the rules of a grammar by name, in written order; raises ``GrammarError``."""
    return _Reader(text).rules()


class _Reader:
    def __init__(self, text: str) -> None:
        self._tokens: list[tuple[str, str]] = []
        position = 0
        while position < len(text):
            match = _TOKEN.match(text, position)
            if match is None:
                raise GrammarError(f"unknown notation: {text[position : position + 40]!r}")
            position = match.end()
            if match.lastgroup is not None:
                self._tokens.append((match.lastgroup, match[match.lastgroup]))
        self._next = 0

    def rules(self) -> dict[str, Expression]:
        found: dict[str, Expression] = {}
        while self._next < len(self._tokens):
            name = self._take("word")
            self._take("sign", ":")
            found[name] = self._choice()
            self._take("sign", ";")
        return found

    def _choice(self) -> Expression:
        options = [self._sequence()]
        while self._sees("|"):
            self._next += 1
            options.append(self._sequence())
        return options[0] if len(options) == 1 else Choice(tuple(options))

    def _sequence(self) -> Expression:
        parts: list[Expression] = []
        while not (self._sees("|") or self._sees(";") or self._sees(")")):
            parts.append(self._part())
        return parts[0] if len(parts) == 1 else Sequence(tuple(parts))

    def _part(self) -> Expression:
        if self._sees("("):
            self._next += 1
            part = self._choice()
            self._take("sign", ")")
        else:
            part = self._simple()
            if isinstance(part, Use) and self._assigns():
                return self._assignment(part.rule)
        if self._sees("?"):
            self._next += 1
            return Optional(part)
        return part

    def _assigns(self) -> bool:
        return any(self._sees(operator) for operator in ("=", "?=", "+=", "*="))

    def _assignment(self, attribute: str) -> Expression:
        operator = self._take("sign")
        value = self._simple()
        separator: Literal | None = None
        if self._sees("["):
            self._next += 1
            separator = Literal(_unquoted(self._take("text")))
            self._take("sign", "]")
        assignment = Assignment(attribute, operator, value, separator)
        if self._sees("?"):
            self._next += 1
            return Optional(assignment)
        return assignment

    def _simple(self) -> Literal | Pattern | Use:
        kind, text = self._tokens[self._next]
        self._next += 1
        match kind:
            case "text":
                return Literal(_unquoted(text))
            case "pattern":
                return Pattern(text.replace("\\/", "/"))
            case "word":
                return Use(text)
            case _:
                raise GrammarError(f"'{text}' found where a rule, a text or a pattern belongs")

    def _sees(self, sign: str) -> bool:
        return self._next < len(self._tokens) and self._tokens[self._next] == ("sign", sign)

    def _take(self, kind: str, text: str | None = None) -> str:
        found = self._tokens[self._next] if self._next < len(self._tokens) else ("end", "")
        if found[0] != kind or (text is not None and found[1] != text):
            raise GrammarError(f"expected {text or kind}, found '{found[1]}'")
        self._next += 1
        return found[1]


def _unquoted(text: str) -> str:
    return re.sub(r"\\(.)", r"\1", text[1:-1])
