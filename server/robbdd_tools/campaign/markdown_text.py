"""Parts of a Markdown document as GitHub and GitLab show it. Users' text is shown literally."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def escaped(text: str) -> str:
    """Return Markdown that is rendered as the given text on one line."""
    literal = "".join(f"\\{letter}" if letter in "\\|*_`[]<>#~" else letter for letter in text)
    return " ".join(literal.split("\n")).replace("&", "&amp;")


def markdown_table(head: Sequence[str], rows: Iterable[Sequence[str]], *, numbers: Sequence[int] = ()) -> str:
    """Return a table of Markdown cells. ``numbers`` are the columns (from 0) that are aligned to the right."""
    lines = ["---:" if place in numbers else "---" for place, _ in enumerate(head)]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in (head, lines, *rows))


def details(summary: str, content: str) -> str:
    """Return a part that is closed until the reader opens it. ``summary`` is Markdown without blank lines."""
    return f"<details>\n<summary>{summary}</summary>\n\n{content}\n\n</details>"


def html_escaped(text: str) -> str:
    """Return HTML that is rendered as the given text on one line."""
    named = {"&": "&amp;", "<": "&lt;", ">": "&gt;", "`": "&#96;", "*": "&#42;", "_": "&#95;", "\n": " "}
    return "".join(named.get(letter, letter) for letter in text)


def code(text: str) -> str:
    """Return a text as inline code, also in a cell of a table."""
    return f"<code>{html_escaped(text).replace('|', '&#124;')}</code>"
