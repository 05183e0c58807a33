"""Tokens of a ``.study`` file."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from robbdd_tools.base.document import Span

_TOKEN = re.compile(
    r"""(?P<space>\s+|//[^\n\r]*)|(?P<text>"[^"\n\r]*"|'[^'\n\r]*')|(?P<reference><[^<>\n\r]*>)"""
    r"""|(?P<number>-?\d+(?:\.\d+)?(?![\w.]))|(?P<name>[^\W\d][\w-]*)|(?P<sign>[{}:,])|(?P<other>[^\s{}:,<>"']+|.)"""
)


class Token(NamedTuple):
    """A token of a study. White space and comments are not tokens. The last token has the kind ``end``."""

    kind: str
    text: str
    span: Span

    @property
    def words(self) -> str:
        """The token as messages name it."""
        return "the end of the file" if self.kind == "end" else f"'{self.text}'"


def study_tokens(text: str) -> Iterator[Token]:
    """Yield the tokens of a study."""
    for match in _TOKEN.finditer(text):
        if match.lastgroup != "space":
            yield Token(match.lastgroup or "other", match.group(), Span(*match.span()))
    yield Token("end", "", Span(len(text), len(text)))
