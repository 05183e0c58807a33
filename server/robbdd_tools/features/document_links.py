"""Links to other files: imports, model files of scene instances, files of installed packages."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.base.files import path_to_uri, uri_to_path
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
            if isinstance(node, tree.SystemPath):
                found = _file(own.parent, node.path.value)
                if found is not None:
                    span = Span(node.path.span.start + 1, node.path.span.end - 1).shifted(placed.offset)
                    yield DocumentLink(span, path_to_uri(found))


def _file(folder: Path, path: str) -> Path | None:
    try:
        found = folder / Path(path).expanduser()
        return found if found.is_file() else None
    except (OSError, RuntimeError, ValueError):
        # The home folder of an unknown user, or an invalid file name.
        return None
