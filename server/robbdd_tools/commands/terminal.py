"""The console of commands that draw on a terminal: what it prints is text, never markup, and nothing acts on it."""

from __future__ import annotations

from rich.console import Console
from rich.text import Text

from robbdd_tools.base.printable import printable


def terminal(*, stderr: bool = False) -> Console:
    """Return a console that takes no text for markup, emoji names or things to highlight."""
    return Console(stderr=stderr, markup=False, emoji=False, highlight=False)


def plain(text: str, style: str = "") -> Text:
    """Return one line of text in a style, see ``printable``."""
    return Text(printable(text), style)
