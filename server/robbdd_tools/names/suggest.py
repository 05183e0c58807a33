"""Suggestions ("did you mean"): the known names most similar to a written one."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

from robbdd_tools.names.scope import shortened

if TYPE_CHECKING:
    from robbdd_tools.names.name_table import NameTable
    from robbdd_tools.syntax.declaration import SymbolKind

MAX_OFFERED = 3
CACHED_TABLES = 4
MIN_ALIKE = 60.0
"""Minimum similarity of a suggestion, per cent (normalised insertions and deletions)."""


def closest(
    tables: tuple[NameTable, ...], kinds: tuple[SymbolKind, ...], scopes: tuple[str, ...], path: str
) -> tuple[tuple[str, ...], bool]:
    """Return the known names most similar to a written one, and whether any name of these kinds is known.

    The names have the form in which they can be written inside ``scopes``. The result depends only on the tables, which
    are compared by identity, so it is cached while no name changes.
    """
    kept = _known_answers(tables)
    key = (kinds, scopes, path)
    if key not in kept:
        kept[key] = _closest(tables, *key)
    return kept[key]


_Answer = tuple[tuple[str, ...], bool]


@lru_cache(maxsize=CACHED_TABLES)
def _known_answers(_: tuple[NameTable, ...]) -> dict[tuple[tuple[SymbolKind, ...], tuple[str, ...], str], _Answer]:
    return {}


def _closest(
    tables: tuple[NameTable, ...], kinds: tuple[SymbolKind, ...], scopes: tuple[str, ...], path: str
) -> _Answer:
    names: dict[str, None] = {}
    for position, table in enumerate(tables):
        for known, found in table.kinds.items():
            if not set(found).isdisjoint(kinds):
                names.setdefault(shortened(known, scopes) if position == 0 else known)
    return similar(path, sorted(names)), bool(names)


def similar(written: str, names: Sequence[str]) -> tuple[str, ...]:
    """Return the names most similar to a written one, the most similar first."""
    from rapidfuzz import process
    from rapidfuzz.fuzz import ratio

    near = process.extract(written, names, scorer=ratio, limit=MAX_OFFERED, score_cutoff=MIN_ALIKE)
    return tuple(name for name, _, _ in near)
