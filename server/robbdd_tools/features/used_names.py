"""Find the places where names are used. They are cached for each declaration until an edit may have changed them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

from robbdd_tools.base.checkpoint import checkpoint
from robbdd_tools.names.name_parts import parts_of
from robbdd_tools.names.name_table import changed_paths

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.name_table import NameTable
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.names.resolve import Resolution

Name = tuple[str, str]
"""The document and the qualified name of a definition."""


@dataclass(frozen=True, slots=True)
class _Known:
    """The cached uses of a declaration. They depend on its targets and on the names ``paths`` in ``tables``."""

    tables: tuple[NameTable, ...]
    paths: frozenset[str]
    uses: Mapping[Name, tuple[Span, ...]]


_known: WeakKeyDictionary[Resolution, _Known] = WeakKeyDictionary()


def name_of(definition: Definition) -> Name:
    """Return the document and the qualified name of a definition."""
    return definition.uri, definition.symbol.path


def uses_by_part(
    snapshot: Snapshot, file: FileAnalysis, name: Name
) -> Iterator[tuple[PlacedDeclaration, tuple[Span, ...]]]:
    """Yield the declarations, or parts of them, that use a name, in text order, and their uses.

    The spans count from the start of the declaration. A place that means the name without containing it is left out.
    """
    if not _word(name[1].rpartition(".")[2]).search(file.document.text):
        return  # in a large cycle of imports, the name tables of a file are those of all files
    tables = snapshot.scope(file.document.uri).tables
    for placed in file.parts():
        checkpoint()
        spans = _uses_in(snapshot, file, placed, tables).get(name)
        if spans is not None:
            yield placed, spans


@lru_cache(maxsize=8)
def _word(name: str) -> re.Pattern[str]:
    return re.compile(rf"(?<![\w\-]){re.escape(name)}(?![\w\-])")


def places_of(snapshot: Snapshot, file: FileAnalysis, name: Name) -> Iterator[Span]:
    """Yield the absolute spans where a file uses a name, in text order."""
    return (span.shifted(part.offset) for part, spans in uses_by_part(snapshot, file, name) for span in spans)


def _uses_in(
    snapshot: Snapshot, file: FileAnalysis, placed: PlacedDeclaration, tables: tuple[NameTable, ...]
) -> Mapping[Name, tuple[Span, ...]]:
    """Return the places where a declaration writes each name that it uses, alone or as a part of a qualified name.

    The spans count from the start of the declaration.
    """
    resolution = placed.targets.resolution
    known = _known.get(resolution)
    if known is not None:
        if known.tables == tables:
            return known.uses
        if len(known.tables) == len(tables) and known.paths.isdisjoint(_changed(known.tables, tables)):
            _known[resolution] = _Known(tables, known.paths, known.uses)
            return known.uses
    uses: dict[Name, set[Span]] = {}
    paths: set[str] = set()
    for reference in placed.declaration.references:
        if reference.ref not in placed.targets:
            continue
        for span, meant in parts_of(snapshot, file.document.uri, placed, reference):
            if meant.symbol.name in reference.ref.path:
                uses.setdefault((meant.uri, meant.symbol.path), set()).add(span.shifted(-placed.offset))
        path = placed.targets[reference.ref].symbol.path.split(".")
        paths.update(".".join(path[:end]) for end in range(1, len(path)))
    found = {name: tuple(sorted(spans)) for name, spans in uses.items()}
    if not resolution.through_others:
        _known[resolution] = _Known(tables, frozenset(paths), found)
    return found


@lru_cache(maxsize=2)
def _changed(before: tuple[NameTable, ...], after: tuple[NameTable, ...]) -> frozenset[str]:
    pairs = zip(before, after, strict=True)
    return frozenset(path for old, new in pairs for path in changed_paths(old, new))
