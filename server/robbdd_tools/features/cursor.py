"""The context of a cursor: its chunk, the enclosing declarations, and the partly typed word."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration

_WORD = re.compile(r"[\w\-.]*\Z")
_QUOTED = re.compile(r"//[^\n]*|\"(?:\\.|[^\"\\\n])*\"?|'(?:\\.|[^'\\\n])*'?")
_MORE = re.compile(r"[^\w\s]|\n")
"""Text after the first words of a declaration."""
_VARIANT = re.compile(r"(?<![\w\-.<])Scenario\s+(?!Template\b)([^\W\d][\w\-]*)\s*\{")
_BLOCK = re.compile(r"(?<![\w\-.<])(?:kgraph\s*\([^()]*\)|body)\s*([^\W\d][\w\-]*)\s*\{")
"""Pattern of the start of a block inside a kinematic tree or a scene instance. Names are inside such a block."""


@dataclass(frozen=True, slots=True)
class Cursor:
    """The context of an offset in a file.

    - ``before``: the text from the start of the declaration to the word at the cursor. In a story, it leaves out the
      scenarios before the current one.
    - ``word``: the part of the word that the user has typed, and ``span`` is its absolute place.
    - ``scopes``: the paths of the enclosing declarations, innermost first.
    - ``quoted``: the open comment or string that contains the cursor, if any.
    """

    placed: PlacedDeclaration | None
    before: str
    word: str
    span: Span
    scopes: tuple[str, ...]
    quoted: str | None


def cursor_at(analysis: FileAnalysis, offset: int) -> Cursor:
    """Return the context of an absolute offset in a file."""
    placed = _enclosing(analysis, offset)
    text = _before(analysis, placed, offset)
    match = _WORD.search(text, text.rfind("\n") + 1)
    # A dot after a reference starts a new word.
    word = match[0].lstrip(".") if match else ""
    before = text[: len(text) - len(word)]
    return Cursor(placed, before, word, Span(offset - len(word), offset), _scopes(placed, before), _quoted(text))


def _enclosing(analysis: FileAnalysis, offset: int) -> PlacedDeclaration | None:
    """Return the declaration at an offset.

    In a scene, the splitter takes ``obj set`` without a name for the start of a declaration. If it is indented and the
    braces before it are open, it belongs to the declaration before it.
    """
    end = bisect_right(analysis.declarations, offset, key=lambda entry: entry.offset)
    found = analysis.declarations[max(0, end - 2) : end]
    if len(found) == 2:
        text = analysis.document.text
        begun = text[found[1].offset : offset]
        indented = text[text.rfind("\n", 0, found[1].offset) + 1 : found[1].offset]
        if indented and indented.isspace() and not _MORE.search(begun) and _is_open(found[0].declaration.text):
            return found[0]
    return found[-1] if found else None


def _is_open(text: str) -> bool:
    """Return whether a text has an opening brace without a closing one."""
    code = _QUOTED.sub("", text)
    return code.count("{") > code.count("}")


def _before(analysis: FileAnalysis, placed: PlacedDeclaration | None, offset: int) -> str:
    """Return the text of a declaration up to the cursor.

    In a story, the text leaves out the scenarios before the current one.
    """
    if placed is None:
        return analysis.document.text[:offset]
    parts = placed.parts
    # The text after a story's end still belongs to its last scenario.
    within = parts if len(parts) == 1 else parts[:-1]
    start = within[bisect_right(within, offset, key=lambda part: part.offset) - 1].offset
    head = parts[0].declaration.text if start > placed.offset else ""
    return head + analysis.document.text[start:offset]


def _scopes(placed: PlacedDeclaration | None, before: str) -> tuple[str, ...]:
    symbols = placed.declaration.symbols if placed else ()
    if not symbols:
        return ()
    scopes = (symbols[0].path,)
    # A variant ends where the next starts, even if braces are missing.
    for name in (*_VARIANT.findall(before)[-1:], *_open_blocks(before)):
        scopes = (f"{scopes[0]}.{name}", *scopes)
    return scopes


def _open_blocks(before: str) -> Iterator[str]:
    """Yield the names of the blocks that are still open at the end of a text, outermost first."""
    blocks = list(_BLOCK.finditer(before))
    code = _QUOTED.sub(lambda match: " " * len(match[0]), before) if blocks else ""
    for block in blocks:
        depth, lowest = 1, 1
        for sign in re.findall(r"[{}]", code[block.end() :]):
            depth += 1 if sign == "{" else -1
            lowest = min(lowest, depth)
        if lowest > 0:
            yield block[1]


def _quoted(text: str) -> str | None:
    """Return the comment or string that is open at the end of ``text``."""
    piece = next((match[0] for match in _QUOTED.finditer(text) if match.end() == len(text)), "")
    if not piece:
        return None
    closed = not piece.startswith("//") and len(piece) > 1 and piece.endswith(piece[0])
    return None if closed else piece
