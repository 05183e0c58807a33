"""Parse one piece of text into a tree. Broken text is repaired."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from robbdd_tools.syntax.chunk import parse_chunk
from robbdd_tools.syntax.declaration import SyntaxFault
from robbdd_tools.syntax.faults import fault_in
from robbdd_tools.syntax.parsed import Parsed
from robbdd_tools.syntax.recover import recover
from robbdd_tools.syntax.to_trees import convert


@dataclass(frozen=True, slots=True)
class Piece:
    """A parsed text: its tree (``None`` if no repair helped), its faults, and the offset of text after its end."""

    tree: Any
    faults: tuple[SyntaxFault, ...]
    trailing: int | None


def read_piece(language: str, text: str) -> Piece:
    """Parse one piece of text. No text of a user raises an error."""
    parsed = parse_chunk(language, text)
    if isinstance(parsed, Parsed):
        return Piece(convert(parsed.declaration, text), (), parsed.trailing)
    recovered = recover(language, text, parsed)
    faults = tuple(fault_in(language, text, fault) for fault in recovered.faults)
    if recovered.parsed is None:
        return Piece(None, faults, None)
    # A repair may have appended text that is not the user's.
    repaired = recovered.text[: len(text)]
    return Piece(convert(recovered.parsed.declaration, repaired), faults, recovered.parsed.trailing)
