"""Links to other files: imports, model files of scene instances, files of installed packages."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.base.files import path_to_uri, uri_to_path
from robbdd_tools.checks.model_file import model_path
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class DocumentLink:
    """A path in a text and the document that it names. The span is absolute and excludes the quotes."""

    span: Span
    target: str


def document_links(snapshot: Snapshot, uri: str) -> list[DocumentLink]:
    """Return the links of a file whose targets exist, in text order."""
    file = snapshot.file(uri)
    if file is None:
        return []
    imports = (DocumentLink(link.span, link.uri) for link in file.imports if link.problem is None)
    return sorted([*imports, *_models(file)], key=lambda link: link.span)


def _models(file: FileAnalysis) -> Iterator[DocumentLink]:
    own = uri_to_path(file.document.uri)
    for placed in file.declarations if own is not None else ():
        if own is None or not isinstance(placed.declaration.tree, tree.SceneInstance):
            continue
        for node in walk(placed.declaration.tree):
            if isinstance(node, tree.SystemPath | tree.RosPath):
                found = model_path(own.parent, node)
                if found is not None and _is_file(found):
                    span = Span(node.path.span.start + 1, node.path.span.end - 1).shifted(placed.offset)
                    yield DocumentLink(span, path_to_uri(found))


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):
        # The file name is invalid.
        return False
