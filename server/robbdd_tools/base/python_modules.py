"""Find Python modules and the names in them from files and syntax trees. Nothing is imported or executed."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from importlib.machinery import BuiltinImporter, FrozenImporter, PathFinder
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import UnreadableFile, file_state, load_text, path_to_uri
from robbdd_tools.base.interpreter import inherited_paths

if TYPE_CHECKING:
    from importlib.machinery import ModuleSpec

    from robbdd_tools.base.files import FileState


@dataclass(frozen=True, slots=True)
class ModuleNames:
    """The names that a module binds at its top level.

    ``is_complete`` is false if other code may bind more: ``from … import *``, ``__getattr__``, ``globals()``. ``error``
    is the syntax error of a file that is not Python, with its line.
    """

    names: frozenset[str]
    is_complete: bool = True
    error: str = ""


UNKNOWN = ModuleNames(frozenset(), is_complete=False)


def find_module(name: str, folder: Path) -> ModuleSpec | None:
    """Return where the process that runs the models of a folder would find a module, or ``None``.

    The folders are searched in the order of ``agent.user_modules``: installed packages, the folder, ``PYTHONPATH``.
    """
    inherited = inherited_paths()
    search = [*(entry for entry in sys.path if entry not in ("", *inherited)), str(folder), *inherited]
    spec: ModuleSpec | None = None
    path = ""
    for part in name.split("."):
        path = f"{path}.{part}" if path else part
        spec = _spec(path, search, top=path == part)
        if spec is None:
            return None
        search = list(spec.submodule_search_locations or ())
    return spec


def _spec(path: str, search: list[str], *, top: bool) -> ModuleSpec | None:
    found = (BuiltinImporter.find_spec(path) or FrozenImporter.find_spec(path)) if top else None
    return found or PathFinder.find_spec(path, search)


def module_names(spec: ModuleSpec) -> ModuleNames:
    """Return the names in a module that was found; ``UNKNOWN`` if it is not a readable Python file."""
    if spec.origin is None or not spec.origin.endswith(".py"):
        return UNKNOWN
    state = file_state(path_to_uri(Path(spec.origin)))
    return UNKNOWN if state is None else _names_in(state)


@lru_cache(maxsize=32)
def _names_in(state: FileState) -> ModuleNames:
    try:
        root = ast.parse(load_text(state.path))
    except SyntaxError as error:
        return ModuleNames(frozenset(), error=f"line {error.lineno}: {error.msg}")
    except (UnreadableFile, OSError, ValueError):
        return UNKNOWN
    names = frozenset(_bound(root.body))
    open_ended = {"*", "__getattr__"} & names or any(_is_dynamic(node) for node in ast.walk(root))
    return ModuleNames(names, is_complete=not open_ended)


def _is_dynamic(node: ast.AST) -> bool:
    match node:
        case ast.Call(func=ast.Name(id="globals" | "exec" | "setattr" | "vars")) | ast.Global():
            return True
        case _:
            return False


def _bound(statements: Iterable[ast.stmt]) -> Iterator[str]:
    """Yield the names that statements bind in their scope."""
    for statement in statements:
        match statement:
            case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name) | ast.ClassDef(name=name):
                yield name
            case ast.Import(names=aliases) | ast.ImportFrom(names=aliases):
                yield from (alias.asname or alias.name.partition(".")[0] for alias in aliases)
            case _:
                yield from _targets(statement)


def _targets(statement: ast.stmt) -> Iterator[str]:
    """Yield the names that a statement, or a statement inside it, binds."""
    for child in ast.iter_child_nodes(statement):
        if isinstance(child, ast.stmt):
            yield from _bound((child,))
        elif isinstance(child, ast.ExceptHandler | ast.match_case):
            yield from _bound(child.body)
        else:
            named = (node for node in ast.walk(child) if isinstance(node, ast.Name))
            yield from (node.id for node in named if isinstance(node.ctx, ast.Store))
