"""Where scenarios stand in a file: what a Run button belongs to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class RunnableScenario:
    """A scenario variant: name, IRI, the absolute spans of its name and of its whole text."""

    name: str
    iri: str
    span: Span
    extent: Span


def runnable_scenarios(snapshot: Snapshot, uri: str) -> list[RunnableScenario]:
    """Return the scenario variants that a file declares, in the order of the text."""
    analysis = snapshot.file(uri)
    definitions = analysis.definitions.values() if analysis is not None else ()
    return [
        RunnableScenario(found.symbol.name, found.iri, found.span, found.extent)
        for found in definitions
        if found.kind is SymbolKind.VARIANT and found.iri is not None
    ]
