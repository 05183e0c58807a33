"""``cyclic-import``: an imported file imports this one.

Names still resolve, but neither file can be read, moved or shared without the other.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot


def cyclic_import(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each import that leads back to its file."""
    uri = file.document.uri
    for link in file.imports:
        if link.problem is None and snapshot.import_each_other(uri, link.uri):
            name, own = link.uri.rsplit("/", 1)[-1], uri.rsplit("/", 1)[-1]
            message = f"'{name}' also imports '{own}': move what both need into a new file, imported by both"
            yield Diagnostic(uri, link.span, Severity.WARNING, "cyclic-import", message)
