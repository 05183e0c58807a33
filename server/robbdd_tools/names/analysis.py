"""The analysis of one file in one revision: its declarations, the targets of its references, and its diagnostics."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.base.document import Document
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.resolve import Targets
    from robbdd_tools.syntax.declaration import Declaration


@dataclass(frozen=True, slots=True)
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

    @property
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


@dataclass(frozen=True, slots=True)
class FileAnalysis:
    """One file of a snapshot. ``definitions`` maps qualified names to this file's own declarations."""

    document: Document
    declarations: tuple[PlacedDeclaration, ...]
    imports: tuple[ImportLink, ...]
    definitions: Mapping[str, Definition]
    diagnostics: tuple[Diagnostic, ...]

    def parts(self, within: Span | None = None) -> Iterator[PlacedDeclaration]:
        """Yield the declarations, or their parts, that touch a span of the document. ``None`` is the whole document."""
        for placed in self.declarations:
            if within is None or (placed.offset <= within.end and within.start <= placed.span.end):
                for part in placed.parts:
                    if within is None or (part.offset <= within.end and within.start <= part.span.end):
                        yield part

    def part_at(self, offset: int) -> PlacedDeclaration | None:
        """Return the last declaration, or part of one, that begins at or before an offset."""
        position = bisect_right(self.declarations, offset, key=_offset) - 1
        if position < 0:
            return None
        parts = self.declarations[position].parts
        return parts[bisect_right(parts, offset, key=_offset) - 1]


def _offset(placed: PlacedDeclaration) -> int:
    return placed.offset
