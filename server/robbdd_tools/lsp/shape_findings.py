"""What the validation process has found in the open files, each finding as long as its text stands."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.lsp.convert import document_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.lsp.worker import Answer
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class _Found:
    """What was found about a file, in itself and in its imports, and the texts that this is about, by URI."""

    diagnostics: tuple[Diagnostic, ...]
    texts: Mapping[str, str]


class ShapeFindings:
    """The newest findings about each open file. The event loop writes, the analysis thread reads."""

    def __init__(self) -> None:
        self._found: dict[str, _Found] = {}
        self._requested: dict[str, Mapping[str, str]] = {}

    def request(self, uri: str, texts: Mapping[str, str]) -> None:
        """Note the texts that the next answer about a file will be about."""
        self._requested[uri] = texts

    def take(self, answer: Answer) -> bool:
        """Take an answer, which is the newest for its file; tells whether there is something to show or to remove."""
        if answer.error:
            return False
        before = self._found.get(answer.uri)
        self._found[answer.uri] = _Found(answer.diagnostics, self._requested[answer.uri])
        return bool(answer.diagnostics or (before and before.diagnostics))

    def forget(self, uri: str) -> None:
        """Drop what is known about a file; an answer about it must not come any more."""
        self._found.pop(uri, None)
        self._requested.pop(uri, None)

    def valid(self, snapshot: Snapshot, uri: str) -> list[Diagnostic]:
        """Return the findings in a file, whichever open file they are about, while its text is the same."""
        text = document_of(snapshot, uri).text
        # A list, since the other thread may add and remove meanwhile.
        about_this = [found for found in list(self._found.values()) if found.texts.get(uri) == text]
        return [diagnostic for found in about_this for diagnostic in found.diagnostics if diagnostic.uri == uri]
