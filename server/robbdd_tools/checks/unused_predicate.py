"""``unused-predicate``: neither the file of a named predicate nor a file that imports it uses the predicate."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.checks.usage import unused, unused_declarations
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot


def unused_predicate(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each unused named predicate as a hint."""
    for definition in unused_declarations(snapshot, file, SymbolKind.PREDICATE):
        yield unused(file, definition, "unused-predicate")
