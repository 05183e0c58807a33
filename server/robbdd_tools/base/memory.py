"""What is kept for how long, and how often Python looks for reference cycles."""

from __future__ import annotations

import gc
from collections.abc import Callable, Generator
from contextlib import contextmanager
from functools import wraps
from typing import TypeVar
from weakref import WeakKeyDictionary

Key = TypeVar("Key")
Value = TypeVar("Value")

YOUNG, OLDER, OLD = 100_000, 50, 100
"""Objects made before the youngest are searched, and searches before the next older ones are, as Python counts them."""


def collect_rarely() -> None:
    """Search for cycles less often: trees have none, and a search of a large project takes longer than a keystroke."""
    gc.set_threshold(YOUNG, OLDER, OLD)


def collect_recent() -> None:
    """Free the cycles among objects made since the last search, in a few milliseconds.

    Every rdflib graph is a cycle. Call this after work that builds graphs, which ``collect_rarely`` would let pile up.
    """
    gc.collect(1)


@contextmanager
def nothing_to_collect() -> Generator[None]:
    """Search for no cycles while modules are loaded, nor ever in what was made meanwhile: it stays to the end."""
    gc.disable()
    yield
    gc.freeze()
    gc.enable()


def kept_with_key(function: Callable[[Key], Value]) -> Callable[[Key], Value]:
    """Keep the results of a function as long as the objects that it was called with, which they must not hold."""
    kept: WeakKeyDictionary[Key, Value] = WeakKeyDictionary()

    @wraps(function)
    def call(key: Key) -> Value:
        if key not in kept:
            kept[key] = function(key)
        return kept[key]

    return call
