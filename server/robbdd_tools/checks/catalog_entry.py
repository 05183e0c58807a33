"""``catalog-entry``: ``catalog "…"`` names an entry that the installed catalog lacks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from difflib import get_close_matches
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Severity
from robbdd_tools.catalog.executors import EXECUTORS
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.names.index import language_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot

CODE = "catalog-entry"


def known_entries(language: str) -> Mapping[str, object]:
    """Return the entries that ``catalog "…"`` may name in a kind of file: executors in a ``.bddx``, else models."""
    catalog = load_catalog()
    return EXECUTORS if language == "bddx" else {**catalog.robots, **catalog.objects}


def catalog_entry(_: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each model or behaviour that the catalog lacks."""
    for placed in file.of(tree.SceneInstance, tree.Implementation):
        root = placed.declaration.tree
        if not isinstance(root, tree.SceneInstance | tree.Implementation):
            continue
        known = known_entries(language_of(file.document.uri))
        what = "behaviour" if isinstance(root, tree.Implementation) else "model"
        for node in walk(root):
            if isinstance(node, tree.CatalogEntry) and node.name.value not in known:
                yield _unknown(file.document.uri, node.name, placed.offset, what, known)


def not_in_catalog(what: str, name: str, known: Mapping[str, object]) -> tuple[str, list[str]]:
    """Return the message on a name that the catalog lacks, and the names of the most similar entries."""
    close = get_close_matches(name, known, n=3, cutoff=0.6)
    message = f"the catalog has no {what} '{name}'"
    return message + (f"; did you mean '{close[0]}'?" if close else f": it has {', '.join(sorted(known))}"), close


def _unknown(uri: str, name: tree.Text, offset: int, what: str, known: Mapping[str, object]) -> Diagnostic:
    span = name.span.shifted(offset)
    message, close = not_in_catalog(what, name.value, known)
    fixes = tuple(Fix(f"Change to '{choice}'", (Edit(uri, span, f'"{choice}"'),)) for choice in close)
    return Diagnostic(uri, span, Severity.ERROR, CODE, message, fixes=fixes)
