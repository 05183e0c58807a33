"""``no-scenario``: a ``.bdd`` file that holds neither a scenario nor anything that another file could use."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.names.index import language_of
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis


def no_scenario(analysis: FileAnalysis) -> Iterator[Diagnostic]:
    """Tell once, at the start of the file, that there is nothing to run."""
    uri = analysis.document.uri
    kinds = {definition.kind for definition in analysis.definitions.values()}
    if language_of(uri) == "bdd" and SymbolKind.VARIANT not in kinds:
        first_line = analysis.document.line_text(0)
        yield Diagnostic(
            uri,
            Span(0, len(first_line)),
            Severity.INFORMATION,
            "no-scenario",
            "this file has no scenario to run: a 'User Story' with a 'Scenario' would make one",
        )
