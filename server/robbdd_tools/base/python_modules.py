"""Find Python modules by their files, and names in them by syntax trees. Nothing is imported or executed."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.machinery import BuiltinImporter, FrozenImporter, PathFinder
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.interpreter import inherited_paths
from robbdd_tools.base.python_outline import UNKNOWN, Outline, outline
from robbdd_tools.base.source_texts import source_state

if TYPE_CHECKING:
    from importlib.machinery import ModuleSpec

    from robbdd_tools.base.python_outline import PythonName

MAX_LISTED = 2000
"""Maximum number of entries of a folder that are searched for modules."""
MAX_IMPORTS = 8
"""Maximum number of imports that are followed from a name to its definition."""


@dataclass(frozen=True, slots=True)
class PythonPlace:
    """Where a name of Python code is defined: a file, and the name in it; ``None`` for the module itself."""

    path: Path
    name: PythonName | None
    outline: Outline


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


def module_outline(spec: ModuleSpec) -> Outline:
    """Return the names in a module that was found; ``UNKNOWN`` if it is not a readable Python file."""
    path = source_file(spec)
    state = None if path is None else source_state(path)
    return UNKNOWN if state is None else outline(state)


def module_place(module: str, folder: Path) -> PythonPlace | None:
    """Return the file of a module; ``None`` if there is no such Python file."""
    spec = find_module(module, folder)
    path = None if spec is None else source_file(spec)
    return None if spec is None or path is None else PythonPlace(path, None, module_outline(spec))


def attribute_place(module: str, attribute: str, folder: Path) -> PythonPlace | None:
    """Return where an attribute of a module is defined; imports of the name are followed.

    If the definition is not in a Python file, this is the last import.
    """
    found: PythonPlace | None = None
    for _ in range(MAX_IMPORTS):
        place = module_place(module, folder)
        name = None if place is None else place.outline.names.get(attribute)
        if place is None or name is None:
            submodule = module_place(f"{module}.{attribute}", folder)
            return submodule or found
        found = PythonPlace(place.path, name, place.outline)
        if name.imported is None:
            return found
        source = _absolute(name.imported[0], module, folder)
        if source is None:
            return found
        module, attribute = source, name.imported[1]
        if not attribute:
            return module_place(module, folder) or found
    return found


def modules_in(package: str, folder: Path) -> list[str]:
    """Return the sorted modules of a package or, without one, those next to a folder's models and on ``PYTHONPATH``."""
    if package:
        spec = find_module(package, folder)
        places = [] if spec is None else list(spec.submodule_search_locations or ())
    else:
        places = [str(folder), *inherited_paths()]
    return sorted({name for place in places for name in _modules(place)})


def _modules(place: str) -> Iterator[str]:
    for entry in _entries(place):
        name = entry.name.removesuffix(".py")
        if name != entry.name and name.isidentifier() and name != "__init__":
            yield name
        elif entry.name.isidentifier() and not entry.name.startswith("__") and _has_code(entry):
            yield entry.name


def _has_code(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir() and any(inner.name.endswith(".py") for inner in _entries(entry.path))
    except OSError:
        return False


def _entries(place: str) -> list[os.DirEntry[str]]:
    try:
        with os.scandir(place) as found:
            return list(islice(found, MAX_LISTED))
    except (OSError, ValueError):
        return []


def source_file(spec: ModuleSpec) -> Path | None:
    """Return the Python file of a module that was found; ``None`` if it is not one."""
    return Path(spec.origin) if spec.origin is not None and spec.origin.endswith(".py") else None


def _absolute(source: str, module: str, folder: Path) -> str | None:
    """Return the full name of a module that ``module`` imports; leading dots are relative to its package."""
    level = len(source) - len(source.lstrip("."))
    if not level:
        return source
    spec = find_module(module, folder)
    is_package = spec is not None and spec.submodule_search_locations is not None
    parts = module.split(".")
    kept = parts[: len(parts) - level + int(is_package)]
    name = ".".join((*kept, *filter(None, (source[level:],))))
    return name or None
