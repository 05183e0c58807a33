"""Cache the diagnostics of each declaration, or scenario of a story, until it or a dependency changes."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.checkpoint import checkpoint
from robbdd_tools.checks.facts import facts_of
from robbdd_tools.names.anchors import Anchored, Anchors
from robbdd_tools.names.elements import Site
from robbdd_tools.names.name_table import changed_paths
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.name_table import NameTable
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.names.scope import Scope
    from robbdd_tools.syntax.declaration import Declaration

Rule = Callable[[Site], "Iterator[Diagnostic]"]
CACHED_FILES = 256
_RULED = (
    tree.ElementSet,
    tree.SimilarSet,
    tree.ConstantSet,
    tree.Template,
    tree.Story,
    tree.Variant,
    tree.Distribution,
    tree.KinematicTree,
    tree.SceneInstance,
    tree.Provider,
    tree.Policy,
    tree.Execution,
)
"""Declarations that rules check."""
_TRANSPARENT = (tree.Scene, tree.Composition, tree.ConstantSet)
"""Declarations whose own references matter to those that refer to them."""
_FOLLOWED = (SymbolKind.SCENE, SymbolKind.COMPOSITION, SymbolKind.CONSTANT_SET)
"""The kinds of their names."""


@dataclass(frozen=True, slots=True)
class _Entry:
    """The cached diagnostics of a declaration.

    They depend on the declarations in ``around``, and on which declarations have the ``names``. ``paths`` are all
    qualified names that the declaration itself looked up.
    """

    names: frozenset[str]
    paths: frozenset[str]
    around: frozenset[Declaration]
    findings: tuple[Anchored, ...]


@dataclass(frozen=True, slots=True)
class _Run:
    """The cached results of a file."""

    scope: Scope
    entries: Mapping[Declaration, _Entry]


_runs: dict[str, _Run] = {}


def findings_in(snapshot: Snapshot, file: FileAnalysis, rules: tuple[Rule, ...]) -> Iterator[Diagnostic]:
    """Yield the diagnostics of rules for the declarations of a file. Unchanged declarations are not checked again."""
    uri = file.document.uri
    scope = snapshot.scope(uri)
    known = _still_valid(_runs.get(uri), scope)
    anchors = Anchors(snapshot)
    entries: dict[Declaration, _Entry] = {}
    for placed in file.parts():
        declaration = placed.declaration
        if not isinstance(declaration.tree, _RULED):
            continue
        entry = entries.get(declaration) or known.get(declaration)
        if entry is None:
            site = Site(snapshot, file, placed)
            found: list[Diagnostic] = []
            for rule in rules:
                checkpoint()
                found += rule(site)
            names, around = _around(scope, declaration)
            loosened = tuple(anchors.loosened(diagnostic, uri, placed) for diagnostic in found)
            entry = _Entry(names, placed.targets.resolution.looked_up, around, loosened)
        entries[declaration] = entry
        for finding in entry.findings:
            yield anchors.fixed(finding, uri, placed)
    if len(_runs) >= CACHED_FILES:
        _runs.clear()
    _runs[uri] = _Run(scope, entries)


def _still_valid(run: _Run | None, scope: Scope) -> Mapping[Declaration, _Entry]:
    """Return the cached entries that no change can have affected."""
    if run is None or run.scope.files[1:] != scope.files[1:]:
        return {}
    before, after = run.scope.own, scope.own
    if before is after:
        return run.entries
    old = {placed.declaration for placed in before.declarations}
    new = {placed.declaration for placed in after.declarations}
    gone = old - new
    if any(map(_is_namespace, old ^ new)):
        # The lookups of a declaration without an explicit namespace do not include the file's namespaces.
        return {}
    paths = _renamed(before.names, after.names)
    names = {path.partition(".")[0] for path in paths}
    return {
        declaration: entry
        for declaration, entry in run.entries.items()
        if gone.isdisjoint(entry.around) and names.isdisjoint(entry.names) and paths.isdisjoint(entry.paths)
    }


def _is_namespace(declaration: Declaration) -> bool:
    return any(symbol.kind is SymbolKind.NAMESPACE for symbol in declaration.symbols[:1])


def _renamed(before: NameTable, after: NameTable) -> set[str]:
    """Return the qualified names whose declarations may differ between two tables.

    Repeated names are included, because their declarations may have a new order.
    """
    if before is after:
        return set()
    paths = changed_paths(before, after)
    paths.update(before.repeated, after.repeated)
    return paths


def _around(scope: Scope, declaration: Declaration) -> tuple[frozenset[str], frozenset[Declaration]]:
    """Return the names on which a declaration depends, and the declarations of these names in its own file.

    Sets and scenes also depend on the declarations to which they refer.
    """
    names: set[str] = {declaration.symbols[0].path} if declaration.symbols else set()
    found: dict[Declaration, None] = {}
    waiting = [declaration]
    for current in waiting:
        heads = facts_of(current).heads
        names |= heads
        for other in (other for head in heads for other in _declared_as(scope, head)):
            if other not in found:
                found[other] = None
                if isinstance(other.tree, _TRANSPARENT):
                    waiting.append(other)
    return frozenset(names), frozenset(found)


def _declared_as(scope: Scope, name: str) -> Iterator[Declaration]:
    """Yield what has a name in the scope's own file, and in others the declarations that are followed.

    Others matter for what they refer to only: findings are not kept when another file changes. In a large scope the
    own file's declaration of a kind hides those of the same name and kind.
    """
    for entry in scope.own.names.entries.get(name, ()):
        yield scope.own.declarations[entry.declaration].declaration
    for kind in _FOLLOWED:
        for file in scope.declaring(name, kind):
            if file is scope.own:
                if scope.is_small:
                    continue
                break
            for entry in file.names.entries[name]:
                if entry.kind is kind:
                    yield file.declarations[entry.declaration].declaration


@contextmanager
def without_cache() -> Generator[None]:
    """Disable the cache inside the block, for comparison."""
    kept = dict(_runs)
    _runs.clear()
    yield
    _runs.clear()
    _runs.update(kept)
