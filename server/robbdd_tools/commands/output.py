"""All output of the command line is escaped here, so that no model, path or reason can control a terminal."""

from __future__ import annotations

import sys

from robbdd_tools.base.printable import printable
from robbdd_tools.commands import FAILED


def print_line(line: str) -> None:
    """Print a line of a command's answer and flush."""
    print(printable(line), flush=True)


def print_note(line: str) -> None:
    """Print a line about the command's work to standard error."""
    print(printable(line), file=sys.stderr)


def print_document(text: str) -> None:
    """Print a document whose format has its own escapes: JSON, Turtle, SVG, Python."""
    sys.stdout.write(text)


def fail(message: str) -> int:
    """Print why a command failed, and return its exit code."""
    print_note(f"robbdd: {message}")
    return FAILED
