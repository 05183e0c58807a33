"""Garbage collection and caches: how long values are kept, and how often Python searches for reference cycles."""

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
"""Thresholds of ``gc.set_threshold``: objects made before the youngest are searched, and searches before each older
generation is."""


def collect_rarely() -> None:
    """Search for cycles less often: trees have none, and a search in a large project takes longer than a keystroke."""
    gc.set_threshold(YOUNG, OLDER, OLD)


def collect_recent() -> None:
    """Free the cycles among objects made since the last search, in a few milliseconds.

    Every rdflib graph is a cycle. Call this after work that builds graphs; after ``collect_rarely`` they would pile up.
    """
    gc.collect(1)


@contextmanager
def freeze_garbage_collection() -> Generator[None]:
    """Turn garbage collection off while modules are loaded, and exempt the objects made meanwhile for good."""
    gc.disable()
    yield
    gc.freeze()
    gc.enable()


def kept_with_key(function: Callable[[Key], Value]) -> Callable[[Key], Value]:
    """Cache a function's results for as long as its arguments live; the results must not refer to the arguments."""
    kept: WeakKeyDictionary[Key, Value] = WeakKeyDictionary()

    @wraps(function)
    def call(key: Key) -> Value:
        if key not in kept:
            kept[key] = function(key)
        return kept[key]

    return call
