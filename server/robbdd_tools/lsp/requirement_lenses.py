"""Code lenses of requirements: their coverage, their last verdicts, and a command to run their scenarios."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from lsprotocol import types

from robbdd_tools.features.clause_results import verdict_of
from robbdd_tools.features.requirement_results import coverage_of_file
from robbdd_tools.lsp.commands import RUN
from robbdd_tools.lsp.convert import Converter, document_of

if TYPE_CHECKING:
    from robbdd_tools.features.run_verdicts import Findings
    from robbdd_tools.names.project import Snapshot


def requirement_lenses(
    convert: Converter, snapshot: Snapshot, uri: str, findings: Findings
) -> Iterator[types.CodeLens]:
    """Yield the lenses of the requirements of a file, in text order.

    As a run has only one model, scenarios in several files cannot be run together.
    """
    for one in coverage_of_file(snapshot, uri, findings):
        place = convert.range(document_of(snapshot, uri), one.requirement.span)
        models = {entry.verifier.variant.definition.uri for entry in one.evidence}
        if len(models) == 1:
            only = [{"variant": entry.verifier.variant.iri} for entry in one.evidence]
            target = {"uri": models.pop(), "only": only}
            yield types.CodeLens(place, types.Command(title="Run", command=RUN, arguments=[target]))
        stale = any(entry.stale for entry in one.evidence)
        data = {"verdict": verdict_of(one.outcome), "stale": stale} if one.outcome else None
        # A lens without a command is plain text.
        yield types.CodeLens(place, types.Command(title=one.label, command=""), data=data)
