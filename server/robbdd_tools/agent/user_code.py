"""Calls of code that users brought with their model: it is imported here and nowhere else."""

from __future__ import annotations

import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from traceback import extract_tb
from typing import Any

from robbdd_tools.base.files import uri_to_path


class UserCodeError(Exception):
    """Code of the user failed; the message says what, how and where, for the user to read."""


def load_attribute(name: str, model: str) -> Callable[..., Any]:
    """Return ``module:attribute``; modules beside the file ``model`` (a path or URI) are found, too.

    Raises ``UserCodeError``.
    """
    module_name, _, attribute = name.partition(":")
    path = uri_to_path(model) if model.startswith("file:") else Path(model)
    folder = str(path.resolve().parent) if path is not None else ""
    if folder and folder not in sys.path:
        sys.path.append(folder)
    module = called(name, lambda: import_module(module_name))
    found = getattr(module, attribute, None)
    if not callable(found):
        raise UserCodeError(f"the Python module {module_name} has no function '{attribute}'")
    return found


def called(name: str, code: Callable[[], Any]) -> Any:
    """Return what user code returns; raises ``UserCodeError`` with file and line when it raises anything."""
    try:
        return code()
    except (Exception, SystemExit) as error:  # whatever it does, it is the user's, and says so
        words = error.msg if isinstance(error, SyntaxError) else error
        raise UserCodeError(f"{name} failed: {type(error).__name__}: {words}{_place(error)}") from error


def _place(error: BaseException) -> str:
    """Say where in the user's own files an error was raised."""
    own = Path(__file__).parents[1]
    frames = [frame for frame in extract_tb(error.__traceback__) if own not in Path(frame.filename).parents]
    frames = [frame for frame in frames if not frame.filename.startswith("<")]
    if isinstance(error, SyntaxError) and error.filename:
        return f" ({error.filename}:{error.lineno})"
    if isinstance(error, ModuleNotFoundError) or not frames:
        return ""
    return f" ({frames[-1].filename}:{frames[-1].lineno})"
