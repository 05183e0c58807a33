"""Code that all handlers share: it catches errors and withholds answers about an outdated text."""

from __future__ import annotations

import asyncio
import inspect
import logging
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import wraps
from typing import Any, cast

from pygls.exceptions import JsonRpcContentModified, JsonRpcException, JsonRpcInternalError

_LOG = logging.getLogger(__name__)
Handler = Callable[..., Any]


@dataclass(eq=False)
class _Waiting:
    """A request in progress, with the document that the request is about."""

    method: str
    uri: str
    task: asyncio.Task[Any] | None
    outdated: bool = False


class Requests:
    """The requests in progress. ``repeated`` are the methods that the client repeats after a text change."""

    def __init__(self) -> None:
        self.repeated: frozenset[str] = frozenset()
        self._waiting: set[_Waiting] = set()

    def text_changed(self, uri: str) -> None:
        """Cancel requests about a document, because its text has changed.

        Only requests that the client repeats anyway are cancelled. They are answered with ``ContentModified``.
        """
        for waiting in self._waiting:
            if waiting.uri == uri and waiting.method in self.repeated and waiting.task is not None:
                waiting.outdated = True
                waiting.task.cancel()

    def with_logged_errors(self, method: str, handler: Handler) -> Handler:
        """Return a handler whose errors are logged with their context. The client gets a message of one sentence."""
        if inspect.iscoroutinefunction(handler):

            @wraps(handler)
            async def with_logged_errors(*arguments: Any) -> Any:
                waiting = _Waiting(method, _uri(arguments), asyncio.current_task())
                self._waiting.add(waiting)
                try:
                    with _inside(method, arguments):
                        return await handler(*arguments)
                except asyncio.CancelledError:
                    if waiting.outdated:
                        raise JsonRpcContentModified() from None
                    raise
                finally:
                    self._waiting.discard(waiting)
                    # The task's error refers to this frame: with the task in it, they would be a reference cycle.
                    waiting.task = None

            return with_logged_errors

        @wraps(handler)
        def guarded_at_once(*arguments: Any) -> Any:
            with _inside(method, arguments):
                return handler(*arguments)

        return guarded_at_once


@contextmanager
def _inside(method: str, arguments: tuple[Any, ...]) -> Generator[None]:
    try:
        yield
    except JsonRpcException:
        # A deliberate error response, such as a refused name.
        raise
    except Exception as error:
        _LOG.exception("internal error in %s", _context(method, arguments))
        message = f"internal error in {method} ({type(error).__name__}); the server's log has the details"
        raise JsonRpcInternalError(message) from None


def log_background_error(task: asyncio.Task[Any], what: str) -> None:
    """Log the error, if any, of a task that nobody awaits."""
    if not task.cancelled() and (error := task.exception()) is not None:
        _LOG.error("internal error in %s", what, exc_info=error)


def _context(method: str, arguments: tuple[Any, ...]) -> str:
    position = getattr(arguments[-1], "position", None) if arguments else None
    place = f", line {position.line + 1}, character {position.character}" if position is not None else ""
    return f"{method} {_uri(arguments)}{place}".rstrip()


def _uri(arguments: tuple[Any, ...]) -> str:
    """Return the document of parameters, if any."""
    params = arguments[-1] if arguments else None
    if isinstance(params, dict):
        return str(cast("dict[str, Any]", params).get("uri", ""))
    for holder in (getattr(params, "text_document", None), getattr(params, "item", None), params):
        if isinstance(uri := getattr(holder, "uri", None), str):
            return uri
    return ""
