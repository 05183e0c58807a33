"""``catalog-phrase``: the text of a ``pred("…")`` is a catalog predicate's phrase and is judged as this predicate."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Severity
from robbdd_tools.checks.no_evaluator import unjudged
from robbdd_tools.checks.said_texts import Fit, said_phrases
from robbdd_tools.names.elements import Site
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.checks.no_evaluator import Unjudged
    from robbdd_tools.checks.said_texts import SaidPhrase
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot

CODE = "catalog-phrase"


def catalog_phrase(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each such text for which there is neither a step function nor a policy."""
    for found in unjudged(snapshot, file):
        said = said_phrases(Site(snapshot, file, found.placed), found.clause)
        if said:
            # A phrase of which only some values fit would be wrong in the other scenarios.
            offered = said if len(said) == 1 else [one for one in said if one.fit is not Fit.SOME]
            fixes = tuple(_fix(file, found, one.written) for one in offered)
            yield Diagnostic(file.document.uri, found.span, Severity.INFORMATION, CODE, _message(said), fixes=fixes)


def _message(said: Sequence[SaidPhrase]) -> str:
    advice = "write the phrase itself, so that they are checked while editing"
    if len(said) > 1:
        phrases = " or ".join(f"'{one.predicate.phrase}'" for one in said)
        return f"the kinds of this text's values decide in each scenario if it is judged as {phrases}: {advice}"
    phrase = said[0].predicate.phrase
    if said[0].fit is Fit.ALL:
        return f"this text is judged as '{phrase}', because its values have the kinds of this phrase: {advice}"
    return f"this text is judged as '{phrase}' if its values fit, and is unknown otherwise: {advice}"


def _fix(file: FileAnalysis, found: Unjudged, written: str) -> Fix:
    assert isinstance(found.clause, tree.Fluent)
    span = found.clause.predicate.span.shifted(found.placed.offset)
    return Fix(f"Write '{written}'", (Edit(file.document.uri, span, written),))
