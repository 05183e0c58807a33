"""``catalog-phrase``: the text of a ``pred("…")`` is a catalog predicate's phrase and is judged as this predicate."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Severity
from robbdd_tools.checks.no_evaluator import said_by, unjudged
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.checks.no_evaluator import Unjudged
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot

CODE = "catalog-phrase"


def catalog_phrase(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each such text for which there is neither a step function nor a policy."""
    for found in unjudged(snapshot, file):
        said = said_by(found.clause)
        if said is not None:
            predicate, written = said
            message = (
                f"this text is judged as '{predicate.phrase}' if its values fit, and is unknown otherwise: write the "
                "phrase itself, so that they are checked while editing"
            )
            fix = _fix(file, found, written)
            yield Diagnostic(file.document.uri, found.span, Severity.INFORMATION, CODE, message, fixes=(fix,))


def _fix(file: FileAnalysis, found: Unjudged, written: str) -> Fix:
    assert isinstance(found.clause, tree.Fluent)
    span = found.clause.predicate.span.shifted(found.placed.offset)
    return Fix(f"Write '{written}'", (Edit(file.document.uri, span, written),))
