"""All that the command line prints goes through here, so that nothing in a model, path or reason acts on a terminal."""

from __future__ import annotations

import sys

from robbdd_tools.base.printable import printable
from robbdd_tools.commands import FAILED


def print_line(line: str) -> None:
    """Print a line of a command's answer at once."""
    print(printable(line), flush=True)


def print_note(line: str) -> None:
    """Print a line about the command's work, apart from its answer, on the standard error stream."""
    print(printable(line), file=sys.stderr)


def print_document(text: str) -> None:
    """Print text in a format of its own, which has its own way to escape: JSON, Turtle, SVG, Python."""
    sys.stdout.write(text)


def fail(message: str) -> int:
    """Print why a command cannot do its work, and return its exit code."""
    print_note(f"robbdd: {message}")
    return FAILED
