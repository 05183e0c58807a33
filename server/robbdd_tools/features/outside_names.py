"""Names in a model that files other than models define: Python code, parts of robot descriptions, catalog entries."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from robbdd_tools.base.checkpoint import checkpoint
from robbdd_tools.checks.model_name import part_names
from robbdd_tools.features.catalog_source import describe_catalog_entry, entry_at, entry_definition
from robbdd_tools.features.coordination_nodes import (
    coordination_node_at,
    coordination_node_definition,
    describe_coordination_node,
)
from robbdd_tools.features.log_help import log_name_at
from robbdd_tools.features.model_parts_help import (
    describe_file,
    describe_part,
    file_at,
    file_definition,
    part_at,
    part_definition,
)
from robbdd_tools.features.python_code import code_at, code_definition, describe_code
from robbdd_tools.names.index import language_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.features.outside_place import OutsidePlace
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot


_NAMING = ("bddx", "scenex", "ktree", "bdd")
"""Languages whose files can contain such names."""


@dataclass(frozen=True, slots=True)
class OutsideName:
    """A name at an absolute span. ``describe`` returns Markdown, and ``definition`` returns the defining place."""

    span: Span
    describe: Callable[[], str | None]
    definition: Callable[[], OutsidePlace | None]


def outside_name_at(snapshot: Snapshot, uri: str, offset: int) -> OutsideName | None:
    """Return the name at an offset that another file defines."""
    named = code_at(snapshot, uri, offset)
    if named is not None:
        span, name = named
        return OutsideName(span, partial(describe_code, uri, name), partial(code_definition, uri, name))
    part = part_at(snapshot, uri, offset)
    if part is not None:
        return OutsideName(part[0], partial(describe_part, part[1]), partial(part_definition, part[1]))
    model = file_at(snapshot, uri, offset)
    if model is not None:
        return OutsideName(model[0], partial(describe_file, model[1]), partial(file_definition, model[1]))
    in_log = log_name_at(snapshot, uri, offset)
    if in_log is not None:
        span, text = in_log
        return OutsideName(span, lambda: text, lambda: None)
    node = coordination_node_at(snapshot, uri, offset)
    if node is not None:
        describe = partial(describe_coordination_node, snapshot, uri, node[1])
        return OutsideName(node[0], describe, partial(coordination_node_definition, snapshot, uri, node[1]))
    entry = entry_at(snapshot, uri, offset)
    if entry is not None:
        return OutsideName(entry[0], partial(describe_catalog_entry, entry[1]), partial(entry_definition, entry[1]))
    return None


def outside_references(snapshot: Snapshot, uri: str, offset: int) -> tuple[list[tuple[str, Span]], OutsidePlace | None]:
    """Return the sorted places in loaded models that mean the name at an offset, and its definition in another file.

    Uses in the other file, such as Python code, are not searched.
    """
    named = outside_name_at(snapshot, uri, offset)
    place = None if named is None else named.definition()
    if place is None:
        return [], None
    found: list[tuple[str, Span]] = []
    for other in sorted(snapshot.sources):
        file = snapshot.file(other) if language_of(other) in _NAMING else None
        for span in _named_in(file) if file is not None else ():
            checkpoint()
            one = outside_name_at(snapshot, other, span.start)
            defined = None if one is None or one.span != span else one.definition()
            if defined is not None and (defined.uri, defined.span) == (place.uri, place.span):
                found.append((other, span))
    return found, place


def _named_in(file: FileAnalysis) -> Iterator[Span]:
    """Yield the spans in a file that may contain a name that another file defines."""
    for placed in file.declarations:
        root = placed.declaration.tree
        for node in walk(root) if root is not None else ():
            match node:
                case tree.PythonAttribute():
                    yield node.module.span.shifted(placed.offset)
                    yield node.attribute.span.shifted(placed.offset)
                case tree.SystemPath() | tree.RosPath():
                    yield node.path.span.shifted(placed.offset)
                case tree.BehaviourUse() if node.external is not None:
                    yield node.external.span.shifted(placed.offset)
                case tree.CatalogEntry():
                    yield node.name.span.shifted(placed.offset)
                case _:
                    pass
        yield from (named.text.span.shifted(placed.offset) for named in part_names(placed.declaration))
