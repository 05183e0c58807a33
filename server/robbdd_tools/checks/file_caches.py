"""Cache results by the URI of a file. All caches can be disabled together, to compare with fresh results."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from typing import Any, Generic, TypeVar

CACHED_FILES = 256
Value = TypeVar("Value")
_CACHES: list[FileCache[Any]] = []


class FileCache(Generic[Value]):
    """Holds the latest result for each file."""

    def __init__(self) -> None:
        self._latest: dict[str, Value] = {}
        _CACHES.append(self)

    def get(self, uri: str) -> Value | None:
        """Return the latest result of a file."""
        return self._latest.get(uri)

    def put(self, uri: str, value: Value) -> None:
        """Replace the result of a file. If the cache is full, all other results are dropped."""
        if len(self._latest) >= CACHED_FILES:
            self._latest.clear()
        self._latest[uri] = value

    def exchange(self, latest: dict[str, Value]) -> dict[str, Value]:
        """Replace all results and return the old ones."""
        former, self._latest = self._latest, latest
        return former


@contextmanager
def without_cache() -> Generator[None]:
    """Begin with empty caches inside the block, and restore them afterwards."""
    kept = [(cache, cache.exchange({})) for cache in _CACHES]
    yield
    for cache, latest in kept:
        cache.exchange(latest)
