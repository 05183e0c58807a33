"""Cache a value for each declaration, or each scenario of a story, until it or one of its dependencies changes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Set
from dataclasses import dataclass
from typing import TYPE_CHECKING, Generic, TypeVar

from robbdd_tools.checks.facts import facts_of
from robbdd_tools.checks.file_caches import FileCache
from robbdd_tools.names.elements import Site
from robbdd_tools.names.name_table import changed_paths
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.name_table import NameTable
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.names.scope import Scope
    from robbdd_tools.syntax.declaration import Declaration

Value = TypeVar("Value")
_TRANSPARENT = (tree.Scene, tree.Composition, tree.ConstantSet)
"""Declarations that pass on dependencies: a reference to one is also a dependency on its own references."""
_FOLLOWED = (SymbolKind.SCENE, SymbolKind.COMPOSITION, SymbolKind.CONSTANT_SET)
"""The kinds of the names of ``_TRANSPARENT`` declarations."""


@dataclass(frozen=True, slots=True)
class _Entry(Generic[Value]):
    """The cached value of a declaration.

    The value depends on the declarations in ``around`` and on the declarations of the ``names``. ``paths`` are all
    qualified names that the declaration itself looked up.
    """

    names: frozenset[str]
    paths: frozenset[str]
    around: frozenset[Declaration]
    value: Value


@dataclass(frozen=True, slots=True)
class _Run(Generic[Value]):
    """The cached values of a file."""

    scope: Scope
    entries: Mapping[Declaration, _Entry[Value]]


class Kept(Generic[Value]):
    """Values of the declarations with certain syntax trees. The values of unchanged declarations are cached.

    ``make`` returns the value of a declaration. The value may depend on this declaration, on all declarations that it
    names, and on the sets and scenes that these name. It must not contain absolute positions.
    """

    def __init__(self, trees: Set[type[object]], make: Callable[[Site], Value]) -> None:
        self._trees = trees
        self._make = make
        self._runs = FileCache[_Run[Value]]()

    def of(self, snapshot: Snapshot, file: FileAnalysis) -> Iterator[tuple[PlacedDeclaration, Value]]:
        """Yield the declarations of a file, or their parts, with their values."""
        uri = file.document.uri
        scope = snapshot.scope(uri)
        known = _still_valid(self._runs.get(uri), scope)
        entries: dict[Declaration, _Entry[Value]] = {}
        for placed in file.parts():
            declaration = placed.declaration
            if type(declaration.tree) not in self._trees:
                continue
            entry = entries.get(declaration) or known.get(declaration)
            if entry is None:
                value = self._make(Site(snapshot, file, placed))
                names, around = _around(scope, declaration)
                entry = _Entry(names, placed.targets.resolution.looked_up, around, value)
            entries[declaration] = entry
            yield placed, entry.value
        self._runs.put(uri, _Run(scope, entries))


def _still_valid(run: _Run[Value] | None, scope: Scope) -> Mapping[Declaration, _Entry[Value]]:
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
    """Yield the declarations of a name in the scope's own file, and the sets and scenes of this name in other files.

    Other files matter only for the names to which their declarations refer, because findings are dropped when another
    file changes. In a large scope, a declaration in the own file hides others of the same name and kind.
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
