"""References: everywhere a name is used, in every file of the project that can see it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.checkpoint import checkpoint
from robbdd_tools.base.document import Span
from robbdd_tools.features.definition import symbol_at

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import Definition
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class Use:
    """A reference in a document: its absolute span, the path as written, and the definition that it leads to."""

    uri: str
    span: Span
    written: str
    target: Definition


def references(snapshot: Snapshot, uri: str, offset: int, with_declaration: bool) -> list[tuple[str, Span]]:
    """Return the places that use the name under a cursor, in the order of files and places."""
    found = symbol_at(snapshot, uri, offset)
    if found is None:
        return []
    definition = found[1]
    places = {(use.uri, use.span) for use in uses(snapshot, definition) if _same(use.target, definition)}
    if with_declaration:
        places.add((definition.uri, definition.span))
    return sorted(places)


def highlights(snapshot: Snapshot, uri: str, offset: int) -> list[Span]:
    """Return the places of the name under a cursor within its own document."""
    return [span for found, span in references(snapshot, uri, offset, with_declaration=True) if found == uri]


def uses(snapshot: Snapshot, definition: Definition) -> Iterator[Use]:
    """Yield every reference to a definition or to a part of it (a template's variable, a set's element)."""
    name, path = definition.symbol.name, definition.symbol.path
    for uri in sorted({definition.uri, *snapshot.importers(definition.uri)}):
        analysis = snapshot.file(uri)
        for placed in analysis.declarations if analysis is not None else ():
            checkpoint()
            for ref in placed.targets:
                # Reading the written name is cheap; only what may mean the definition is followed.
                if name not in ref.path and not ref.path.startswith(path):
                    continue
                target = placed.targets[ref]
                if target.uri == definition.uri and f"{target.symbol.path}.".startswith(f"{path}."):
                    yield Use(uri, ref.span.shifted(placed.offset), ref.path, target)


def _same(one: Definition, other: Definition) -> bool:
    return one.uri == other.uri and one.symbol.path == other.symbol.path
