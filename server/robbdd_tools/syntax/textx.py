"""The only door to textX: compiles a file kind's grammar and parses one chunk with it.

textX has no type information and builds its classes at run time, so its objects go by the name ``RawNode``. It is
imported when the first chunk is parsed, for a server must answer before that.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib import import_module
from typing import Any

from robbdd_tools.base.data import data_file
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.syntax.phrases import phrase_rules

RawNode = Any
"""An object that textX made: attributes as in the grammar, ``_tx_position`` and ``_tx_position_end``."""


@dataclass(frozen=True, slots=True)
class Expectation:
    """What the parser could have read at a position: keywords and signs as written, rules by name."""

    literals: frozenset[str]
    rules: frozenset[str]


@dataclass(frozen=True, slots=True)
class Rejected:
    """The chunk does not follow the grammar: the furthest offset reached and what was expected there."""

    offset: int
    expected: Expectation


@dataclass(frozen=True, slots=True)
class Parsed:
    """The textX object of a declaration, and the offset of text behind it that belongs to nothing."""

    declaration: RawNode
    trailing: int | None


def parse_chunk(language: str, text: str) -> Parsed | Rejected:
    """Parse one chunk of a file whose name ends in ``language``."""
    textx: Any = import_module("textx")
    try:
        chunk = _metamodel(language).model_from_str(text)
    except textx.TextXSyntaxError as error:
        offset = _offset(text, error.line, error.col)
        return Rejected(offset, _expectation(error.expected_rules))
    trailing = None if chunk.trailing is None else int(chunk.trailing._tx_position)
    return Parsed(chunk.declaration, trailing)


def _offset(text: str, line: int, column: int) -> int:
    start = 0
    for _ in range(line - 1):
        start = text.index("\n", start) + 1
    return start + column - 1


def _expectation(rules: Any) -> Expectation:
    literals: set[str] = set()
    names: set[str] = set()
    for rule in rules or ():
        keyword = getattr(rule, "to_match", None)
        # The separator of a repetition is a keyword that textX names "sep".
        if rule.rule_name and rule.rule_name != "sep":
            names.add(str(rule.rule_name))
        elif keyword is not None:
            literals.add(str(keyword).removesuffix(r"\b"))
    return Expectation(frozenset(literals), frozenset(names))


_GRAMMARS = {"ktree": "scenex"}
"""File kinds that share the grammar of another one."""


@cache
def grammar_text(language: str) -> str:
    """Return the whole grammar of a file kind: its own rules, the shared ones, the phrases of the catalog."""
    grammars = [data_file("grammar", f"{name}.tx").read_text(encoding="utf-8") for name in (_grammar(language), "base")]
    if language == "bdd":
        grammars.append(phrase_rules(load_catalog()))
    return "\n".join(grammars)


def _grammar(language: str) -> str:
    return _GRAMMARS.get(language, language)


def _metamodel(language: str) -> Any:
    return _compiled(_grammar(language))


@cache
def _compiled(language: str) -> Any:
    textx: Any = import_module("textx")
    return textx.metamodel_from_str(grammar_text(language), autokwd=True, memoization=True)
