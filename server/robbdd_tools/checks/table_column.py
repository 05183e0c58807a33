"""``table-column``: ``with`` chooses a property that no element of the set has, or a column twice."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.checks.finding import finding
from robbdd_tools.checks.property_condition import properties_in, unknown_property
from robbdd_tools.names.elements import Site
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot

CODE = "table-column"
FIRST_COLUMN = "name"
"""The name of the first column of every table."""


def table_column(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report the columns of a file's scenes that show nothing new, each at most once."""
    if "with" not in file.document.text:
        return
    for placed in file.parts():
        root = placed.declaration.tree
        if isinstance(root, tree.Scene):
            site = Site(snapshot, file, placed)
            for entry in root.entries:
                if entry.columns is not None:
                    yield from _columns(site, entry.reference, entry.columns)


def _columns(site: Site, ref: tree.Ref, columns: tree.Columns) -> Iterator[Diagnostic]:
    known = properties_in(site, site.follow(ref))
    before = {FIRST_COLUMN}
    for name in columns.names:
        if name.text in before:
            message = f"the table already has a column '{name.text}': choose another property, or remove this one"
            yield finding(site, name, Severity.WARNING, CODE, message)
        elif known and not any(has.get(name.text) for _, has in known):
            # Other rules report an empty set and an unknown name.
            yield unknown_property(site, ref, name, known, Severity.WARNING, CODE)
        before.add(name.text)
