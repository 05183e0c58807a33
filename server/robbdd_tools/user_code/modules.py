"""Search for users' modules after the standard library and all installed packages."""

from __future__ import annotations

import os
import sys
from importlib.util import find_spec
from pathlib import Path

from robbdd_tools.base.files import uri_to_path
from robbdd_tools.base.interpreter import inherited_paths, started_in
from robbdd_tools.base.isolation import NO_USER_CODE, OWNER_FORBIDS, SEARCHED, UNTRUSTED
from robbdd_tools.catalog.registry import load_catalog

_folders: list[str] = []
"""Folders of models whose code was requested. ``sys.path`` ends with these and with ``_last`` (``PYTHONPATH``)."""
_last: list[str] = []


_REASONS = {UNTRUSTED: "the workspace is not trusted", OWNER_FORBIDS: "the owner of the worker does not allow it"}


class NotImported(Exception):
    """A user's module cannot be imported; the message gives the reason. ``file`` is the module if it exists."""

    def __init__(self, message: str, file: Path | None = None) -> None:
        super().__init__(message)
        self.file = file


def folder_of(model: str) -> Path | None:
    """Return the folder of a model (a path or URI), ``None`` if it is not a file."""
    path = uri_to_path(model) if model.startswith("file:") else Path(model)
    return None if not model or path is None else (started_in() / path).resolve().parent


def search(folder: Path | None) -> None:
    """Make modules in a folder and in the environment's ``PYTHONPATH`` importable, after all other modules.

    Raises ``NotImported`` if this process must not run users' code.
    """
    reason = os.environ.get(NO_USER_CODE)
    if reason:
        why = _REASONS.get(reason, "--no-user-code was given")
        raise NotImported(f"users' code is not run: {why}")
    # Third-party words of the catalog are found on sys.path, and only installed packages may add words.
    load_catalog()
    if not _folders:
        _last.extend(entry for entry in inherited_paths() if entry not in sys.path)
        if _last:
            # Programs started by users' code get the environment that the user set.
            os.environ[SEARCHED] = os.pathsep.join(inherited_paths())
    if folder is not None and str(folder) not in _folders:
        _folders.append(str(folder))
    # Python recognises a compiled module by second and size: after a quick edit, it would execute the old code.
    sys.dont_write_bytecode = True
    others = [entry for entry in sys.path if entry not in _folders and entry not in _last]
    sys.path[:] = [*others, *_folders, *_last]


def refuse_hidden(name: str, folder: Path) -> None:
    """Raise ``NotImported`` if another module of the same name hides a module in the model's folder."""
    own = next((one for one in (folder / f"{name}.py", folder / name / "__init__.py") if one.is_file()), None)
    if own is None:
        return
    loaded = sys.modules.get(name)
    spec = find_spec(name) if loaded is None else loaded.__spec__
    place = None if spec is None else spec.origin
    if place is None or Path(place).resolve() != own.resolve():
        known = "Python's standard library" if name in sys.stdlib_module_names else place or "another package"
        raise NotImported(
            f"{own} is not imported: {known} has a module '{name}', too; rename the file and its uses", own
        )
