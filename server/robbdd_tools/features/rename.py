"""Rename: change a declared name and all references to it or to its parts, in all files."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit
from robbdd_tools.base.document import Span
from robbdd_tools.features.goto_definition import symbol_at
from robbdd_tools.features.references import uses

if TYPE_CHECKING:
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot

_NAME = re.compile(r"[^\W\d][\w\-]*")


class RenameRefused(Exception):
    """The name cannot be changed, or it cannot be changed to the new name. The message gives the reason."""


def prepare_rename(snapshot: Snapshot, uri: str, offset: int) -> Span | None:
    """Return the span that a rename at an offset would replace, or ``None`` if there is no name."""
    found = symbol_at(snapshot, uri, offset)
    return found[0] if found is not None and _is_written(snapshot, found[1]) else None


def rename(snapshot: Snapshot, uri: str, offset: int, name: str) -> list[Edit]:
    """Return the edits that rename the name at an offset. Raises ``RenameRefused``."""
    found = symbol_at(snapshot, uri, offset)
    if found is None:
        raise RenameRefused("there is no name here")
    definition = found[1]
    if not _is_written(snapshot, definition):
        raise RenameRefused(
            f"'{definition.symbol.name}' is numbered by its set: rename the set's base name in the text"
        )
    if _NAME.fullmatch(name) is None:
        raise RenameRefused(f"'{name}' is not a valid name: use a letter or _, then letters, digits, _ and -")
    _refuse_clash(snapshot, definition, name)
    # In broken text, the cursor may be on a name without a reference.
    places = {(uri, found[0]), *name_places(snapshot, definition)}
    return [Edit(place, span, name) for place, span in sorted(places)]


def name_places(snapshot: Snapshot, definition: Definition) -> list[tuple[str, Span]]:
    """Return every place where a declared name is written, including parts of qualified names."""
    return sorted({(definition.uri, definition.span), *uses(snapshot, definition)})


def linked_places(snapshot: Snapshot, uri: str, offset: int) -> list[Span]:
    """Return the places of the name at an offset in the same document, for linked editing."""
    found = symbol_at(snapshot, uri, offset)
    if found is None or not _is_written(snapshot, found[1]):
        return []
    places = name_places(snapshot, found[1])
    inside = any(place == uri and span.contains(offset) for place, span in places)
    return [span for _, span in places] if inside and all(place == uri for place, _ in places) else []


def _refuse_clash(snapshot: Snapshot, definition: Definition, name: str) -> None:
    *outer, _ = definition.symbol.path.split(".")
    path = ".".join([*outer, name])
    analysis = snapshot.file(definition.uri)
    if analysis is not None and path in analysis.definitions:
        raise RenameRefused(f"'{path}' is already declared")


def _is_written(snapshot: Snapshot, definition: Definition) -> bool:
    """Return whether a name is written in the text. Names in a ``similar`` set are generated instead."""
    analysis = snapshot.file(definition.uri)
    span = definition.span
    return analysis is not None and analysis.document.text[span.start : span.end] == definition.symbol.name
