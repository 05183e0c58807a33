"""The result of parsing a chunk: the object of a declaration, or the place where the chunk violates the grammar."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

RawNode = Any
"""An object of a grammar rule: attributes as in the grammar, ``_tx_position`` and ``_tx_position_end``."""


@dataclass(frozen=True, slots=True)
class Expectation:
    """The tokens that the parser accepts at a position: keywords and symbols as written, and names of rules."""

    literals: frozenset[str]
    rules: frozenset[str]


@dataclass(frozen=True, slots=True)
class Rejected:
    """The chunk violates the grammar.

    It has the furthest offset that the parser reached, and the tokens expected there.
    """

    offset: int
    expected: Expectation


@dataclass(frozen=True, slots=True)
class Parsed:
    """The object of a declaration, and the offset of the text that follows it in the chunk."""

    declaration: RawNode
    trailing: int | None
