"""Find the places of the entries of models in a ``.scenex``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.catalog.executable import ModelEntry
    from robbdd_tools.names.project import Snapshot


def entry_span(snapshot: Snapshot, uri: str, start: int, entry: ModelEntry) -> Span | None:
    """Return the span of an entry's value, or of one of its numbers, in the model whose name begins at ``start``.

    ``None`` if the text does not state it.
    """
    file = snapshot.file(uri)
    for placed in file.declarations if file is not None else ():
        root = placed.declaration.tree
        for node in walk(root) if isinstance(root, tree.SceneInstance) else ():
            if isinstance(node, tree.Model) and node.name.span.start + placed.offset == start:
                value = _value(node, entry)
                return None if value is None else value.span.shifted(placed.offset)
    return None


def _value(model: tree.Model, entry: ModelEntry) -> tree.Node | None:
    gripper = model.gripper
    match entry.keyword:
        case "home" | "velocity":
            vector = model.home if entry.keyword == "home" else model.velocity
            if vector is None or entry.number is None or entry.number >= len(vector.values):
                return vector
            return vector.values[entry.number]
        case "open":
            return None if gripper is None else gripper.open
        case "close":
            return None if gripper is None else gripper.close
        case "stroke":
            return None if gripper is None else gripper.stroke
        case _:
            return None
