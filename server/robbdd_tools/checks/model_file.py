"""``model-file``: a run cannot use the model file of a scene instance, because it is missing or its text is faulty.

This is a warning, because only a run needs the file. Its text is read, but no engine loads it.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.base.files import unreadable, uri_to_path
from robbdd_tools.base.model_parts import model_parts
from robbdd_tools.base.model_paths import package_share
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.project import Snapshot

CODE = "model-file"
_FORMATS = {"mjcf": "MJCF", "urdf": "URDF"}


def model_file(_: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each path of a model that does not lead to a file that a run can use."""
    own = uri_to_path(file.document.uri)
    if own is None:
        return
    for placed in file.of(tree.SceneInstance):
        if isinstance(placed.declaration.tree, tree.SceneInstance):
            for node in walk(placed.declaration.tree):
                if isinstance(node, tree.Model):
                    yield from _faults(file, placed, node, own.parent)


def _faults(file: FileAnalysis, placed: PlacedDeclaration, model: tree.Model, folder: Path) -> Iterator[Diagnostic]:
    if model.gripper is not None and model.gripper.source is not None:
        span = model.gripper.source.path.span.shifted(placed.offset)
        for problem in _problems(model.gripper.source, folder):
            yield Diagnostic(file.document.uri, span, Severity.WARNING, CODE, problem)
    source = model.source
    if not isinstance(source, tree.SystemPath | tree.RosPath):
        return
    uri, span = file.document.uri, source.path.span.shifted(placed.offset)
    for problem in _problems(source, folder, is_read=model.kind != "usd"):
        yield Diagnostic(uri, span, Severity.WARNING, CODE, problem)
    path = model_path(folder, source)
    if path is None or model.kind == "usd" or not path.is_file():
        return
    parts = model_parts(path)
    if parts.format and parts.format != model.kind:
        message = f"the model file is {_FORMATS[parts.format]}, not {_FORMATS[model.kind]}: write 'as {parts.format}'"
        kind = _kind_span(file, placed, model)
        fix = Fix(f"Change to 'as {parts.format}'", (Edit(uri, kind, parts.format),))
        yield Diagnostic(uri, kind, Severity.WARNING, CODE, message, fixes=(fix,))


def _kind_span(file: FileAnalysis, placed: PlacedDeclaration, model: tree.Model) -> Span:
    """Return the span of ``mjcf`` or ``urdf``: the last word of the text before the model's brace."""
    text, start = file.document.text, model.name.span.shifted(placed.offset).end
    place = text.rindex(model.kind, start, text.index("{", start))
    return Span(place, place + len(model.kind))


def _problems(source: tree.SystemPath | tree.RosPath, folder: Path, is_read: bool = True) -> Iterator[str]:
    """Yield why a run cannot use a model file."""
    problem = _missing_package(source) or missing_file(folder, _written(source, folder))
    if problem is not None:
        yield problem
        return
    path = model_path(folder, source)
    parts = model_parts(path) if path is not None and is_read else None
    for problem in filter(None, (parts.problem, *parts.missing)) if parts is not None else ():
        yield f"the model file cannot be used: {problem}"


def _missing_package(source: tree.SystemPath | tree.RosPath) -> str | None:
    if isinstance(source, tree.SystemPath):
        return None
    share, reason = package_share(source.package.value)
    return None if share is not None else f"the ROS package '{source.package.value}' cannot be found: {reason}"


def _written(source: tree.SystemPath | tree.RosPath, folder: Path) -> str:
    """Return the path of a model file. It is relative to the folder or, in a package, absolute."""
    if isinstance(source, tree.SystemPath):
        return source.path.value
    return str(model_path(folder, source))


def model_path(folder: Path, source: tree.ModelSource) -> Path | None:
    """Return the file that a model of a ``.scenex`` in a folder names; ``None`` if its place is unknown."""
    try:
        match source:
            case tree.SystemPath():
                return folder / Path(source.path.value).expanduser()
            case tree.RosPath():
                share, _ = package_share(source.package.value)
                return None if share is None else share / source.path.value
            case _:
                return None
    except RuntimeError:
        # The home folder of an unknown user.
        return None


def missing_file(folder: Path, path: str) -> str | None:
    """Return the reason why a model file cannot be used, or ``None``. Its path is relative to the folder."""
    missing = f"the model file '{path}' is not on this machine: put it there, or change the path, before a run with it"
    try:
        found = unreadable(folder / Path(path).expanduser())
    except RuntimeError:
        # The home folder of an unknown user.
        return missing
    if found is None:
        return None
    return missing if found.code == "file-missing" else f"the model file cannot be used: {found.reason}"
