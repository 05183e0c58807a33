"""Store the positions in diagnostics relative to declarations, so that they stay valid when the declarations move."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Related

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.analysis import PlacedDeclaration
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration


@dataclass(frozen=True, slots=True)
class Anchor:
    """The declaration to which a span is relative. It is ``None`` in a file without declarations."""

    uri: str
    declaration: Declaration | None


@dataclass(frozen=True, slots=True)
class Anchored:
    """A diagnostic with relative spans. The anchors are in the order diagnostic, related places, edits."""

    diagnostic: Diagnostic
    anchors: tuple[Anchor, ...]


@dataclass(frozen=True, slots=True)
class Anchors:
    """Converts absolute spans to spans relative to declarations, and back."""

    snapshot: Snapshot

    def loosened(self, diagnostic: Diagnostic, uri: str, own: PlacedDeclaration) -> Anchored:
        """Return a diagnostic about the declaration ``own`` with relative instead of absolute spans."""
        anchors: list[Anchor] = []

        def loosen(file: str, span: Span) -> Span:
            placed = own if file == uri and _holds(own, span) else self._placed(file, span)
            anchors.append(Anchor(file, None if placed is None else placed.declaration))
            return span if placed is None else span.shifted(-placed.offset)

        return Anchored(_moved(diagnostic, loosen), tuple(anchors))

    def fixed(self, anchored: Anchored, uri: str, own: PlacedDeclaration) -> Diagnostic:
        """Return a diagnostic about the declaration ``own`` with absolute spans at its anchors' current places."""
        following = iter(anchored.anchors)

        def fix(_: str, span: Span) -> Span:
            anchor = next(following)
            is_own = anchor.uri == uri and anchor.declaration is own.declaration
            return span.shifted(own.offset if is_own else self._offset(anchor))

        return _moved(anchored.diagnostic, fix)

    def _placed(self, uri: str, span: Span) -> PlacedDeclaration | None:
        file = self.snapshot.file(uri)
        return None if file is None else file.part_at(span.start)

    def _offset(self, anchor: Anchor) -> int:
        file = None if anchor.declaration is None else self.snapshot.file(anchor.uri)
        parts = () if file is None else file.parts()
        return next((placed.offset for placed in parts if placed.declaration is anchor.declaration), 0)


def _holds(placed: PlacedDeclaration, span: Span) -> bool:
    return placed.span.start <= span.start and span.end <= placed.span.end


def _moved(diagnostic: Diagnostic, move: Callable[[str, Span], Span]) -> Diagnostic:
    return replace(
        diagnostic,
        span=move(diagnostic.uri, diagnostic.span),
        related=tuple(Related(place.uri, move(place.uri, place.span), place.message) for place in diagnostic.related),
        fixes=tuple(
            replace(fix, edits=tuple(Edit(edit.uri, move(edit.uri, edit.span), edit.text) for edit in fix.edits))
            for fix in diagnostic.fixes
        ),
    )
