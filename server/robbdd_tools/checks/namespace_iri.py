"""``namespace-iri``: a namespace or a linked node is not a valid IRI, so it would be missing from the graph."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Severity
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.syntax.symbols import walk
from robbdd_tools.syntax.tree import BehaviourUse, Namespace, Template, Text

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration

CODE = "namespace-iri"
# RFC 3987: a scheme, then any characters except those that no IRI may contain.
_IRI = re.compile(r"[A-Za-z][A-Za-z0-9+.\-]*:[^\s<>\"{}|\\^`]*")


def namespace_iri(_: Snapshot, analysis: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each namespace, and each node that a behaviour is linked to, that is not an absolute IRI."""
    for placed in analysis.of(Namespace):
        root = placed.declaration.tree
        if isinstance(root, Namespace) and not _IRI.fullmatch(root.iri.value):
            uri, span = analysis.document.uri, root.iri.span.shifted(placed.offset)
            example = f"'https://example.org/{root.name.text}/'"
            message = f"'{root.iri.value}' is not an absolute IRI: write one such as {example}"
            fix = Fix(f"Change to {example}", (Edit(uri, span, example),))
            yield Diagnostic(uri, span, Severity.ERROR, CODE, message, fixes=(fix,))
    for placed in analysis.of(Template):
        for node in _linked_nodes(placed.declaration):
            if not _IRI.fullmatch(node.value):
                span = node.span.shifted(placed.offset)
                message = (
                    f"'{node.value}' is not an absolute IRI: write that of a node, such as "
                    "'https://example.org/states#grasping', or '<TREE.NODE>' for a node of a behaviour tree"
                )
                yield Diagnostic(analysis.document.uri, span, Severity.ERROR, CODE, message)


@kept_with_key
def _linked_nodes(declaration: Declaration) -> tuple[Text, ...]:
    root = declaration.tree
    uses = (node for node in walk(root) if isinstance(node, BehaviourUse)) if root is not None else ()
    return tuple(use.external for use in uses if use.external is not None)
