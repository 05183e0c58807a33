"""The positions of scenario variants and their table rows in a file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.names.elements import story_sites
from robbdd_tools.names.namespaces import namespace_of
from robbdd_tools.names.scope import local_name
from robbdd_tools.names.uses import clauses_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.elements import Site
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration, Symbol


@dataclass(frozen=True, slots=True)
class PlacedVariant:
    """A scenario variant: its definition, its syntax tree, its declaration (or a part of one) and its template.

    The template is ``None`` if it is unknown. ``rows`` are the absolute spans of its table rows in the order of the
    scenarios. They are empty if the variant has no table.
    """

    definition: Definition
    iri: str
    site: Site
    node: tree.Variant
    template: Definition | None
    rows: tuple[Span, ...]


def variants_of(snapshot: Snapshot, uri: str, within: Span | None = None) -> Iterator[PlacedVariant]:
    """Yield the variants of a file that have an IRI, in text order. If a span is given, they must touch it."""
    file = snapshot.file(uri)
    if file is None:
        return
    for site in story_sites(snapshot, file, within):
        for clauses in clauses_of(site.placed.declaration):
            node, found = clauses.node, file.definitions.get(clauses.path)
            if not isinstance(node, tree.Variant) or found is None or found.iri is None:
                continue
            if found.span != site.span(node.name):
                continue
            template = site.target(node.template)
            known = template if template is not None and template.kind is SymbolKind.TEMPLATE else None
            written = node.variation.rows if isinstance(node.variation, tree.Table) else ()
            if within is None or (found.extent.start <= within.end and within.start <= found.extent.end):
                yield PlacedVariant(found, found.iri, site, node, known, tuple(map(site.span, written)))


class VariantIris:
    """The IRIs of the variants of a file without positions, so that variants are not searched after each keystroke."""

    def __init__(self, snapshot: Snapshot, file: FileAnalysis) -> None:
        self._file = file
        self._scope = snapshot.scope(file.document.uri)
        self._repeated = frozenset(self._scope.own.names.repeated)
        self._starts: dict[str | None, str | None] = {}

    def of(self, placed: PlacedDeclaration) -> tuple[str | None, ...]:
        """Return the IRI of each variant of a story or of a part of a story, in text order; ``None`` if it has none."""
        return tuple([self._iri(placed, *found) for found in _declared(placed.declaration)])

    def _iri(self, placed: PlacedDeclaration, symbol: Symbol | None, name: Span) -> str | None:
        if symbol is None:
            return None
        if symbol.path in self._repeated:
            # The first of several declarations of a name has the IRI.
            found = self._file.definitions[symbol.path]
            return found.iri if found.span == name.shifted(placed.offset) else None
        if symbol.namespace not in self._starts:
            own = self._scope.own
            self._starts[symbol.namespace] = self._scope.namespace_iri(own, namespace_of(own, symbol))
        start = self._starts[symbol.namespace]
        return None if start is None else start + local_name(symbol)


@kept_with_key
def _declared(declaration: Declaration) -> tuple[tuple[Symbol | None, Span], ...]:
    """Return the name that each variant declares, with the place of the variant's name in the declaration."""
    symbols = {symbol.span: symbol for symbol in declaration.symbols if symbol.kind is SymbolKind.VARIANT}
    variants = (clauses.node for clauses in clauses_of(declaration))
    return tuple((symbols.get(node.name.span), node.name.span) for node in variants)
