"""Answer requests about a model while it has errors. The last answer made from a text without errors is used."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.lsp.convert import document_of

if TYPE_CHECKING:
    from robbdd_tools.names.project import Snapshot

Json = dict[str, Any]


class LastValid:
    """Stores the last answer made from a text without errors, by document and further keys."""

    def __init__(self) -> None:
        self._kept: dict[str, dict[Hashable, Json]] = {}

    def of(
        self, snapshot: Snapshot, uri: str, key: Hashable, make: Callable[[], Json]
    ) -> tuple[Json | None, str | None]:
        """Return an answer about a document, and its first error.

        If the text has no error, the answer is the result of ``make``, and the error is ``None``. Otherwise the answer
        is the last one that was made from a text without errors, or ``None``.
        """
        problem = first_problem(snapshot, uri)
        kept = self._kept.setdefault(uri, {})
        if problem is None:
            kept[key] = make()
            return kept[key], None
        return kept.get(key), problem

    def forget(self, uri: str) -> None:
        """Drop the answers of a document."""
        self._kept.pop(uri, None)


def first_problem(snapshot: Snapshot, uri: str) -> str | None:
    """Return the first error of a document or of a file that it imports, with its place; ``None`` if there is none."""
    error = _first_error(snapshot, uri)
    return None if error is None else _described(snapshot, uri, error)


def _first_error(snapshot: Snapshot, uri: str) -> Diagnostic | None:
    for file in snapshot.closure(uri) if snapshot.file(uri) is not None else ():
        for found in fast_diagnostics(snapshot, file.document.uri):
            if found.severity is Severity.ERROR:
                return found
    return None


def _described(snapshot: Snapshot, uri: str, error: Diagnostic) -> str:
    place = document_of(snapshot, error.uri).position(error.span.start)
    problem = f"line {place.line + 1}: {error.message}"
    return problem if error.uri == uri else f"{error.uri.rsplit('/', 1)[-1]}, {problem}"
