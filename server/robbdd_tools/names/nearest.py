"""Suggestions ("did you mean") for references that may resolve through another name."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.names.indirect_names import ROLES, instances
from robbdd_tools.names.suggest import closest

if TYPE_CHECKING:
    from robbdd_tools.names.scope import Scope
    from robbdd_tools.syntax.declaration import Reference, SymbolKind


def nearest(scope: Scope, reference: Reference, kinds: tuple[SymbolKind, ...]) -> tuple[tuple[str, ...], bool]:
    """Return the same as ``closest`` for a reference, but consider also names that resolve through another name.

    In a large scope, only the nearest files are searched.
    """
    path = reference.ref.path
    tables = tuple(file.names for file in scope.nearest)
    if reference.ref.role in ROLES:
        for name, target in instances(scope.nearest):
            if path.startswith(f"{name}."):
                close, _ = closest(tables, kinds, (), target + path[len(name) :])
                parts = tuple(name + other[len(target) :] for other in close if other.startswith(f"{target}."))
                if parts:
                    return parts, True
    close, any_known = closest(tables, kinds, reference.scopes, path)
    return close, any_known or not scope.is_small
