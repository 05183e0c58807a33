"""Import and call users' code that accompanies a model; no other module does so."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Iterator
from contextlib import redirect_stderr
from traceback import extract_tb
from typing import Any

from robbdd_tools.base.printable import encodable
from robbdd_tools.monitor.fault import Fault, Frame
from robbdd_tools.protocol.fault_places import is_library, is_ours, with_digest
from robbdd_tools.user_code import call_note
from robbdd_tools.user_code.modules import NotImported, folder_of, refuse_hidden, search

MAX_FRAMES = 20
"""Maximum number of frames of a fault; a deeper recursion keeps its outermost and innermost frames."""
MAX_WORDS = 2000
"""Maximum number of characters of an exception's message in a fault."""


class UserCodeError(Exception):
    """Users' code failed; the message describes the failure, its type and its place."""

    def __init__(self, message: str, fault: Fault) -> None:
        super().__init__(message)
        self.fault = fault


def load_attribute(name: str, model: str) -> Callable[..., Any]:
    """Return ``module:attribute``; the module may be in the folder of the file ``model`` (a path or URI).

    Raises ``UserCodeError``, also if another module hides a module of this folder.
    """
    module_name, _, attribute = name.partition(":")
    folder = folder_of(model)
    try:
        search(folder)
        if folder is not None:
            refuse_hidden(module_name.partition(".")[0], folder)
    except NotImported as error:
        raise refused(name, str(error), (Frame(str(error.file), 1),) if error.file else ()) from None
    module = call_user_code(name, importlib.import_module, module_name)
    found = getattr(module, attribute, None)
    if not callable(found):
        message = f"the Python module {module_name} has no function '{attribute}'"
        file = getattr(module, "__file__", None)
        raise refused(name, message, (Frame(str(file), 1),) if file else ())
    return found


def call_user_code(name: str, code: Callable[..., Any], *arguments: Any) -> Any:
    """Return the result of users' code; raises ``UserCodeError`` with file and line for any exception.

    Standard error is redirected to the same place as its ``print`` output.
    """
    before = call_note.begin(name, code)
    try:
        with redirect_stderr(sys.stdout):
            return code(*arguments)
    except (Exception, SystemExit) as error:  # any exception here is the user's error
        fault = fault_of(error, name, code)
        raise UserCodeError(f"{name} failed: {fault.summary}{_place(error, fault)}", fault) from error
    finally:
        call_note.end(before)


def refused(name: str, message: str, frames: tuple[Frame, ...] = ()) -> UserCodeError:
    """Return the error for users' code that raises nothing but returns an invalid answer."""
    return UserCodeError(message, with_digest(Fault("", message, name, frames)))


def definition_of(code: object) -> tuple[Frame, ...]:
    """Return where a function is defined: errors in its answer or its parameters are reported there."""
    compiled: Any = getattr(code, "__code__", None)
    if compiled is None:
        return ()
    return (Frame(str(compiled.co_filename), int(compiled.co_firstlineno), str(compiled.co_name)),)


def fault_of(error: BaseException, name: str, code: object = None) -> Fault:
    """Describe an exception raised by ``code``, called ``name``."""
    words = error.msg if isinstance(error, SyntaxError) else str(error)
    frames = tuple(_frames(error)) or tuple(frame for frame in definition_of(code) if not is_ours(frame.file))
    if len(frames) > MAX_FRAMES:
        frames = (*frames[: MAX_FRAMES // 2], *frames[-MAX_FRAMES // 2 :])
    return with_digest(Fault(type(error).__name__, encodable(str(words)[:MAX_WORDS]), name, frames))


def _frames(error: BaseException) -> Iterator[Frame]:
    """Yield the frames outside this package, without those of the import system."""
    for call in extract_tb(error.__traceback__):
        if not call.filename.startswith("<") and call.filename != importlib.__file__ and not is_ours(call.filename):
            yield Frame(call.filename, call.lineno or 1, call.name, call.line or "", not is_library(call.filename))
    if isinstance(error, SyntaxError) and error.filename:
        yield Frame(error.filename, error.lineno or 1, "", (error.text or "").strip())


def _place(error: BaseException, fault: Fault) -> str:
    """Return the place in the user's own files where an error was raised, as text."""
    place = fault.place
    return "" if place is None or isinstance(error, ModuleNotFoundError) else f" ({place.file}:{place.line})"
