"""Hover: what stands under the cursor, be it a name, a phrase of the catalog or a time constraint."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.features.definition import symbol_at
from robbdd_tools.features.describe import describe
from robbdd_tools.features.results import NOTHING
from robbdd_tools.features.sentences import time_meaning, word_meaning, word_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.features.results import Findings
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class Hover:
    """Markdown about the text in ``span`` (absolute)."""

    markdown: str
    span: Span


def hover(snapshot: Snapshot, uri: str, offset: int, findings: Findings = NOTHING) -> Hover | None:
    """Describe the name under a cursor, else the phrase or time constraint around it.

    ``findings`` are the last results of clauses.
    """
    found = symbol_at(snapshot, uri, offset)
    if found is not None:
        return Hover(describe(snapshot, found[1], findings), found[0])
    analysis = snapshot.file(uri)
    for placed in analysis.declarations if analysis is not None else ():
        root = placed.declaration.tree
        if root is None or not placed.span.contains(offset):
            continue
        for node in walk(root):
            span = node.span.shifted(placed.offset)
            if not span.contains(offset):
                continue
            if isinstance(node, tree.PhraseUse):
                return Hover(word_meaning(word_of(node)), span)
            if isinstance(node, tree.During | tree.Before | tree.After):
                return Hover(time_meaning(node), span)
    return None
