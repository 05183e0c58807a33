"""Resolve names through another name: parts of trees, clauses of a variant, and elements of a scene.

- ``ktree inst … arm of <gen3>`` makes every part of the template a part of the instance (``arm.base.origin``).
- ``tree <arm>`` inside a tree makes that part ``cell.arm.base.origin``.
- A clause of a variant may be named without its user story.
- An element of a scene may be named by the scene (``lab_scene.cube``).

All these names are declared under another path. This module finds that path.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.names.index import Declared, FileIndex
    from robbdd_tools.syntax.declaration import Declaration

ELEMENT_ROLES = frozenset({"Element", "Object", "Workspace", "Agent"})
ROLES = ELEMENT_ROLES | {"Frame", "Body", "Joint", "Tree", "Fluent"}
"""Roles of references that may resolve through another name."""
MAX_PATHS = 50
"""Maximum number of paths tried for one reference, because trees may contain one another."""
_PARTS = frozenset({SymbolKind.BODY, SymbolKind.FRAME, SymbolKind.POSE, SymbolKind.JOINT})


def paths_through(standing_for: Callable[[str], Iterable[str]], paths: Iterable[str]) -> list[str]:
    """Return the paths under which the targets of some qualified names may be declared, nearest first.

    ``standing_for`` returns the targets of an alias.
    """
    waiting = list(paths)
    found: dict[str, None] = {}
    for path in waiting:
        for other in _rewritten(standing_for, path):
            if other not in found and len(found) < MAX_PATHS:
                found[other] = None
                waiting.append(other)
    return list(found)


def instance_parts(
    files: Sequence[FileIndex], kinds: Iterable[SymbolKind]
) -> Iterator[tuple[str, FileIndex, Declared]]:
    """Yield the name of each part of each tree instance, with the declaration of the part in the template."""
    wanted = _PARTS.intersection(kinds)
    if not wanted:
        return
    for name, target in instances(files):
        for file in files:
            for path, entries in file.names.entries.items():
                if path.startswith(f"{target}."):
                    fitting = (entry for entry in entries if entry.kind in wanted)
                    for entry in fitting:
                        yield name + path[len(target) :], file, file.at(entry)


def instances(files: Sequence[FileIndex]) -> Iterator[tuple[str, str]]:
    """Yield the name of each tree instance and of its template."""
    for file in files:
        for placed in file.declarations:
            for symbol in placed.declaration.symbols[:1]:
                if symbol.target is not None:
                    yield symbol.path, symbol.target


def _rewritten(standing_for: Callable[[str], Iterable[str]], path: str) -> Iterator[str]:
    """Replace an alias at the beginning of a path by its targets."""
    parts = path.split(".")
    for length in range(1, len(parts) + 1):
        head, rest = ".".join(parts[:length]), path[len(".".join(parts[:length])) :]
        for target in standing_for(head):
            yield target + rest


@kept_with_key
def targets_in(file: FileIndex) -> Mapping[str, tuple[str, ...]]:
    """Map each alias in a file to its targets."""
    found: dict[str, tuple[str, ...]] = {}
    for placed in file.declarations:
        for name, target in _aliases(placed.declaration):
            found[name] = (*found.get(name, ()), target)
    return found


@kept_with_key
def _aliases(declaration: Declaration) -> tuple[tuple[str, str], ...]:
    return tuple(_of_declaration(declaration))


@kept_with_key
def _variants_in(declaration: Declaration) -> tuple[tuple[str, str], ...]:
    variants = (symbol for symbol in declaration.symbols if symbol.kind is SymbolKind.VARIANT)
    return tuple((variant.name, variant.path) for variant in variants)


def _of_declaration(declaration: Declaration) -> Iterator[tuple[str, str]]:
    root = declaration.tree
    for symbol in declaration.symbols[:1]:
        if symbol.target is not None:
            yield symbol.path, symbol.target
        elif symbol.kind is SymbolKind.STORY:
            for part in [placed.declaration for placed in declaration.parts] or [declaration]:
                yield from _variants_in(part)
    if isinstance(root, tree.Scene):
        yield from ((root.name.text, entry.reference.path) for entry in root.entries)
    elif isinstance(root, tree.Composition):
        yield from _composed(root)
    elif isinstance(root, tree.KinematicTree):
        yield from _used_trees(root.name.text, root)
    elif isinstance(root, tree.SceneInstance):
        for entry in root.entries:
            if isinstance(entry, tree.Graph):
                yield from _used_trees(f"{root.name.text}.{entry.name.text}", entry)


def _composed(composition: tree.Composition) -> Iterator[tuple[str, str]]:
    """Yield the alias and the target of each element of a composition and of the compositions in it.

    The alias is the name of the element in a scene.
    """
    held = [entry.reference for entry in composition.entries]
    for ref in (composition.workspace, *held):
        if ref.role == "Composition":
            yield composition.name.text, ref.path
        else:
            yield f"{composition.name.text}.{ref.path.rpartition('.')[2]}", ref.path


def _used_trees(path: str, owner: tree.KinematicTree | tree.Graph) -> Iterator[tuple[str, str]]:
    for entry in owner.entries:
        if isinstance(entry, tree.TreeUse):
            yield f"{path}.{entry.reference.path.rpartition('.')[2]}", entry.reference.path
