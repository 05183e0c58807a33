"""Resolve references. They are resolved again only if an edit may have changed the result."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from robbdd_tools.base.checkpoint import checkpoint
from robbdd_tools.names.definition import Definition
from robbdd_tools.names.indirect_names import ELEMENT_ROLES, ROLES, paths_through
from robbdd_tools.names.roles import ROLE_KINDS
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.move import moved_ref, moved_reference

if TYPE_CHECKING:
    from robbdd_tools.names.name_table import NameTable
    from robbdd_tools.names.scope import Scope
    from robbdd_tools.syntax.declaration import Declaration, Reference
    from robbdd_tools.syntax.tree import Ref

CACHED_TABLES = 4


@dataclass(frozen=True, slots=True)
class Target:
    """A declaration: the URI of its file, its path, and its index among that path's declarations."""

    file: str
    path: str
    number: int


@dataclass(frozen=True, slots=True)
class Unresolved:
    """A reference without a matching target. ``other`` is a declaration of the same name and of another kind."""

    reference: Reference
    other: Target | None


@dataclass(frozen=True, eq=False, slots=True, weakref_slot=True)
class Resolution:
    """The targets of the references in one declaration.

    ``looked_up`` are all paths on which the result depends. ``through_others`` is true if the result also depends on
    names that resolve through other names, which ``looked_up`` does not contain. The resolution of a declaration in
    parts combines the resolutions of its ``parts``, and only these have ``looked_up``. A resolution stays the same
    object as long as no edit may have changed it.
    """

    declaration: Declaration
    targets: Mapping[Ref, Target]
    unresolved: tuple[Unresolved, ...]
    looked_up: frozenset[str]
    through_others: bool
    parts: tuple[Resolution, ...] = ()


class _InParts(Mapping["Ref", Target]):
    """The targets of the references in a declaration that has parts."""

    __slots__ = ("_offsets", "_parts")

    def __init__(self, declaration: Declaration, parts: tuple[Resolution, ...]) -> None:
        self._offsets = [placed.offset for placed in declaration.parts]
        self._parts = parts

    def __getitem__(self, ref: Ref) -> Target:
        position = bisect_right(self._offsets, ref.span.start) - 1
        if position < 0:
            raise KeyError(ref)
        return self._parts[position].targets[moved_ref(ref, -self._offsets[position])]

    def __iter__(self) -> Iterator[Ref]:
        for offset, part in zip(self._offsets, self._parts, strict=True):
            for ref in part.targets:
                yield moved_ref(ref, offset)

    def __len__(self) -> int:
        return sum(len(part.targets) for part in self._parts)


class Targets(Mapping["Ref", Definition]):
    """The definitions of the references in one declaration. They are made when they are accessed.

    ``made`` caches the definitions for all declarations of a file, because many of them refer to the same few names.
    """

    __slots__ = ("_made", "_scope", "_targets", "resolution")

    def __init__(self, scope: Scope, resolution: Resolution, made: dict[Target, Definition]) -> None:
        self._scope = scope
        self.resolution = resolution
        self._targets = resolution.targets
        self._made = made

    def __getitem__(self, ref: Ref) -> Definition:
        target = self._targets[ref]
        found = self._made.get(target)
        if found is None:
            found = self._made[target] = define(self._scope, target)
        return found

    def __contains__(self, ref: object) -> bool:
        return ref in self._targets

    def __iter__(self) -> Iterator[Ref]:
        return iter(self._targets)

    def __len__(self) -> int:
        return len(self._targets)

    def parts(self) -> tuple[Targets, ...]:
        """Return the definitions of the references in each part of the declaration."""
        return tuple([Targets(self._scope, part, self._made) for part in self.resolution.parts])

    def declarations(self) -> Iterator[tuple[str, int, str]]:
        """Yield for each reference the document that declares its target, the declaration's position, and the path."""
        for target in self._targets.values():
            file = self._scope.file(target.file)
            yield file.document.uri, file.names.entries[target.path][target.number].declaration, target.path


def define(scope: Scope, target: Target) -> Definition:
    """Return the definition of a target."""
    file = scope.file(target.file)
    return scope.define(file, file.at(file.names.entries[target.path][target.number]))


def resolve_file(scope: Scope, before: Scope | None, known: tuple[Resolution, ...]) -> tuple[Resolution, ...]:
    """Resolve all declarations of the file to which a scope belongs.

    ``before`` is the scope of the previous revision, and ``known`` are the resolutions in it.
    """
    declarations = [placed.declaration for placed in scope.own.declarations]
    kept = _still_valid(scope, before, known)
    whole = {entry.declaration: entry for entry in known if entry.parts}
    return tuple(
        _put_together(scope, declaration, kept, whole.get(declaration))
        if declaration.parts
        else kept.get(declaration) or _resolve(scope, declaration)
        for declaration in declarations
    )


def _put_together(
    scope: Scope, declaration: Declaration, kept: Mapping[Declaration, Resolution], before: Resolution | None
) -> Resolution:
    """Return the resolution of a declaration that has parts. If no part has changed, this is ``before`` itself."""
    parts = tuple(kept.get(part.declaration) or _resolve(scope, part.declaration) for part in declaration.parts)
    if before is not None and before.parts == parts:
        return before
    unresolved = tuple(
        Unresolved(moved_reference(problem.reference, placed.offset), problem.other)
        for placed, part in zip(declaration.parts, parts, strict=True)
        for problem in part.unresolved
    )
    return Resolution(declaration, _InParts(declaration, parts), unresolved, frozenset(), False, parts)


def _still_valid(scope: Scope, before: Scope | None, known: tuple[Resolution, ...]) -> dict[Declaration, Resolution]:
    changed = None if before is None or not known else scope.changed_names(before)
    if changed is None:
        return {}
    every = (part for entry in known for part in entry.parts or (entry,))
    return {
        entry.declaration: entry for entry in every if not entry.through_others and changed.isdisjoint(entry.looked_up)
    }


def _resolve(scope: Scope, declaration: Declaration) -> Resolution:
    targets: dict[Ref, Target] = {}
    unresolved: list[Unresolved] = []
    looked_up: set[str] = set()
    through_others = False
    known: _Lookups = _known_lookups(scope.tables) if scope.is_small else {}
    for reference in declaration.references:
        checkpoint()
        ref = reference.ref
        key = (ref.role, ref.path, reference.scopes)
        if key not in known:
            paths = candidates(reference)
            known[key] = (paths, *_lookup(scope, ref.role, paths))
        paths, found, other = known[key]
        looked_up.update(paths)
        if found is None and ref.role in ELEMENT_ROLES:
            owners = {path.rpartition(".")[0] for path in paths}
            looked_up |= owners
            if any(SymbolKind.SCENE in file.names.kinds[owner] for owner in owners for file in scope.declaring(owner)):
                through_others = True
                found, other = _lookup_in_scene(scope, ref.role, paths)
        elif found is None and ref.role in ROLES:
            through_others = True
            found, other = _lookup(scope, ref.role, (*paths, *paths_through(scope.standing_for, paths)))
        if found is not None:
            targets[ref] = found
        else:
            unresolved.append(Unresolved(reference, other))
    return Resolution(declaration, targets, tuple(unresolved), frozenset(looked_up), through_others)


def candidates(reference: Reference) -> tuple[str, ...]:
    """Return the qualified names that a reference may denote, first names in the innermost scope."""
    path = reference.ref.path
    return (*[f"{scope}.{path}" for scope in reference.scopes], path)


_Lookups = dict[tuple[str, str, tuple[str, ...]], tuple[tuple[str, ...], Target | None, Target | None]]


@lru_cache(maxsize=CACHED_TABLES)
def _known_lookups(_: tuple[NameTable, ...]) -> _Lookups:
    """Return the cache of lookups in some tables, by role, path and scopes. It is valid as long as no name changes."""
    return {}


def _lookup_in_scene(scope: Scope, role: str, paths: tuple[str, ...]) -> tuple[Target | None, Target | None]:
    """Return the element of a scene with one of some names. If several elements have it, return none."""
    found = [_lookup(scope, role, (path,)) for path in paths_through(scope.standing_for, paths)]
    fitting = {target for target, _ in found if target is not None}
    others = (other for _, other in found if other is not None)
    return (fitting.pop(), None) if len(fitting) == 1 else (None, None if fitting else next(others, None))


def _lookup(scope: Scope, role: str, paths: tuple[str, ...]) -> tuple[Target | None, Target | None]:
    """Return the nearest declaration of a matching kind. If there is none, return the nearest one of another kind."""
    kinds = ROLE_KINDS[role]
    other: Target | None = None
    for path in paths:
        for file in scope.declaring(path):
            for number, kind in enumerate(file.names.kinds[path]):
                target = Target(file.document.uri, path, number)
                if kind in kinds:
                    return target, None
                other = other or target
    return None, other
