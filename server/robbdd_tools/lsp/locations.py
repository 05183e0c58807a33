"""Client locations of the declarations in a file and its imports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.names.clause_places import clauses_in
from robbdd_tools.names.variant_places import variants_of

if TYPE_CHECKING:
    from lsprotocol import types

    from robbdd_tools.lsp.convert import Converter
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class Places:
    """The client locations of the declarations in a file and its imports (``uris``).

    ``declarations`` are the locations of clauses and variants by IRI. ``rows`` are the locations of table rows by the
    IRI of the variant and the number of the scenario (from 1).
    """

    uris: tuple[str, ...]
    declarations: Mapping[str, types.Location]
    rows: Mapping[tuple[str, int], types.Location]


def places_of(snapshot: Snapshot, convert: Converter, uri: str) -> Places:
    """Return the places of a file and its imports."""
    declarations: dict[str, types.Location] = {}
    rows: dict[tuple[str, int], types.Location] = {}
    uris = tuple(file.document.uri for file in snapshot.closure(uri))
    for name in uris:
        for clause in clauses_in(snapshot, name):
            declarations[clause.iri] = convert.location(snapshot, name, clause.head)
        for variant in variants_of(snapshot, name):
            declarations[variant.iri] = convert.location(snapshot, name, variant.definition.span)
            for number, row in enumerate(variant.rows, start=1):
                rows[variant.iri, number] = convert.location(snapshot, name, row)
    return Places(uris, declarations, rows)
