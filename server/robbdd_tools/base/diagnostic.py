"""Diagnostics and their fixes."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

from robbdd_tools.base.document import Span


class Severity(IntEnum):
    """The severity of a diagnostic, in the order of the Language Server Protocol."""

    ERROR = 1
    WARNING = 2
    INFORMATION = 3
    HINT = 4


@dataclass(frozen=True, slots=True)
class Related:
    """Another place that explains a diagnostic."""

    uri: str
    span: Span
    message: str


@dataclass(frozen=True, slots=True)
class Edit:
    """A change of a text: ``text`` replaces ``span`` in the document ``uri``."""

    uri: str
    span: Span
    text: str


@dataclass(frozen=True, slots=True)
class NewFile:
    """A file that a change creates, with its whole text."""

    uri: str
    text: str


@dataclass(frozen=True, slots=True)
class Fix:
    """A change that fixes a diagnostic, and the file that it creates, if any."""

    title: str
    edits: tuple[Edit, ...]
    new_file: NewFile | None = None


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding about one document.

    ``code`` never changes between versions (``syntax``, ``unknown-name``, ``shacl-…``). ``message`` names the fix if
    there is one.
    """

    uri: str
    span: Span
    severity: Severity
    code: str
    message: str
    related: tuple[Related, ...] = ()
    fixes: tuple[Fix, ...] = ()


def sort_key(diagnostic: Diagnostic) -> tuple[str, Span, int, str, str]:
    """Return a key that sorts diagnostics by place and then by severity, so that their order is always the same."""
    return (diagnostic.uri, diagnostic.span, diagnostic.severity, diagnostic.code, diagnostic.message)
