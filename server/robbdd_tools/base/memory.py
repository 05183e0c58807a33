"""Control garbage collection and caches: how long values are kept, and how often reference cycles are searched."""

from __future__ import annotations

import gc
from collections.abc import Callable, Generator
from contextlib import contextmanager
from functools import wraps
from typing import TypeVar
from weakref import ref

Key = TypeVar("Key")
Value = TypeVar("Value")

YOUNG, OLDER, OLD = 100_000, 50, 100
"""Thresholds of ``gc.set_threshold``.

The youngest generation is searched after ``YOUNG`` new objects, the middle one after ``OLDER`` searches of the
youngest, and the oldest one after ``OLD`` searches of the middle one.
"""


def collect_rarely() -> None:
    """Make Python search for reference cycles less often.

    Syntax trees have no cycles, and in a large project a search takes longer than the reaction to a keystroke may take.
    """
    gc.set_threshold(YOUNG, OLDER, OLD)


def collect_recent() -> None:
    """Free the reference cycles among the objects made since the last search. This takes a few milliseconds.

    Every rdflib graph is a cycle. Call this function after work that builds graphs, because after ``collect_rarely``
    they would accumulate. Every ``OLD``-th call searches all objects, because explicit searches keep Python from doing
    so. Otherwise, a cycle that is still in use during the first call after its creation would stay for ever.
    """
    gc.collect(2 if gc.get_count()[2] >= OLD else 1)


@contextmanager
def freeze_garbage_collection() -> Generator[None]:
    """Turn garbage collection off while modules are loaded. Objects made during this time are never collected."""
    gc.disable()
    yield
    gc.freeze()
    gc.enable()


def kept_with_key(function: Callable[[Key], Value]) -> Callable[[Key], Value]:
    """Cache the results of a function, except ``None``, for as long as its arguments exist.

    A result must not refer to the arguments.
    """
    # Several times as fast as a WeakKeyDictionary: rules ask for each declaration of a file after each keystroke.
    kept: dict[ref[Key], Value | None] = {}

    def forget(gone: ref[Key]) -> None:
        kept.pop(gone, None)

    @wraps(function)
    def call(key: Key) -> Value:
        found = kept.get(ref(key))
        if found is None:
            found = kept[ref(key, forget)] = function(key)
        return found

    return call
