"""The positions of scenario variants and their table rows in a file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.names.elements import story_sites
from robbdd_tools.names.uses import clauses_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.elements import Site
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class PlacedVariant:
    """A scenario variant: its definition, its syntax tree, its declaration (or a part of one) and its template.

    The template is ``None`` if it is unknown. ``rows`` are the absolute spans of the rows in its table, in the order of
    its scenarios; empty without a table.
    """

    definition: Definition
    iri: str
    site: Site
    node: tree.Variant
    template: Definition | None
    rows: tuple[Span, ...]


def variants_of(snapshot: Snapshot, uri: str) -> Iterator[PlacedVariant]:
    """Yield the variants of a file that have an IRI, in text order."""
    file = snapshot.file(uri)
    if file is None:
        return
    for site in story_sites(snapshot, file):
        for clauses in clauses_of(site.placed.declaration):
            node, found = clauses.node, file.definitions.get(clauses.path)
            if not isinstance(node, tree.Variant) or found is None or found.iri is None:
                continue
            if found.span != site.span(node.name):
                continue
            template = site.target(node.template)
            known = template if template is not None and template.kind is SymbolKind.TEMPLATE else None
            written = node.variation.rows if isinstance(node.variation, tree.Table) else ()
            yield PlacedVariant(found, found.iri, site, node, known, tuple(map(site.span, written)))
