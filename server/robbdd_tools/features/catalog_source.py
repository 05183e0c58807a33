"""The Python files of catalog entries, and ``catalog "…"`` at a cursor."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.catalog.executors import EXECUTORS
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.features.outside_place import OutsidePlace
from robbdd_tools.features.sentences import word_meaning
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk_at

if TYPE_CHECKING:
    from robbdd_tools.names.project import Snapshot


def source_of(entry: object) -> Path | None:
    """Return the Python file of a catalog entry, which is the loaded module that contains the entry."""
    load_catalog()
    for _, module in sorted(sys.modules.items()):
        path = getattr(module, "__file__", None)
        # A package may re-export the contents of its modules. The module that defines the entry has the longest name.
        if path and any(value is entry for value in vars(module).values()) and not path.endswith("__init__.py"):
            return Path(path)
    return None


def entry_at(snapshot: Snapshot, uri: str, offset: int) -> tuple[Span, str] | None:
    """Return the name in ``catalog "…"`` at an offset, and its absolute span."""
    file = snapshot.file(uri)
    for placed in file.declarations if file is not None else ():
        root = placed.declaration.tree
        if root is not None and placed.span.contains(offset):
            for node in walk_at(root, offset - placed.offset):
                if isinstance(node, tree.CatalogEntry) and node.name.span.shifted(placed.offset).contains(offset):
                    return node.name.span.shifted(placed.offset), node.name.value
    return None


def describe_catalog_entry(name: str) -> str | None:
    """Describe a behaviour, a robot or an object of the catalog."""
    catalog = load_catalog()
    behaviour = catalog.behaviours.get(name)
    if behaviour is not None:
        return word_meaning(behaviour)
    model = EXECUTORS.get(name) or catalog.robots.get(name) or catalog.objects.get(name)
    return None if model is None else f"`{name}`\n\n{model.doc}"


def entry_definition(name: str) -> OutsidePlace | None:
    """Return the Python file that defines a catalog entry."""
    catalog = load_catalog()
    entry = catalog.behaviours.get(name) or EXECUTORS.get(name) or catalog.robots.get(name) or catalog.objects.get(name)
    path = None if entry is None else source_of(entry)
    return None if path is None else OutsidePlace(path_to_uri(path), "", Span(0, 0))
