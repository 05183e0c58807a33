"""What parsing a chunk results in: the object of a declaration, or where it does not follow the grammar."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

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
