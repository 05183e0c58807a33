"""Lets long work be interrupted where nothing is half done, without knowing who interrupts it or why."""

from __future__ import annotations

from collections.abc import Callable, Generator
from contextlib import contextmanager
from threading import local


class Abandoned(Exception):
    """Nobody waits for this work any more."""


class _Watch(local):
    look: Callable[[], None] | None = None


_watch = _Watch()


def checkpoint() -> None:
    """Tell whoever watches this thread that it may interrupt; raises what it raises, such as ``Abandoned``."""
    if _watch.look is not None:
        _watch.look()


@contextmanager
def watched(look: Callable[[], None]) -> Generator[None]:
    """Call ``look`` at each checkpoint of this thread for a while."""
    before, _watch.look = _watch.look, look
    try:
        yield
    finally:
        _watch.look = before
