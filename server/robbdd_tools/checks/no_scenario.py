"""``no-scenario``: a ``.bdd`` file contains neither a scenario nor anything that another file could use."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.names.index import language_of
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot


def no_scenario(_: Snapshot, analysis: FileAnalysis) -> Iterator[Diagnostic]:
    """Report once, at the start of the file, that there is nothing to run."""
    uri = analysis.document.uri
    if language_of(uri) == "bdd" and not _has_variant(analysis):
        first_line = analysis.document.line_text(0)
        yield Diagnostic(
            uri,
            Span(0, len(first_line)),
            Severity.INFORMATION,
            "no-scenario",
            "this file has no scenario to run: a 'User Story' with a 'Scenario' would make one",
        )


def _has_variant(analysis: FileAnalysis) -> bool:
    """Search from the end of the file, where stories usually are."""
    symbols = (symbol for placed in reversed(analysis.declarations) for symbol in placed.declaration.symbols)
    return any(symbol.kind is SymbolKind.VARIANT for symbol in symbols)
