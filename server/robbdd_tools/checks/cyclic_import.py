"""``cyclic-import``: a file that is imported imports this one in turn.

Names are found all the same; but neither file can be read, moved or given away without the other.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot


def cyclic_import(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each import through which a file comes back to itself."""
    uri = file.document.uri
    for link in file.imports:
        if link.problem is None and snapshot.import_each_other(uri, link.uri):
            name, own = link.uri.rsplit("/", 1)[-1], uri.rsplit("/", 1)[-1]
            message = f"'{name}' imports '{own}' in turn: move what both need into a file of its own, imported by both"
            yield Diagnostic(uri, link.span, Severity.WARNING, "cyclic-import", message)
