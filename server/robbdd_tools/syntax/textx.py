"""The only module that uses textX, the reference for the meaning of the grammars.

textX has no type information and builds its classes at run time, so its objects have the type ``RawNode``. It is
imported on demand: for grammars that ``peg`` does not support, and in tests.
"""

from __future__ import annotations

from functools import cache
from importlib import import_module
from typing import Any

from robbdd_tools.syntax.grammar_files import ROOTS, grammar_text
from robbdd_tools.syntax.parsed import Expectation, Parsed, Rejected


def parse_with_textx(language: str, text: str) -> Parsed | Rejected:
    """Do the same as ``parse_chunk`` by textX."""
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
        # textX names the separator of a repetition "sep".
        if rule.rule_name and rule.rule_name != "sep":
            names.add(str(rule.rule_name))
        elif keyword is not None:
            literals.add(str(keyword).removesuffix(r"\b"))
    return Expectation(frozenset(literals), frozenset(names))


@cache
def _metamodel(language: str) -> Any:
    textx: Any = import_module("textx")
    root = f"Root: {ROOTS[language]};\n" if language in ROOTS else ""
    return textx.metamodel_from_str(root + grammar_text(language), autokwd=True, memoization=True)
