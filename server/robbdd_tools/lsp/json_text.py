"""Answers as JSON text. The text of a declaration is kept until its content changes; only its line numbers are updated.

Converting and serialising the objects of a long file takes ten times as long as joining kept texts.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

from robbdd_tools.base.document import Document

if TYPE_CHECKING:
    from robbdd_tools.lsp.convert import Converter
    from robbdd_tools.syntax.declaration import Declaration

# A quotation mark inside a string is escaped, so this matches keys only.
_LINE = re.compile(r'("(?:line|startLine|endLine)": )(\d+)')


@dataclass(frozen=True, slots=True)
class JsonText:
    """The result of a request, already serialised."""

    text: str


class Passage:
    """JSON text that can be moved to another line of a document."""

    __slots__ = ("_form", "_line", "_lines", "_text")

    def __init__(self, text: str) -> None:
        self._lines = [int(number) for _, number in _LINE.findall(text)]
        self._form = _LINE.sub(r"\1%d", text.replace("%", "%%"))
        self._line, self._text = 0, text

    def at(self, line: int) -> str:
        """Return the text with ``line`` added to all its line numbers."""
        if line != self._line:
            self._line, self._text = line, self._form % tuple([number + line for number in self._lines])
        return self._text


@dataclass(frozen=True, slots=True)
class _Known:
    """A kept passage, with the values on which it depends in addition to the declaration."""

    convert: Converter
    column: int
    key: object
    passage: Passage


class Passages:
    """The kept texts of declarations for one kind of request."""

    def __init__(self, serialise: Callable[[Any], str]) -> None:
        self._serialise = serialise
        self._kept: WeakKeyDictionary[Declaration, _Known] = WeakKeyDictionary()

    def text(
        self,
        convert: Converter,
        document: Document,
        placed: tuple[int, Declaration],
        make: Callable[[Document, int], Sequence[Any]],
        key: object = None,
    ) -> str:
        """Return the JSON objects of a declaration at an offset of a document, separated by commas.

        If the declaration or the ``key`` has changed since the last call, ``make`` is called and returns the objects.
        Its arguments are a document with the text of the declaration, and the offset of the declaration in this
        document.
        """
        offset, declaration = placed
        line = document.line_at(offset)
        start = document.line_starts[line]
        column = convert.units(document.text[start:offset]) if start < offset else 0
        known = self._kept.get(declaration)
        if known is None or known.convert is not convert or known.column != column or known.key != key:
            # Spaces take one unit in every encoding.
            alone = Document(document.uri, 0, " " * column + declaration.text)
            passage = Passage(joined(map(self._serialise, make(alone, column))))
            known = self._kept[declaration] = _Known(convert, column, key, passage)
        return known.passage.at(line)


def joined(texts: Iterable[str]) -> str:
    """Return JSON values with commas between them; empty texts are skipped."""
    return ", ".join(filter(None, texts))


def with_children(parent: str, children: str) -> str:
    """Return the JSON text of a document symbol with further children."""
    empty = '"children": []'
    assert parent.count(empty) == 1
    return parent.replace(empty, f'"children": [{children}]')
