"""References: everywhere a name is used, in every file of the project that can see it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.checkpoint import checkpoint
from robbdd_tools.base.document import Span
from robbdd_tools.features.definition import symbol_at
from robbdd_tools.names.types import columns_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import Definition, FileAnalysis
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class Use:
    """A reference in a document: its absolute span, the path as written, and the definition that it leads to."""

    uri: str
    span: Span
    written: str
    target: Definition


@dataclass(frozen=True, slots=True)
class Highlight:
    """A place of a name; it ``writes`` where the name is declared or a variation gives values to the variable."""

    span: Span
    writes: bool


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


def highlights(snapshot: Snapshot, uri: str, offset: int) -> list[Highlight]:
    """Return the places of the name under a cursor within its own document, in their order."""
    found = symbol_at(snapshot, uri, offset)
    file = snapshot.file(uri)
    if found is None or file is None:
        return []
    definition = found[1]
    spans = {use.span for use in _uses_in(file, definition) if _same(use.target, definition)}
    written = _written(file) if definition.kind in (SymbolKind.VARIABLE, SymbolKind.SET_VARIABLE) else set[Span]()
    if definition.uri == uri:
        spans.add(definition.span)
        written.add(definition.span)
    return [Highlight(span, span in written) for span in sorted(spans)]


def _written(file: FileAnalysis) -> set[Span]:
    """Return where the variations of a file name the variables that they give values to."""
    return {
        ref.span.shifted(placed.offset)
        for placed in file.declarations
        if isinstance(placed.declaration.tree, tree.Story)
        for variant in placed.declaration.tree.variants
        for ref, _ in columns_of(variant.variation)
    }


def uses(snapshot: Snapshot, definition: Definition) -> Iterator[Use]:
    """Yield every reference to a definition or to a part of it (a template's variable, a set's element)."""
    for uri in sorted({definition.uri, *snapshot.importers(definition.uri)}):
        file = snapshot.file(uri)
        if file is not None:
            yield from _uses_in(file, definition)


def _uses_in(file: FileAnalysis, definition: Definition) -> Iterator[Use]:
    name, path = definition.symbol.name, definition.symbol.path
    for placed in file.declarations:
        checkpoint()
        for ref in placed.targets:
            # Reading the written name is cheap; only what may mean the definition is followed.
            if name not in ref.path and not ref.path.startswith(path):
                continue
            target = placed.targets[ref]
            if target.uri == definition.uri and f"{target.symbol.path}.".startswith(f"{path}."):
                yield Use(file.document.uri, ref.span.shifted(placed.offset), ref.path, target)


def _same(one: Definition, other: Definition) -> bool:
    return one.uri == other.uri and one.symbol.path == other.symbol.path
