"""The analysis of one file in one revision: its declarations, the targets of its references, and its diagnostics."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.base.document import Document
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.resolve import Targets
    from robbdd_tools.syntax.declaration import Declaration
    from robbdd_tools.syntax.tree import Node


@dataclass(slots=True, eq=False)
class PlacedDeclaration:
    """A declaration at its offset in a document. It never changes; thousands of them are made after each keystroke.

    ``targets`` maps its references to their definitions, without the references that cannot be resolved.
    """

    declaration: Declaration
    offset: int
    targets: Targets
    _parts: tuple[PlacedDeclaration, ...] = ()

    @property
    def span(self) -> Span:
        """The absolute span of the declaration's text."""
        return Span(self.offset, self.offset + len(self.declaration.text))

    @property
    def parts(self) -> tuple[PlacedDeclaration, ...]:
        """The parts of the declaration at their places in the document; the declaration itself if it has no parts."""
        inner = self.declaration.parts
        if not inner:
            return (self,)
        if not self._parts:
            placed = zip(inner, self.targets.parts(), strict=True)
            start = self.offset
            self._parts = tuple([PlacedDeclaration(one.declaration, start + one.offset, used) for one, used in placed])
        return self._parts


@dataclass(frozen=True, slots=True)
class ImportLink:
    """An import: the span of its path, the imported file and, if it cannot be used, the reason."""

    span: Span
    uri: str
    problem: str | None


@dataclass(frozen=True)
class FileAnalysis:
    """One file of a snapshot. ``definitions`` maps qualified names to this file's own declarations."""

    document: Document
    declarations: tuple[PlacedDeclaration, ...]
    imports: tuple[ImportLink, ...]
    definitions: Mapping[str, Definition]
    diagnostics: tuple[Diagnostic, ...]

    @cached_property
    def _parts(self) -> tuple[PlacedDeclaration, ...]:
        found: list[PlacedDeclaration] = []
        for placed in self.declarations:
            if placed.declaration.parts:
                found += placed.parts
            else:
                found.append(placed)
        return tuple(found)

    @cached_property
    def _by_tree(self) -> Mapping[type[object], list[PlacedDeclaration]]:
        found: dict[type[object], list[PlacedDeclaration]] = {}
        for placed in self.declarations:
            found.setdefault(type(placed.declaration.tree), []).append(placed)
        return found

    def of(self, *trees: type[Node]) -> Sequence[PlacedDeclaration]:
        """Return the declarations with certain syntax trees, in text order. Stories are not split into parts."""
        found = [placed for kind in trees for placed in self._by_tree.get(kind, ())]
        return found if len(trees) == 1 else sorted(found, key=_offset)

    def parts(self, within: Span | None = None) -> Sequence[PlacedDeclaration]:
        """Return the declarations, or their parts, that touch a span of the document; by default, all of them."""
        if within is None:
            return self._parts
        # Neither declarations nor their parts overlap.
        first = max(0, bisect_right(self._parts, within.start, key=_offset) - 1)
        while first and self._parts[first - 1].span.end >= within.start:
            first -= 1
        last = bisect_right(self._parts, within.end, key=_offset)
        return [part for part in self._parts[first:last] if within.start <= part.span.end]

    def part_at(self, offset: int) -> PlacedDeclaration | None:
        """Return the last declaration, or part of one, that begins at or before an offset."""
        position = bisect_right(self.declarations, offset, key=_offset) - 1
        if position < 0:
            return None
        parts = self.declarations[position].parts
        return parts[bisect_right(parts, offset, key=_offset) - 1]


def _offset(placed: PlacedDeclaration) -> int:
    return placed.offset
