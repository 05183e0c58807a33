"""Compile a grammar into parsing functions, equivalent to textX but several times as fast.

The objects look like textX's own (class name of the rule, attributes, ``_tx_position``, ``_tx_position_end``). Every
function takes the state, a position and the attributes collected so far, and returns the position after the parsed
text, or -1; on failure it truncates the attributes to their former length. Objects are memoised by rule and position,
so alternatives with a common prefix parse it once.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Mapping
from typing import Any

from robbdd_tools.base.checkpoint import checkpoint
from robbdd_tools.syntax import grammar

DEEPEST = 6000
"""Maximum depth of Python calls. It allows some hundreds of nested brackets, far more than anyone writes. Calls between
Python functions need no C stack."""
_KEYWORD = re.compile(r"[^\d\W]\w*")
BLANK = r"(?:[ \t\r\n]+|//[^\n]*)*"
"""Regular expression of white space and comments, which may precede each token."""
_BLANK = re.compile(BLANK)
Log = list[tuple[str, Any]]
Parse = Callable[["State", int, Log], int]
Make = Callable[["State", int], "tuple[int, Any] | None"]


class State:
    """The state of parsing one text: the furthest failure, the tokens expected there, and the memoised results."""

    __slots__ = ("_blank", "expected", "furthest", "results", "text")

    def __init__(self, text: str) -> None:
        self.text = text
        self.furthest = 0
        self.expected: set[tuple[str, str]] = set()
        self.results: dict[tuple[str, int], tuple[int, Any] | None] = {}
        self._blank: dict[int, int] = {}

    def after_blank(self, position: int) -> int:
        """Return the position after white space and comments."""
        found = self._blank.get(position)
        if found is None:
            match = _BLANK.match(self.text, position)
            found = self._blank[position] = match.end() if match else position
        return found

    def fail(self, position: int, expected: tuple[str, str]) -> None:
        """Record that a literal, or a rule given by its name, was expected at a position."""
        if position > self.furthest:
            self.furthest = position
            self.expected = {expected}
        elif position == self.furthest:
            self.expected.add(expected)


class Node:
    """An object of a rule; its attributes are those of the rule."""

    _tx_position: int
    _tx_position_end: int


class Compiled:
    """A compiled grammar; its first rule is the root by default."""

    def __init__(self, rules: Mapping[str, grammar.Expression], root: str | None = None) -> None:
        self._rules = rules
        self._root = root or next(iter(rules))
        self._texts: dict[str, Parse] = {}
        self._makers: dict[str, Make] = {}

    def parse(self, text: str) -> tuple[Node | None, State]:
        """Parse a whole text. If it violates the grammar, return ``None`` and the state with the error."""
        state = State(text)
        if sys.getrecursionlimit() < DEEPEST:
            sys.setrecursionlimit(DEEPEST)
        try:
            found = self._maker(self._root)(state, 0)
        except RecursionError:
            # Thousands of nested brackets: report an error at the innermost one reached.
            found = None
        if found is not None:
            end = state.after_blank(found[0])
            if end == len(text):
                return found[1], state
            state.fail(end, ("rule", "EOF"))
        return None, state

    def _is_text(self, rule: str) -> bool:
        """Return whether a rule only matches text and makes no object."""
        return _reads_text(self._rules[rule], self._rules)

    def _text(self, rule: str) -> Parse:
        if rule not in self._texts:
            self._texts[rule] = self._compile(self._rules[rule], rule)
        return self._texts[rule]

    def _maker(self, rule: str) -> Make:
        """Return the function of a rule by its name.

        It can be found even while it is being compiled, because rules refer to each other.
        """
        if rule not in self._makers:
            self._makers[rule] = lambda state, position: self._makers[rule](state, position)
            body = self._rules[rule]
            abstract = isinstance(body, grammar.Use) or (
                isinstance(body, grammar.Choice) and all(isinstance(option, grammar.Use) for option in body.options)
            )
            self._makers[rule] = _remembered(rule, self._abstract(body) if abstract else self._object(rule, body))
        return lambda state, position: self._makers[rule](state, position)

    def _abstract(self, body: grammar.Expression) -> Make:
        options = body.options if isinstance(body, grammar.Choice) else (body,)
        makers = [self._maker(option.rule) for option in options if isinstance(option, grammar.Use)]

        def make(state: State, position: int) -> tuple[int, Any] | None:
            for maker in makers:
                found = maker(state, position)
                if found is not None:
                    return found
            return None

        return make

    def _object(self, rule: str, body: grammar.Expression) -> Make:
        kind = type(rule, (Node,), {})
        parse = self._compile(body, rule)
        defaults = _defaults(body)
        lists = [name for name, value in defaults.items() if isinstance(value, list)]

        def make(state: State, position: int) -> tuple[int, Any] | None:
            log: Log = []
            end = parse(state, position, log)
            if end < 0:
                return None
            node = kind()
            attributes = node.__dict__
            attributes.update(defaults)
            for name in lists:
                attributes[name] = []
            for name, value in log:
                if name in lists:
                    attributes[name].append(value)
                else:
                    attributes[name] = value
            attributes["_tx_position"] = state.after_blank(position)
            attributes["_tx_position_end"] = end
            return end, node

        return make

    def _compile(self, expression: grammar.Expression, rule: str) -> Parse:
        match expression:
            case grammar.Literal(text):
                return _terminal(literal_pattern(text), ("literal", text))
            case grammar.Pattern(pattern):
                return _terminal(pattern, ("rule", rule))
            case grammar.Use(name):
                return self._text(name) if self._is_text(name) else _unassigned(self._maker(name))
            case grammar.Sequence(parts):
                return _sequence([self._compile(part, rule) for part in parts])
            case grammar.Choice(options):
                return _choice([self._compile(option, rule) for option in options])
            case grammar.Optional(part):
                return _optional(self._compile(part, rule))
            case grammar.Assignment():
                return self._assignment(expression, rule)

    def _assignment(self, assignment: grammar.Assignment, rule: str) -> Parse:
        name, value = assignment.attribute, assignment.value
        if isinstance(value, grammar.Use) and not self._is_text(value.rule):
            one = _assigned(name, self._maker(value.rule))
        else:
            one = _assigned_text(name, self._compile(value, rule))
        match assignment.operator:
            case "=":
                return one
            case "?=":
                return _optional(_flag(name, self._compile(value, rule)))
            case operator:
                separator = assignment.separator and self._compile(assignment.separator, rule)
                return _several(one, separator, at_least_one=operator == "+=")


def literal_pattern(text: str) -> str:
    """Return the regular expression of a keyword or symbol. A keyword must be a whole word."""
    return re.escape(text) + (r"\b" if _KEYWORD.fullmatch(text) else "")


def _reads_text(body: grammar.Expression, rules: Mapping[str, grammar.Expression]) -> bool:
    match body:
        case grammar.Literal() | grammar.Pattern():
            return True
        case grammar.Use(rule):
            return _reads_text(rules[rule], rules)
        case grammar.Choice(parts) | grammar.Sequence(parts):
            # The first option of a choice determines whether its rules make objects.
            return all(_reads_text(part, rules) for part in parts[:1]) and not any(map(_assigns, parts))
        case grammar.Optional(part):
            return _reads_text(part, rules)
        case grammar.Assignment():
            return False


def _assigns(body: grammar.Expression) -> bool:
    match body:
        case grammar.Assignment():
            return True
        case grammar.Sequence(parts) | grammar.Choice(parts):
            return any(map(_assigns, parts))
        case grammar.Optional(part):
            return _assigns(part)
        case _:
            return False


def _defaults(body: grammar.Expression) -> dict[str, Any]:
    match body:
        case grammar.Assignment(attribute, operator, _, _):
            return {attribute: {"=": None, "?=": False}.get(operator, [])}
        case grammar.Sequence(parts) | grammar.Choice(parts):
            return {name: value for part in parts for name, value in _defaults(part).items()}
        case grammar.Optional(part):
            return _defaults(part)
        case _:
            return {}


def _remembered(rule: str, make: Make) -> Make:
    def remember(state: State, position: int) -> tuple[int, Any] | None:
        key = (rule, position)
        results = state.results
        if key in results:
            return results[key]
        found = results[key] = make(state, position)
        return found

    return remember


def _terminal(pattern: str, expected: tuple[str, str]) -> Parse:
    match = re.compile(pattern, re.MULTILINE).match

    def parse(state: State, position: int, _: Log) -> int:
        start = state.after_blank(position)
        found = match(state.text, start)
        if found is not None:
            return found.end()
        state.fail(start, expected)
        return -1

    return parse


def _unassigned(make: Make) -> Parse:
    def parse(state: State, position: int, _: Log) -> int:
        found = make(state, position)
        return -1 if found is None else found[0]

    return parse


def _assigned(name: str, make: Make) -> Parse:
    def parse(state: State, position: int, log: Log) -> int:
        found = make(state, position)
        if found is None:
            return -1
        log.append((name, found[1]))
        return found[0]

    return parse


def _assigned_text(name: str, read: Parse) -> Parse:
    def parse(state: State, position: int, log: Log) -> int:
        end = read(state, position, log)
        if end >= 0:
            log.append((name, state.text[state.after_blank(position) : end]))
        return end

    return parse


def _flag(name: str, read: Parse) -> Parse:
    def parse(state: State, position: int, log: Log) -> int:
        end = read(state, position, log)
        if end >= 0:
            log.append((name, True))
        return end

    return parse


def _sequence(parts: list[Parse]) -> Parse:
    def parse(state: State, position: int, log: Log) -> int:
        kept = len(log)
        for part in parts:
            position = part(state, position, log)
            if position < 0:
                del log[kept:]
                return -1
        return position

    return parse


def _choice(options: list[Parse]) -> Parse:
    def parse(state: State, position: int, log: Log) -> int:
        for option in options:
            end = option(state, position, log)
            if end >= 0:
                return end
        return -1

    return parse


def _optional(part: Parse) -> Parse:
    def parse(state: State, position: int, log: Log) -> int:
        end = part(state, position, log)
        return position if end < 0 else end

    return parse


def _several(one: Parse, separator: Parse | None, at_least_one: bool) -> Parse:
    def parse(state: State, position: int, log: Log) -> int:
        end = one(state, position, log)
        if end < 0:
            return -1 if at_least_one else position
        while True:
            checkpoint()
            between = end if separator is None else separator(state, end, log)
            following = -1 if between < 0 else one(state, between, log)
            if following < 0:
                return end
            end = following

    return parse
