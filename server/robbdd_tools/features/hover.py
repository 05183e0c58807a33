"""Hover: what a name is, and its IRI."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.features.definition import symbol_at
from robbdd_tools.names.roles import ROLE_KINDS
from robbdd_tools.names.types import variable_type
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.symbols import walk
from robbdd_tools.syntax.tree import PhraseUse

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import Definition
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class Hover:
    """Markdown about the text in ``span`` (absolute)."""

    markdown: str
    span: Span


def hover(snapshot: Snapshot, uri: str, offset: int) -> Hover | None:
    """Describe the name under a cursor, else the phrase of the catalog around it."""
    found = symbol_at(snapshot, uri, offset)
    if found is not None:
        return Hover(_about(snapshot, found[1]), found[0])
    return _phrase(snapshot, uri, offset)


def _about(snapshot: Snapshot, definition: Definition) -> str:
    lines = [f"**{definition.kind}** `{definition.symbol.path}`"]
    if definition.kind in ROLE_KINDS["Variable"]:
        found = variable_type(snapshot, definition)
        lines[0] += f": {found}" if found.is_known else ""
    if definition.iri is not None and definition.kind is not SymbolKind.NAMESPACE:
        lines.append(f"`<{definition.iri}>`")
    return "\n\n".join(lines)


def _phrase(snapshot: Snapshot, uri: str, offset: int) -> Hover | None:
    analysis = snapshot.file(uri)
    catalog = load_catalog()
    for placed in analysis.declarations if analysis is not None else ():
        root = placed.declaration.tree
        if root is None or not placed.span.contains(offset):
            continue
        for node in walk(root):
            if isinstance(node, PhraseUse) and node.span.shifted(placed.offset).contains(offset):
                word = catalog.predicates.get(node.word) or catalog.behaviours[node.word]
                return Hover(f"`{word.phrase}`\n\n{word.doc}", node.span.shifted(placed.offset))
    return None
