"""Checkpoints: points in long work where it can be interrupted safely."""

from __future__ import annotations

from collections.abc import Callable, Generator
from contextlib import contextmanager
from threading import local


class Abandoned(Exception):
    """The work is abandoned because its result is no longer needed."""


class _Watch(local):
    look: Callable[[], None] | None = None


_watch = _Watch()


def checkpoint() -> None:
    """Allow an interruption of the current work. Raises the exception of the function given to ``watched``."""
    if _watch.look is not None:
        _watch.look()


@contextmanager
def watched(look: Callable[[], None]) -> Generator[None]:
    """Call ``look`` at each checkpoint of this thread inside the ``with`` block."""
    before, _watch.look = _watch.look, look
    try:
        yield
    finally:
        _watch.look = before
