"""Result of parsing a chunk: the object of a declaration, or the place where it violates the grammar."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

RawNode = Any
"""An object of a grammar rule: attributes as in the grammar, ``_tx_position`` and ``_tx_position_end``."""


@dataclass(frozen=True, slots=True)
class Expectation:
    """The tokens that the parser accepts at a position: keywords and symbols as written, rules by name."""

    literals: frozenset[str]
    rules: frozenset[str]


@dataclass(frozen=True, slots=True)
class Rejected:
    """The chunk violates the grammar: the furthest offset reached and what was expected there."""

    offset: int
    expected: Expectation


@dataclass(frozen=True, slots=True)
class Parsed:
    """The object of a declaration, and the offset of surplus text after it."""

    declaration: RawNode
    trailing: int | None
