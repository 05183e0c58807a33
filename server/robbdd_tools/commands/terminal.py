"""The console of commands that draw on a terminal. It interprets neither markup nor control codes in a text."""

from __future__ import annotations

from rich.console import Console
from rich.text import Text

from robbdd_tools.base.printable import printable


def terminal(*, stderr: bool = False) -> Console:
    """Return a console that interprets neither markup nor emoji names, and that highlights nothing."""
    return Console(stderr=stderr, markup=False, emoji=False, highlight=False)


def plain(text: str, style: str = "") -> Text:
    """Return one line of text in a style. ``printable`` escapes the text."""
    return Text(printable(text), style)
