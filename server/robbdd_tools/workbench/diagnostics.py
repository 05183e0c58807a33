"""Diagnostics for users outside the core, with files, lines and columns instead of offsets."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Severity
from robbdd_tools.base.document import Document, Span
from robbdd_tools.base.files import read_text, uri_to_path
from robbdd_tools.names.index import FileIndex
from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class Place:
    """A range of text. Lines and columns count from 1, columns in code points; the end is exclusive."""

    uri: str
    line: int
    column: int
    end_line: int
    end_column: int

    @property
    def path(self) -> Path | None:
        """The path of the file, or ``None`` for a text without a file."""
        return uri_to_path(self.uri)

    @property
    def file(self) -> str:
        """The file as text: relative to the working directory if it is below it, otherwise its full path or URI."""
        path = self.path
        if path is None:
            return self.uri
        return str(path.relative_to(Path.cwd())) if path.is_relative_to(Path.cwd()) else str(path)

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"

    def as_json(self) -> dict[str, Any]:
        """Return the file and the range in the documented JSON form."""
        start = {"line": self.line, "column": self.column}
        end = {"line": self.end_line, "column": self.end_column}
        return {"file": self.file, "range": {"start": start, "end": end}}


@dataclass(frozen=True, slots=True)
class RelatedPlace:
    """Another place that explains a finding."""

    place: Place
    message: str


@dataclass(frozen=True, slots=True)
class TextEdit:
    """A change of a text: ``text`` replaces the range ``place``."""

    place: Place
    text: str


@dataclass(frozen=True, slots=True)
class QuickFix:
    """A change that removes a finding. ``new_files`` are pairs of the URI and the text of a file to create."""

    title: str
    edits: tuple[TextEdit, ...]
    new_files: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Finding:
    """One diagnostic. ``code`` never changes between versions and has a page in ``docs/diagnostics``."""

    place: Place
    severity: Severity
    code: str
    message: str
    related: tuple[RelatedPlace, ...] = ()
    fixes: tuple[QuickFix, ...] = ()

    @property
    def is_error(self) -> bool:
        """Whether the finding is an error, so that the model cannot be run."""
        return self.severity is Severity.ERROR

    def __str__(self) -> str:
        return f"{self.place}: {self.severity.name.lower()}: {self.message} [{self.code}]"

    def as_json(self) -> dict[str, Any]:
        """Return the finding as an object of ``docs/schemas/diagnostic.schema.json``."""
        return {
            **self.place.as_json(),
            "severity": self.severity.name.lower(),
            "code": self.code,
            "message": self.message,
            "related": [{**one.place.as_json(), "message": one.message} for one in self.related],
            "fixes": [_fix_json(fix) for fix in self.fixes],
        }


def findings(snapshot: Snapshot, diagnostics: Iterable[Diagnostic]) -> tuple[Finding, ...]:
    """Return a snapshot's diagnostics with lines and columns."""
    places = Places(snapshot)
    return tuple(_finding(places, diagnostic) for diagnostic in diagnostics)


class Places:
    """Converts offsets to places. Each file that is not a model (shapes, settings) is read once."""

    def __init__(self, snapshot: Snapshot) -> None:
        self._snapshot = snapshot
        self._others: dict[str, Document] = {}

    def of(self, uri: str, span: Span) -> Place:
        """Return the place of a span in a file."""
        document = self._document(uri)
        start, end = document.position(span.start), document.position(span.end)
        return Place(uri, start.line + 1, start.column + 1, end.line + 1, end.column + 1)

    def _document(self, uri: str) -> Document:
        source = self._snapshot.sources.get(uri)
        if isinstance(source, FileIndex):
            return source.document
        if uri not in self._others:
            path = uri_to_path(uri)
            text = read_text(path) if path is not None and source is None else ""
            self._others[uri] = Document(uri, 0, text if isinstance(text, str) else "")
        return self._others[uri]


def _finding(places: Places, diagnostic: Diagnostic) -> Finding:
    return Finding(
        places.of(diagnostic.uri, diagnostic.span),
        diagnostic.severity,
        diagnostic.code,
        diagnostic.message,
        tuple(RelatedPlace(places.of(one.uri, one.span), one.message) for one in diagnostic.related),
        tuple(_quick_fix(places, fix) for fix in diagnostic.fixes),
    )


def _quick_fix(places: Places, fix: Fix) -> QuickFix:
    made = () if fix.new_file is None else ((fix.new_file.uri, fix.new_file.text),)
    return QuickFix(fix.title, tuple(_text_edit(places, edit) for edit in fix.edits), made)


def _text_edit(places: Places, edit: Edit) -> TextEdit:
    return TextEdit(places.of(edit.uri, edit.span), edit.text)


def _fix_json(fix: QuickFix) -> dict[str, Any]:
    return {
        "title": fix.title,
        "edits": [{**edit.place.as_json(), "text": edit.text} for edit in fix.edits],
        "new_files": [{"uri": uri, "text": text} for uri, text in fix.new_files],
    }
