"""Did you mean: the known names nearest to one that was written."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

from robbdd_tools.names.scope import shortened

if TYPE_CHECKING:
    from robbdd_tools.names.table import NameTable
    from robbdd_tools.syntax.declaration import SymbolKind

MOST = 3
LEAST_ALIKE = 60.0
"""Per cent of alikeness (normalised insertions and deletions) below which a name is no suggestion."""


@lru_cache(maxsize=1024)
def closest(
    tables: tuple[NameTable, ...], kinds: tuple[SymbolKind, ...], scopes: tuple[str, ...], path: str
) -> tuple[tuple[str, ...], bool]:
    """Return the nearest names of some kinds as they would be written at a place, and whether any is known at all.

    The answer depends on the tables only (compared by identity), so it is kept while no name changes.
    """
    from rapidfuzz import process
    from rapidfuzz.fuzz import ratio

    names: dict[str, None] = {}
    for position, table in enumerate(tables):
        for known, found in table.kinds.items():
            if not set(found).isdisjoint(kinds):
                names.setdefault(shortened(known, scopes) if position == 0 else known)
    near = process.extract(path, sorted(names), scorer=ratio, limit=MOST, score_cutoff=LEAST_ALIKE)
    return tuple(name for name, _, _ in near), bool(names)
