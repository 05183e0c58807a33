"""Names in a model of things that other files define: Python code, parts of a robot's description, catalog entries."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from robbdd_tools.features.catalog_source import describe_catalog_entry, entry_at, entry_definition
from robbdd_tools.features.model_parts_help import (
    describe_file,
    describe_part,
    file_at,
    file_definition,
    part_at,
    part_definition,
)
from robbdd_tools.features.python_code import code_at, code_definition, describe_code

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.features.outside_place import OutsidePlace
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class OutsideName:
    """A name at an absolute span. ``describe`` returns Markdown, and ``definition`` the place that defines it."""

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
    entry = entry_at(snapshot, uri, offset)
    if entry is not None:
        return OutsideName(entry[0], partial(describe_catalog_entry, entry[1]), partial(entry_definition, entry[1]))
    return None
