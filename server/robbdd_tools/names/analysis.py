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


@dataclass(frozen=True)
class PlacedDeclaration:
    """A declaration at its offset in a document.

    ``targets`` maps its references to their definitions, without the references that cannot be resolved.
    """

    declaration: Declaration
    offset: int
    targets: Targets

    @property
    def span(self) -> Span:
        """The absolute span of the declaration's text."""
        return Span(self.offset, self.offset + len(self.declaration.text))

    @cached_property
    def parts(self) -> tuple[PlacedDeclaration, ...]:
        """The parts of the declaration at their places in the document; the declaration itself if it has no parts."""
        inner = self.declaration.parts
        if not inner:
            return (self,)
        return tuple(
            PlacedDeclaration(part.declaration, self.offset + part.offset, targets)
            for part, targets in zip(inner, self.targets.parts(), strict=True)
        )


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
        return tuple(part for placed in self.declarations for part in placed.parts)

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
