"""``unused-event``: neither the file of an event nor a file that imports it refers to the event."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.checks.usage import unused, unused_declarations
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot


def unused_event(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each unused event as a hint."""
    for definition in unused_declarations(snapshot, file, SymbolKind.EVENT):
        yield unused(file, definition, "unused-event")
