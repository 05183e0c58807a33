"""The target of a reference."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.syntax.declaration import Symbol, SymbolKind


@dataclass(frozen=True, slots=True)
class Definition:
    """A declared name. ``span`` and ``extent`` are absolute in the document ``uri``.

    ``iri`` is ``None`` while the namespace of the declaration is unknown.
    """

    uri: str
    symbol: Symbol
    span: Span
    extent: Span
    iri: str | None

    @property
    def kind(self) -> SymbolKind:
        """The kind of the declared name."""
        return self.symbol.kind
