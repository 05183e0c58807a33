"""``model-file``: a model file of a scene instance that is not on this machine; an error only when it is run."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.files import uri_to_path
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot


def model_file(_: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each ``sys path`` that leads to no file."""
    own = uri_to_path(file.document.uri)
    if own is None:
        return
    for placed in file.declarations:
        if not isinstance(placed.declaration.tree, tree.SceneInstance):
            continue
        for node in walk(placed.declaration.tree):
            if isinstance(node, tree.SystemPath) and not _exists(own.parent, node.path.value):
                yield Diagnostic(
                    file.document.uri,
                    node.path.span.shifted(placed.offset),
                    Severity.WARNING,
                    "model-file",
                    f"the model file '{node.path.value}' is not on this machine: put it there, or change the path, "
                    "before a run with it",
                )


def _exists(folder: Path, path: str) -> bool:
    try:
        return (folder / Path(path).expanduser()).is_file()
    except (OSError, RuntimeError, ValueError):
        # A home folder that nobody has, a name that no file can have.
        return False
