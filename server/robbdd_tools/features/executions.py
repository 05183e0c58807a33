"""List the executions of a ``.bddx`` for test trees. They are read from the text of the file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.names.elements import Site, site_of
from robbdd_tools.names.variant_places import PlacedVariant, variants_of
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot

_HOW = (".bddx", ".scenex", ".ktree")
"""Extensions of files that define how to execute scenarios, not what to test."""


@dataclass(frozen=True, slots=True)
class PlacedExecution:
    """An execution in a text: its definition, its syntax tree, its declaration and the variant that it executes."""

    definition: Definition
    iri: str
    site: Site
    node: tree.Execution
    variant: PlacedVariant


def executions_of(snapshot: Snapshot, uri: str) -> Iterator[PlacedExecution]:
    """Yield the executions of a file that have an IRI and a known variant, in text order."""
    file = snapshot.file(uri)
    variants: dict[str, dict[str, PlacedVariant]] = {}
    for placed in file.of(tree.Execution) if file is not None else ():
        node = placed.declaration.tree
        if file is None or not isinstance(node, tree.Execution):
            continue
        site = Site(snapshot, file, placed)
        found, target = file.definitions.get(node.name.text), site.target(node.variant)
        if found is None or found.iri is None or found.span != site.span(node.name) or target is None:
            continue
        if target.uri not in variants:
            variants[target.uri] = {one.definition.symbol.path: one for one in variants_of(snapshot, target.uri)}
        variant = variants[target.uri].get(target.symbol.path)
        if variant is not None:
            yield PlacedExecution(found, found.iri, site, node, variant)


def relevant_declarations(execution: PlacedExecution) -> list[Site]:
    """Return the declaration of an execution and the declarations that it depends on, directly or indirectly.

    Only declarations in files that describe execution are included, sorted by document and position.
    """
    site = execution.site
    found = {(site.uri, site.placed.offset): site}
    fresh = [site]
    while fresh:
        here = fresh.pop()
        targets = (target for target in here.placed.targets.values() if target.uri.endswith(_HOW))
        for other in (site_of(here.snapshot, target) for target in targets):
            if other is not None and found.setdefault((other.uri, other.placed.offset), other) is other:
                fresh.append(other)
    return [found[key] for key in sorted(found)]
