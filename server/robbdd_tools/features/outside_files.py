"""Find the files that a model uses but that are not models: Python modules, its own steps, robot descriptions."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import path_to_uri, uri_to_path
from robbdd_tools.base.model_parts import model_parts
from robbdd_tools.base.python_modules import find_module, source_file
from robbdd_tools.base.step_files import steps_file
from robbdd_tools.checks.model_file import model_path
from robbdd_tools.checks.python_source import code_names
from robbdd_tools.logs.log_files import METADATA, bag_files
from robbdd_tools.names.index import language_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration

NAMING = ("bdd", "bddx", "scenex")
"""Languages whose files can name other files than models."""


def outside_uris(snapshot: Snapshot, uri: str) -> frozenset[str]:
    """Return the URIs of the other files that one model uses, including the files that these include.

    Missing files are included, too, because their creation changes the meaning of the model.
    """
    own = uri_to_path(uri)
    file = snapshot.file(uri) if own is not None and language_of(uri) in NAMING else None
    if own is None or file is None:
        return frozenset()
    if language_of(uri) == "bdd":
        return frozenset({path_to_uri(steps_file(own))})
    return frozenset(
        path_to_uri(path) for placed in file.declarations for path in _named(placed.declaration, own.parent)
    )


def _named(declaration: Declaration, folder: Path) -> Iterator[Path]:
    for source in code_names(declaration):
        spec = find_module(source.module.text, folder)
        path = None if spec is None else source_file(spec)
        if path is not None:
            yield path
        elif spec is None:
            yield folder.joinpath(*source.module.text.split(".")).with_suffix(".py")
    root = declaration.tree
    if isinstance(root, tree.RobotLog):
        yield from _of_log(root, folder)
    for node in walk(root) if isinstance(root, tree.SceneInstance) else ():
        for source in _sources(node) if isinstance(node, tree.Model) else ():
            path = model_path(folder, source)
            if path is not None:
                yield path
                yield from model_parts(path).files if path.is_file() else ()


def _sources(model: tree.Model) -> Iterator[tree.ModelSource]:
    """Yield the sources of a model and of its gripper whose text is read."""
    if model.kind != "usd":
        yield model.source
    if model.gripper is not None and model.gripper.source is not None:
        yield model.gripper.source


def _of_log(log: tree.RobotLog, folder: Path) -> Iterator[Path]:
    """Yield the files of a log that may change: the file, or those of a folder, and the table of events."""
    for written in (log.path, log.annotations):
        with suppress(RuntimeError, OSError):  # The home folder of an unknown user; a folder without permission.
            path = None if written is None else folder / Path(written.value).expanduser()
            if path is not None:
                yield from (path / METADATA, *bag_files(path)) if path.is_dir() else (path,)
