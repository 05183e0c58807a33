"""What is known of one file in one revision: declarations in place, targets of references, diagnostics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.base.document import Document
    from robbdd_tools.names.resolve import Targets
    from robbdd_tools.syntax.declaration import Declaration, Symbol


@dataclass(frozen=True, slots=True)
class Definition:
    """Where a name is declared: ``span`` and ``extent`` are absolute in the document ``uri``.

    ``iri`` is ``None`` while the namespace of the declaration is unknown.
    """

    uri: str
    symbol: Symbol
    span: Span
    extent: Span
    iri: str | None

    @property
    def kind(self) -> SymbolKind:
        """What the name stands for."""
        return self.symbol.kind


@dataclass(frozen=True, slots=True)
class PlacedDeclaration:
    """A declaration at its offset in a document, with the definitions its references lead to.

    ``targets`` lacks a reference that leads nowhere.
    """

    declaration: Declaration
    offset: int
    targets: Targets

    @property
    def span(self) -> Span:
        """The chunk's absolute span."""
        return Span(self.offset, self.offset + len(self.declaration.text))


@dataclass(frozen=True, slots=True)
class ImportLink:
    """An import: the span of its path, the file it means, and why that cannot be used, if so."""

    span: Span
    uri: str
    problem: str | None


@dataclass(frozen=True, slots=True)
class FileAnalysis:
    """One file of a snapshot. ``definitions`` maps qualified names to what this file itself declares."""

    document: Document
    declarations: tuple[PlacedDeclaration, ...]
    imports: tuple[ImportLink, ...]
    definitions: Mapping[str, Definition]
    diagnostics: tuple[Diagnostic, ...]
