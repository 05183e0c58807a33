"""Console of commands that draw on a terminal; it prints text without interpreting markup or control codes."""

from __future__ import annotations

from rich.console import Console
from rich.text import Text

from robbdd_tools.base.printable import printable


def terminal(*, stderr: bool = False) -> Console:
    """Return a console that interprets no markup and no emoji names, and highlights nothing."""
    return Console(stderr=stderr, markup=False, emoji=False, highlight=False)


def plain(text: str, style: str = "") -> Text:
    """Return one line of text in a style, escaped by ``printable``."""
    return Text(printable(text), style)
