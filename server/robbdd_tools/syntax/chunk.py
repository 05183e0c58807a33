"""Parse one chunk with the grammar of its file kind. On an error, report the expected text.

The grammars are written for textX. ``peg`` compiles them into a faster parser, because editors parse on every
keystroke. If a grammar has notation that ``peg`` does not support, textX itself parses. Tests check that both parsers
have the same results.
"""

from __future__ import annotations

from functools import cache
from threading import RLock

from robbdd_tools.syntax.grammar import GrammarError, read_grammar
from robbdd_tools.syntax.grammar_files import ROOTS, grammar_text
from robbdd_tools.syntax.parsed import Expectation, Parsed, RawNode, Rejected
from robbdd_tools.syntax.peg import Compiled, State
from robbdd_tools.syntax.textx import parse_with_textx

# Rules are compiled at first use, and another thread must not see a half-compiled rule. Reentrant, because work at a
# checkpoint in the middle of a text may parse another one.
_COMPILING = RLock()


def parse_chunk(language: str, text: str) -> Parsed | Rejected:
    """Parse one chunk of a file whose extension is ``language``. A ``scenario`` is parsed without its story."""
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
