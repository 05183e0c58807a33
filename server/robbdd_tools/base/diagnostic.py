"""Diagnostics and their fixes."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

from robbdd_tools.base.document import Span


class Severity(IntEnum):
    """Severity of a diagnostic, ordered as in the Language Server Protocol."""

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
    """Replace ``span`` of the document ``uri`` by ``text``."""

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
    """A change that is known to fix a diagnostic, and the file that it creates, if any."""

    title: str
    edits: tuple[Edit, ...]
    new_file: NewFile | None = None


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding about one document.

    ``code`` is stable (``syntax``, ``unknown-name``, ``shacl-…``); ``message`` names the fix if there is one.
    """

    uri: str
    span: Span
    severity: Severity
    code: str
    message: str
    related: tuple[Related, ...] = ()
    fixes: tuple[Fix, ...] = ()


def sort_key(diagnostic: Diagnostic) -> tuple[str, Span, int, str, str]:
    """Order diagnostics by place, then severity, so that every output is the same for the same text."""
    return (diagnostic.uri, diagnostic.span, diagnostic.severity, diagnostic.code, diagnostic.message)
