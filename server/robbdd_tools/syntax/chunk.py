"""Parses one chunk with the grammar of its file kind, and says what was expected where it does not fit.

The grammars are textX's. Their parser here is compiled from the same files (``peg``), for editors parse with every
keystroke; a grammar whose notation it does not know goes to textX itself. Tests hold the two to the same results.
"""

from __future__ import annotations

from functools import cache
from threading import RLock

from robbdd_tools.syntax.grammar import GrammarError, read_grammar
from robbdd_tools.syntax.grammar_files import ROOTS, grammar_text
from robbdd_tools.syntax.parsed import Expectation, Parsed, RawNode, Rejected
from robbdd_tools.syntax.peg import Compiled, State
from robbdd_tools.syntax.textx import parse_with_textx

# Rules are compiled when they are first met; a second thread must not see one half done. What is done at a
# checkpoint in the middle of a text may parse another one.
_COMPILING = RLock()


def parse_chunk(language: str, text: str) -> Parsed | Rejected:
    """Parse one chunk of a file whose name ends in ``language``; a ``scenario`` is parsed without its story."""
    parser = _parser(language)
    if parser is None:
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


@cache
def _parser(language: str) -> Compiled | None:
    try:
        return Compiled(read_grammar(grammar_text(language)), ROOTS.get(language))
    except GrammarError:
        return None
