"""Rename: a declared name and all that refers to it or to its parts, in all files."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit
from robbdd_tools.base.document import Span
from robbdd_tools.features.definition import symbol_at
from robbdd_tools.features.references import Use, uses

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import Definition
    from robbdd_tools.names.project import Snapshot

_NAME = re.compile(r"[^\W\d][\w\-]*")


class RenameRefused(Exception):
    """The name cannot be changed, or not to this; the message says why."""


def prepare_rename(snapshot: Snapshot, uri: str, offset: int) -> Span | None:
    """Return the part of the text under a cursor that a rename would replace; ``None`` where there is none."""
    found = symbol_at(snapshot, uri, offset)
    if found is None or _text(snapshot, found[1].uri, found[1].span) != found[1].symbol.name:
        return None
    span, definition = found
    written = _text(snapshot, uri, span)
    return _segment(span, written, definition.symbol.path, definition)


def rename(snapshot: Snapshot, uri: str, offset: int, name: str) -> list[Edit]:
    """Return the edits that give the name under a cursor another one; raises ``RenameRefused``."""
    found = symbol_at(snapshot, uri, offset)
    if found is None:
        raise RenameRefused("there is no name here")
    definition = found[1]
    if _text(snapshot, definition.uri, definition.span) != definition.symbol.name:
        raise RenameRefused(
            f"'{definition.symbol.name}' is numbered by its set: rename the set's base name in the text"
        )
    if _NAME.fullmatch(name) is None:
        raise RenameRefused(f"'{name}' is no name: use a letter or _, then letters, digits, _ and -")
    _refuse_clash(snapshot, definition, name)
    return [Edit(place, span, name) for place, span in name_places(snapshot, definition)]


def name_places(snapshot: Snapshot, definition: Definition) -> list[tuple[str, Span]]:
    """Return every place where a declared name itself is written, also as a part of qualified names."""
    places = {(definition.uri, definition.span)}
    for use in uses(snapshot, definition):
        span = _part(use, definition)
        if span is not None:
            places.add((use.uri, span))
    return sorted(places)


def linked_places(snapshot: Snapshot, uri: str, offset: int) -> list[Span]:
    """Return the places of the name under a cursor that can be typed over together: those of one document only."""
    found = symbol_at(snapshot, uri, offset)
    if found is None or _text(snapshot, found[1].uri, found[1].span) != found[1].symbol.name:
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


def _part(use: Use, definition: Definition) -> Span | None:
    return _segment(use.span, use.written, use.target.symbol.path, definition)


def _segment(span: Span, written: str, target: str, definition: Definition) -> Span | None:
    """Return where a definition's own name stands in a qualified name that may leave out its first parts."""
    parts = written.split(".")
    number = definition.symbol.path.count(".") - (target.count(".") + 1 - len(parts))
    if number < 0 or parts[number] != definition.symbol.name:
        return None
    start = span.start + sum(len(part) + 1 for part in parts[:number])
    return Span(start, start + len(parts[number]))


def _text(snapshot: Snapshot, uri: str, span: Span) -> str:
    analysis = snapshot.file(uri)
    return "" if analysis is None else analysis.document.text[span.start : span.end]
