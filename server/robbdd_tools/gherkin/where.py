"""Expressions that select scenarios by their values: ``robot=panda and target=~cube.*``.

::

    expression  = conjunction { "or" conjunction }
    conjunction = negation { "and" negation }
    negation    = "not" negation | "(" expression ")" | comparison
    comparison  = variable ( "=" | "!=" | "=~" | "<" | "<=" | ">" | ">=" ) value

A variable is named as in the model, with or without its template (``fetch.part``). A value is a word or a quoted
string. It is compared with a string, with a number, or with the name of an element with or without its prefix. ``=~``
matches a regular expression against the whole value. ``<``, ``<=``, ``>`` and ``>=`` compare numbers. A set matches if
one of its elements matches. ``a != b`` means ``not a = b``. A comparison is false if the variant lacks the variable.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from robbdd_tools.gherkin.scenario_outline import variable_name
from robbdd_tools.graph.acceptance_model import AcceptanceModel, Cell, Iri, Value, Variant

Condition = Callable[[Sequence[Cell]], bool | None]
"""Tests the first values of a scenario in variable order. The result is ``None`` if it depends on later values."""

_TOKEN = re.compile(
    r"""\s*(?:(?P<sign>!=|=~|<=|>=|=|<|>)|(?P<paren>[()])|(?P<quoted>"(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*')"""
    r"""|(?P<word>[^\s()=!<>"']+)|(?P<end>$))"""
)
_BARE_VALUE = re.compile(r"\s*([^\s()\"'][^\s()]*)")
MAX_NESTED = 100
"""Maximum nesting depth of parentheses and negations in an expression."""
_NUMBERS: Mapping[str, Callable[[float, float], bool]] = {
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
}


class WhereError(Exception):
    """An expression is invalid; ``column`` counts from 1."""

    def __init__(self, column: int, message: str) -> None:
        super().__init__(f"--where, column {column}: {message}")
        self.column = column


@dataclass(frozen=True, slots=True)
class Comparison:
    """A comparison of a variable with a value.

    ``column`` is the column of the variable in the expression. ``fits`` tests whether one value satisfies the
    comparison.
    """

    variable: str
    column: int
    fits: Callable[[AcceptanceModel, Value], bool]


@dataclass(frozen=True, slots=True)
class Combination:
    """Expressions that are joined by ``and`` or ``or``, or one expression that is negated."""

    operator: Literal["and", "or", "not"]
    operands: tuple[Expression, ...]


Expression = Comparison | Combination


def parse_where(text: str) -> Expression:
    """Parse an expression; raises ``WhereError``."""
    parser = _Parser(text)
    found = parser.expression()
    parser.expect_end()
    return found


def check_where(expression: Expression, model: AcceptanceModel, variants: Sequence[Variant]) -> None:
    """Raise ``WhereError`` for a variable that no variant has."""
    every = [(variant, variable) for variant in variants for variable in variant.variation.variables]
    names = {name for variant, variable in every for name in variable_names(model, variant, variable)}
    for comparison in _comparisons(expression):
        if comparison.variable not in names:
            known = ", ".join(dict.fromkeys(variable_name(variable) for _, variable in every)) or "none"
            raise WhereError(comparison.column, f"unknown variable '{comparison.variable}'; known variables: {known}")


def condition(expression: Expression, model: AcceptanceModel, variant: Variant) -> Condition:
    """Return a function that tests whether the values of a scenario of the variant satisfy the expression."""
    columns = {
        name: index
        for index, variable in enumerate(variant.variation.variables)
        for name in variable_names(model, variant, variable)
    }
    return _test(expression, model, columns)


def _test(expression: Expression, model: AcceptanceModel, columns: Mapping[str, int]) -> Condition:
    if isinstance(expression, Comparison):
        return _comparison(expression, model, columns.get(expression.variable))
    parts = [_test(operand, model, columns) for operand in expression.operands]
    if expression.operator == "not":
        (negated,) = parts

        def negation(cells: Sequence[Cell]) -> bool | None:
            found = negated(cells)
            return None if found is None else not found

        return negation
    decisive = expression.operator == "or"

    def joined(cells: Sequence[Cell]) -> bool | None:
        unknown = False
        for part in parts:
            found = part(cells)
            if found is decisive:
                return decisive
            unknown = unknown or found is None
        return None if unknown else not decisive

    return joined


def _comparison(comparison: Comparison, model: AcceptanceModel, column: int | None) -> Condition:
    known: dict[Cell, bool] = {}

    def test(cells: Sequence[Cell]) -> bool | None:
        if column is None:
            return False
        if column >= len(cells):
            return None
        cell = cells[column]
        found = known.get(cell)
        if found is None:
            values = cell if isinstance(cell, tuple) else (cell,)
            found = known[cell] = any(comparison.fits(model, value) for value in values)
        return found

    return test


def _comparisons(expression: Expression) -> Iterator[Comparison]:
    if isinstance(expression, Comparison):
        yield expression
    else:
        for operand in expression.operands:
            yield from _comparisons(operand)


def variable_names(model: AcceptanceModel, variant: Variant, variable: Iri) -> tuple[str, ...]:
    """Return the names by which users refer to a variable: alone, with its template, and as a CURIE."""
    local = variable_name(variable)
    return local, f"{model.curie(variant.template.iri).rsplit(':', 1)[-1]}.{local}", model.curie(variable)


def _words(model: AcceptanceModel, value: Value) -> tuple[str, ...]:
    if isinstance(value, Iri):
        short = model.curie(value)
        return short.rsplit(":", 1)[-1] if short != value else variable_name(value), short, value
    return (str(value),)


@dataclass(frozen=True, slots=True)
class _Token:
    kind: str
    text: str
    column: int


class _Parser:
    """A recursive-descent parser. The value after an operator is read as one word, even if it contains operators."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0
        self._depth = 0

    def expression(self) -> Expression:
        return self._joined("or", lambda: self._joined("and", self._negation))

    def expect_end(self) -> None:
        token = self._next()
        if token.kind != "end":
            words = f"expected 'and', 'or' or the end instead of '{token.text}'"
            hint = "; a value with spaces needs quotes, such as speed='1.5 m/s'" if token.kind == "word" else ""
            raise WhereError(token.column, words + hint)

    def _joined(self, operator: Literal["and", "or"], part: Callable[[], Expression]) -> Expression:
        parts = [part()]
        while self._peek().kind == "word" and self._peek().text == operator:
            self._next()
            parts.append(part())
        return parts[0] if len(parts) == 1 else Combination(operator, tuple(parts))

    def _negation(self) -> Expression:
        token = self._next()
        if token.text in ("not", "(") and token.kind != "quoted":
            self._depth += 1
            if self._depth > MAX_NESTED:
                raise WhereError(token.column, "the expression is nested too deeply")
        if token.kind == "word" and token.text == "not":
            return Combination("not", (self._negation(),))
        if token.kind == "paren" and token.text == "(":
            inner = self.expression()
            closing = self._next()
            if closing.text != ")":
                raise WhereError(closing.column, f"expected ')' for the '(' in column {token.column}")
            return inner
        if token.kind not in ("word", "quoted"):
            raise WhereError(token.column, f"expected a variable instead of {_shown(token)}")
        return self._comparison(token)

    def _comparison(self, variable: _Token) -> Expression:
        sign = self._next()
        if sign.kind != "sign":
            raise WhereError(sign.column, f"expected =, !=, =~, <, <=, > or >= after '{variable.text}'")
        value, column = self._value(sign)
        if sign.text == "!=":
            equal = Comparison(variable.text, variable.column, _equal(value))
            return Combination("not", (equal,))
        if sign.text == "=":
            return Comparison(variable.text, variable.column, _equal(value))
        if sign.text == "=~":
            return Comparison(variable.text, variable.column, _matching(value, column))
        return Comparison(variable.text, variable.column, _number(sign.text, value, column))

    def _value(self, sign: _Token) -> tuple[str, int]:
        token = self._peek_quoted()
        if token is not None:
            return token.text, token.column
        match = _BARE_VALUE.match(self._text, self._at)
        if match is None:
            raise WhereError(self._peek().column, f"expected a value after '{sign.text}'")
        self._at = match.end()
        return match[1], match.start(1) + 1

    def _peek_quoted(self) -> _Token | None:
        if self._peek().kind == "quoted":
            return self._next()
        return None

    def _peek(self) -> _Token:
        at = self._at
        token = self._next()
        self._at = at
        return token

    def _next(self) -> _Token:
        match = _TOKEN.match(self._text, self._at)
        if match is None:
            column = len(self._text) - len(self._text[self._at :].lstrip()) + 1
            raise WhereError(column, f"unexpected '{self._text[column - 1]}'")
        self._at = match.end()
        kind = match.lastgroup or "end"
        text = match[kind]
        start = match.start(kind) + 1
        if kind == "quoted":
            text = re.sub(r"\\(.)", r"\1", text[1:-1])
        return _Token(kind, text, start)


def _shown(token: _Token) -> str:
    return "the end" if token.kind == "end" else f"'{token.text}'"


def _equal(wanted: str) -> Callable[[AcceptanceModel, Value], bool]:
    number = _as_number(wanted)

    def fits(model: AcceptanceModel, value: Value) -> bool:
        if isinstance(value, int | float):
            return value == number
        return wanted in _words(model, value)

    return fits


def _matching(wanted: str, column: int) -> Callable[[AcceptanceModel, Value], bool]:
    try:
        pattern = re.compile(wanted)
    except re.error as error:
        at = column + (error.pos or 0)
        raise WhereError(at, f"'{wanted}' is not a regular expression: {error.msg}") from None
    return lambda model, value: any(pattern.fullmatch(word) for word in _words(model, value))


def _number(sign: str, wanted: str, column: int) -> Callable[[AcceptanceModel, Value], bool]:
    number = _as_number(wanted)
    if number is None:
        raise WhereError(column, f"'{sign}' compares numbers and '{wanted}' is not one")
    compare = _NUMBERS[sign]

    def fits(_model: AcceptanceModel, value: Value) -> bool:
        found = None if isinstance(value, Iri) else _as_number(str(value))
        return found is not None and compare(found, number)

    return fits


def _as_number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None
