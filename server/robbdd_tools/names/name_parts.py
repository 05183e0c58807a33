"""Find the definition of each part of a written name.

For example, the parts of ``<places.tray_ws>`` are a set and its element.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.names.indirect_names import paths_through
from robbdd_tools.names.resolve import candidates

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import PlacedDeclaration
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.names.scope import Scope
    from robbdd_tools.syntax.declaration import Reference

Part = tuple[Span, "Definition"]


def parts_of(snapshot: Snapshot, uri: str, placed: PlacedDeclaration, reference: Reference) -> Iterator[Part]:
    """Yield each part of a resolved reference, with its absolute span and its definition."""
    target = placed.targets[reference.ref]
    written = reference.ref.path.split(".")
    above = _owners(snapshot, target, len(written) - 1)
    if not f".{target.symbol.path}".endswith(f".{reference.ref.path}"):
        above = _owners_through(snapshot.scope(uri), reference, target)
    start = reference.ref.span.start + placed.offset
    for name, definition in zip(written, (*above, target), strict=True):
        if definition is not None:
            yield Span(start, start + len(name)), definition
        start += len(name) + 1


def find_path(scope: Scope, paths: tuple[str, ...]) -> Definition | None:
    """Return the definition of the first qualified name that has one, directly or through another name, if any."""
    for path in (*paths, *paths_through(scope.standing_for, paths)):
        for file, declared in scope.find(path):
            return scope.define(file, declared)
    return None


def _owners(snapshot: Snapshot, target: Definition, number: int) -> list[Definition | None]:
    """Return the ``number`` nearest declarations that contain a target, outermost first."""
    file = snapshot.file(target.uri)
    path = target.symbol.path.split(".")
    ends = range(len(path) - number, len(path))
    return [None if file is None else file.definitions.get(".".join(path[:end])) for end in ends]


def _owners_through(scope: Scope, reference: Reference, target: Definition) -> list[Definition | None]:
    """Return the definitions of all parts but the last, if one of them resolves through another name."""
    written = reference.ref.path.split(".")
    for full in candidates(reference):
        if target.symbol.path in paths_through(scope.standing_for, (full,)):
            path = full.split(".")
            ends = range(len(path) - len(written) + 1, len(path))
            return [find_path(scope, (".".join(path[:end]),)) for end in ends]
    return [None] * (len(written) - 1)
