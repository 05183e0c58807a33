"""The findings of the validation process about open files. Their places are moved along with later edits."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.document import Span, edited_part
from robbdd_tools.lsp.convert import document_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from robbdd_tools.lsp.framing import Answer
    from robbdd_tools.names.project import Snapshot

UNCHECKED = "the shapes were not checked, because of an internal error: {}; they will be after the next change"


@dataclass(frozen=True, slots=True)
class _Found:
    """The findings about a file and its imports, and the texts (by URI) to which they refer."""

    revision: int
    diagnostics: tuple[Diagnostic, ...]
    texts: Mapping[str, str]


class ShapeFindings:
    """The latest findings about each open file. The event loop writes them, and the analysis thread reads them."""

    def __init__(self) -> None:
        self._found: dict[str, _Found] = {}
        self._requested: dict[str, dict[int, Mapping[str, str]]] = {}

    def request(self, uri: str, revision: int, texts: Mapping[str, str]) -> None:
        """Record the texts to which the answer about a file will refer."""
        self._requested.setdefault(uri, {})[revision] = texts

    def take(self, answer: Answer) -> bool:
        """Store an answer. Return whether diagnostics must be shown or removed because of it."""
        requested = self._requested.get(answer.uri, {})
        before = self._found.get(answer.uri)
        if answer.revision not in requested or (before is not None and before.revision > answer.revision):
            return False
        diagnostics = answer.diagnostics
        if answer.error:
            message = UNCHECKED.format(answer.error)
            diagnostics = (Diagnostic(answer.uri, Span(0, 0), Severity.WARNING, "shapes-unchecked", message),)
        self._found[answer.uri] = _Found(answer.revision, diagnostics, requested[answer.revision])
        self._requested[answer.uri] = {
            revision: texts for revision, texts in requested.items() if revision > answer.revision
        }
        return bool(diagnostics or (before and before.diagnostics))

    def forget(self, uri: str) -> None:
        """Drop the findings about a file. A later answer about it is ignored."""
        self._found.pop(uri, None)
        self._requested.pop(uri, None)

    def valid(self, snapshot: Snapshot, uri: str) -> list[Diagnostic]:
        """Return the findings in a file, except those at places where the text has changed since the validation.

        Findings from the validation of all open files are included.
        """
        text = document_of(snapshot, uri).text
        # A list, since the other thread may add and remove entries meanwhile.
        return [one for found in list(self._found.values()) for one in _in_place(found, uri, text)]


def _in_place(found: _Found, uri: str, text: str) -> Iterator[Diagnostic]:
    """Yield the findings in a file at their places in its current text."""
    old = found.texts.get(uri)
    here = [one for one in found.diagnostics if one.uri == uri] if old is not None else []
    if old is None or not here or old == text:
        yield from here
        return
    start, end = edited_part(old, text)
    grown = len(text) - len(old)
    for one in here:
        span = _moved(one.span, start, end, grown)
        if span is not None:
            # Related places and fixes come with the next answer.
            yield replace(one, span=span, related=(), fixes=())


def _moved(span: Span, start: int, end: int, grown: int) -> Span | None:
    """Return the place of a span after an edit between ``start`` and ``end`` that made the text longer by ``grown``.

    Returns ``None`` if the edit touches the span.
    """
    if span.end < start:
        return span
    return span.shifted(grown) if span.start > end else None
