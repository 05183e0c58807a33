"""``model-file``: the model file of a scene instance is missing on this machine. It is an error only in a run."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.files import unreadable, uri_to_path
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot

CODE = "model-file"


def model_file(_: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each ``sys path`` without a file."""
    own = uri_to_path(file.document.uri)
    if own is None:
        return
    for placed in file.declarations:
        if not isinstance(placed.declaration.tree, tree.SceneInstance):
            continue
        for node in walk(placed.declaration.tree):
            problem = missing_file(own.parent, node.path.value) if isinstance(node, tree.SystemPath) else None
            if isinstance(node, tree.SystemPath) and problem is not None:
                span = node.path.span.shifted(placed.offset)
                yield Diagnostic(file.document.uri, span, Severity.WARNING, CODE, problem)


def missing_file(folder: Path, path: str) -> str | None:
    """Return the reason why a model file cannot be used; ``None`` if it can. Its path is relative to the folder."""
    missing = f"the model file '{path}' is not on this machine: put it there, or change the path, before a run with it"
    try:
        found = unreadable(folder / Path(path).expanduser())
    except RuntimeError:
        # The home folder of an unknown user.
        return missing
    if found is None:
        return None
    return missing if found.code == "file-missing" else f"the model file cannot be used: {found.reason}"
