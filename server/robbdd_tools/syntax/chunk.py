"""Parses one chunk with the grammar of its file kind, and says what was expected where it does not fit.

The grammars are textX's. Their parser here is compiled from the same files (``peg``), for editors parse with every
keystroke; a grammar whose notation it does not know goes to textX itself. Tests hold the two to the same results.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from threading import RLock
from typing import Any

from robbdd_tools.base.data import data_file
from robbdd_tools.base.files import load_text
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.syntax.grammar import GrammarError, read_grammar
from robbdd_tools.syntax.peg import Compiled, State
from robbdd_tools.syntax.phrases import phrase_rules

RawNode = Any
"""An object of a grammar rule: attributes as in the grammar, ``_tx_position`` and ``_tx_position_end``."""


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
    """The object of a declaration, and the offset of text behind it that belongs to nothing."""

    declaration: RawNode
    trailing: int | None


# Rules are compiled when they are first met; a second thread must not see one half done. What is done at a
# checkpoint in the middle of a text may parse another one.
_COMPILING = RLock()


def parse_chunk(language: str, text: str) -> Parsed | Rejected:
    """Parse one chunk of a file whose name ends in ``language``; a ``scenario`` is parsed without its story."""
    parser = _parser(language)
    if parser is None:
        from robbdd_tools.syntax.textx import parse_with_textx

        return parse_with_textx(language, text)
    with _COMPILING:
        chunk, state = parser.parse(text)
    if chunk is None:
        return Rejected(state.furthest, _expectation(state))
    node: RawNode = chunk
    return Parsed(node.declaration, None if node.trailing is None else int(node.trailing._tx_position))


def _expectation(state: State) -> Expectation:
    literals = frozenset(name for kind, name in state.expected if kind == "literal")
    return Expectation(literals, frozenset(name for kind, name in state.expected if kind == "rule"))


_GRAMMARS = {"ktree": "scenex", "scenario": "bdd"}
"""File kinds, and parts of declarations, that share the grammar of another one."""
ROOTS = {"scenario": "ScenarioChunk"}
"""The rules of parts of declarations; a file kind has the first of its grammar."""


@cache
def grammar_text(language: str) -> str:
    """Return the whole grammar of a file kind: its own rules, the shared ones, the phrases of the catalog."""
    grammars = [load_text(data_file("grammar", f"{name}.tx")) for name in (grammar_name(language), "base")]
    if grammar_name(language) == "bdd":
        grammars.append(phrase_rules(load_catalog()))
    return "\n".join(grammars)


def grammar_name(language: str) -> str:
    """Return the name of the grammar that a file kind is read with."""
    return _GRAMMARS.get(language, language)


@cache
def _parser(language: str) -> Compiled | None:
    try:
        return Compiled(read_grammar(grammar_text(language)), ROOTS.get(language))
    except GrammarError:
        return None
