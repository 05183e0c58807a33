"""Keeps the findings in a declaration while neither it nor anything it builds on changes."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Generator, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix, Related
from robbdd_tools.checks.facts import facts_of
from robbdd_tools.names.elements import Site
from robbdd_tools.names.table import changed_paths
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.index import FileIndex
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.names.scope import Scope
    from robbdd_tools.names.table import NameTable
    from robbdd_tools.syntax.declaration import Declaration

Rule = Callable[[Site], "Iterator[Diagnostic]"]
KEPT_FILES = 256
_RULED = (tree.ElementSet, tree.ConstantSet, tree.Template, tree.Story)
"""Declarations that rules look at."""
_TRANSPARENT = (tree.Scene, tree.Composition, tree.ConstantSet)
"""Declarations whose own references matter to those that refer to them."""


@dataclass(frozen=True, slots=True)
class _Anchor:
    """The declaration that a span counts from."""

    uri: str
    declaration: Declaration


@dataclass(frozen=True, slots=True)
class _Entry:
    """Findings with spans that count from their anchors, in the order diagnostic, related places, edits.

    They depend on the declarations in ``around`` and on which declarations have the ``names``.
    """

    names: frozenset[str]
    around: frozenset[Declaration]
    findings: tuple[tuple[Diagnostic, tuple[_Anchor, ...]], ...]


@dataclass(frozen=True, slots=True)
class _Run:
    """What was found in a file the last time."""

    scope: Scope
    entries: Mapping[Declaration, _Entry]


_runs: dict[str, _Run] = {}


def findings_in(snapshot: Snapshot, file: FileAnalysis, rules: tuple[Rule, ...]) -> Iterator[Diagnostic]:
    """Yield what the rules find in the declarations of a file; unchanged ones are not looked at again."""
    uri = file.document.uri
    scope = snapshot.scope(uri)
    known = _still_valid(_runs.get(uri), scope)
    places = _Places(snapshot)
    entries: dict[Declaration, _Entry] = {}
    for placed in file.declarations:
        declaration = placed.declaration
        if not isinstance(declaration.tree, _RULED):
            continue
        entry = entries.get(declaration) or known.get(declaration)
        if entry is None:
            site = Site(snapshot, file, placed)
            found = [diagnostic for rule in rules for diagnostic in rule(site)]
            names, around = _around(scope, declaration)
            entry = _Entry(names, around, tuple(places.loosened(diagnostic, site) for diagnostic in found))
        entries[declaration] = entry
        for diagnostic, anchors in entry.findings:
            yield places.fixed(diagnostic, anchors, uri, placed)
    if len(_runs) >= KEPT_FILES:
        _runs.clear()
    _runs[uri] = _Run(scope, entries)


def _still_valid(run: _Run | None, scope: Scope) -> Mapping[Declaration, _Entry]:
    """Return the entries of the last time that no change can have touched."""
    if run is None or run.scope.files[1:] != scope.files[1:]:
        return {}
    before, after = run.scope.files[0], scope.files[0]
    if before is after:
        return run.entries
    old = {placed.declaration for placed in before.declarations}
    new = {placed.declaration for placed in after.declarations}
    gone = old - new
    if any(map(_is_namespace, old ^ new)):
        # What leaves its namespace to the file does not name it.
        return {}
    renamed = _renamed(before.names, after.names)
    return {
        declaration: entry
        for declaration, entry in run.entries.items()
        if gone.isdisjoint(entry.around) and renamed.isdisjoint(entry.names)
    }


def _is_namespace(declaration: Declaration) -> bool:
    return any(symbol.kind is SymbolKind.NAMESPACE for symbol in declaration.symbols[:1])


def _renamed(before: NameTable, after: NameTable) -> set[str]:
    """Return the names of declarations that two tables may not agree on; repeated ones may have changed places."""
    if before is after:
        return set()
    paths = changed_paths(before, after)
    paths.update(path for table in (before, after) for path, _ in table.repeated())
    return {path.partition(".")[0] for path in paths}


def _around(scope: Scope, declaration: Declaration) -> tuple[frozenset[str], frozenset[Declaration]]:
    """Return the names that a declaration depends on, and which declarations these stand for in its own file.

    Sets and scenes depend on what they refer to in turn.
    """
    names: set[str] = {declaration.symbols[0].path} if declaration.symbols else set()
    found: dict[Declaration, None] = {}
    waiting = [declaration]
    for current in waiting:
        heads = facts_of(current).heads
        names |= heads
        for other in (other for head in heads for file in scope.files for other in _declared(file, head)):
            if other not in found:
                found[other] = None
                if isinstance(other.tree, _TRANSPARENT):
                    waiting.append(other)
    return frozenset(names), frozenset(found)


def _declared(file: FileIndex, name: str) -> Iterator[Declaration]:
    for entry in file.names.entries.get(name, ()):
        yield file.declarations[entry.declaration].declaration


@dataclass(frozen=True, slots=True)
class _Places:
    """Turns absolute places into ones that stay valid wherever their declarations move to, and back."""

    snapshot: Snapshot

    def loosened(self, diagnostic: Diagnostic, site: Site) -> tuple[Diagnostic, tuple[_Anchor, ...]]:
        """Return a diagnostic with spans that count from the anchors beside it."""
        anchors: list[_Anchor] = []

        def loosen(uri: str, span: Span) -> Span:
            placed = site.placed if uri == site.uri and _holds(site.placed, span) else self._placed(uri, span)
            anchors.append(_Anchor(uri, placed.declaration))
            return span.shifted(-placed.offset)

        return _moved(diagnostic, loosen), tuple(anchors)

    def fixed(
        self, diagnostic: Diagnostic, anchors: tuple[_Anchor, ...], uri: str, placed: PlacedDeclaration
    ) -> Diagnostic:
        """Return a diagnostic with the places that its anchors have now."""
        following = iter(anchors)

        def fix(_: str, span: Span) -> Span:
            anchor = next(following)
            own = anchor.uri == uri and anchor.declaration is placed.declaration
            return span.shifted(placed.offset if own else self._offset(anchor))

        return _moved(diagnostic, fix)

    def _placed(self, uri: str, span: Span) -> PlacedDeclaration:
        declarations = self._declarations(uri)
        return declarations[bisect_right(declarations, span.start, key=lambda placed: placed.offset) - 1]

    def _offset(self, anchor: _Anchor) -> int:
        declarations = self._declarations(anchor.uri)
        return next(placed.offset for placed in declarations if placed.declaration is anchor.declaration)

    def _declarations(self, uri: str) -> tuple[PlacedDeclaration, ...]:
        file = self.snapshot.file(uri)
        assert file is not None  # A finding only names files that were read.
        return file.declarations


def _holds(placed: PlacedDeclaration, span: Span) -> bool:
    return placed.span.start <= span.start and span.end <= placed.span.end


def _moved(diagnostic: Diagnostic, move: Callable[[str, Span], Span]) -> Diagnostic:
    return replace(
        diagnostic,
        span=move(diagnostic.uri, diagnostic.span),
        related=tuple(Related(place.uri, move(place.uri, place.span), place.message) for place in diagnostic.related),
        fixes=tuple(
            Fix(fix.title, tuple(Edit(edit.uri, move(edit.uri, edit.span), edit.text) for edit in fix.edits))
            for fix in diagnostic.fixes
        ),
    )


@contextmanager
def nothing_kept() -> Generator[None]:
    """Look at everything afresh for a while, to compare with."""
    kept = dict(_runs)
    _runs.clear()
    yield
    _runs.clear()
    _runs.update(kept)
