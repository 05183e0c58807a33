"""``namespace-iri``: a namespace is not a valid IRI prefix, so its names would be missing from the graph."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Severity
from robbdd_tools.syntax.tree import Namespace

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot

# RFC 3987: a scheme, then any characters except those that no IRI may contain.
_IRI = re.compile(r"[A-Za-z][A-Za-z0-9+.\-]*:[^\s<>\"{}|\\^`]*")


def namespace_iri(_: Snapshot, analysis: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each namespace that is not an absolute IRI."""
    for placed in analysis.of(Namespace):
        root = placed.declaration.tree
        if isinstance(root, Namespace) and not _IRI.fullmatch(root.iri.value):
            uri, span = analysis.document.uri, root.iri.span.shifted(placed.offset)
            example = f"'https://example.org/{root.name.text}/'"
            message = f"'{root.iri.value}' is not an absolute IRI: write one such as {example}"
            fix = Fix(f"Change to {example}", (Edit(uri, span, example),))
            yield Diagnostic(uri, span, Severity.ERROR, "namespace-iri", message, fixes=(fix,))
