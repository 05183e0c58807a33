"""Find one URI for each file. If the file system ignores case, ``Cell.bdd`` and ``cell.bdd`` can be one file."""

from __future__ import annotations

from pathlib import Path
from threading import Lock
from urllib.parse import unquote

from robbdd_tools.base.files import uri_to_path
from robbdd_tools.base.stored_names import is_same_file, stored_path, without_case


class Spellings:
    """Maps each URI of a file to a single one: the URI of an open document, or else the first URI that was used.

    Only URIs that differ just in case are compared on the disk, once, when the second URI is first used. All other
    calls look the URI up in memory. Several threads may use one object.
    """

    def __init__(self) -> None:
        self._chosen: dict[str, str] = {}
        self._open: set[str] = set()
        self._alike: dict[str, list[str]] = {}
        self._stored: dict[str, dict[tuple[str, int], Path | None]] = {}
        self._lock = Lock()

    def of(self, uri: str) -> str:
        """Return the URI that represents a file."""
        chosen = self._chosen.get(uri)
        if chosen is not None:
            return chosen
        with self._lock:
            return self._add(uri)

    def open(self, uri: str) -> list[str]:
        """Let the URI of an open document represent its file. Return the other URIs of the file.

        If the file is already open under another URI, that URI still represents the file. The new URI then names a
        document of its own.
        """
        with self._lock:
            before = self._add(uri)
            self._open.add(uri)
            others = [other for other in self._alike[_key(uri)] if self._chosen[other] == before and other != uri]
            if before != uri and before in self._open:
                others = []
            self._chosen |= dict.fromkeys((uri, *others), uri)
            return others

    def close(self, uri: str) -> None:
        """Record that a document is closed. If its file is then opened under another URI, that URI represents it."""
        with self._lock:
            self._open.discard(uri)

    def stored(self, uri: str, parts: int) -> Path | None:
        """Return a file's path with its last ``parts`` names as stored on disk; ``None`` if the URI has these names."""
        with self._lock:
            known = self._stored.setdefault(_key(uri), {})
            if (uri, parts) not in known:
                path = uri_to_path(uri)
                known[uri, parts] = None if path is None else stored_path(path, parts)
            return known[uri, parts]

    def reset(self, uri: str) -> list[str]:
        """Compare a file again, because its URI may lead to another file now. Return the URIs of the file."""
        with self._lock:
            self._stored.pop(_key(uri), None)
            alike = self._alike.pop(_key(uri), [])
            for other in alike:
                del self._chosen[other]
            for other in alike:
                if other in self._open:
                    self._add(other)
            return alike

    def clear(self) -> None:
        """Forget all files."""
        with self._lock:
            self._open.clear()
            self._stored.clear()
            self._chosen.clear()
            self._alike.clear()

    def _add(self, uri: str) -> str:
        known = self._chosen.get(uri)
        if known is None:
            alike = self._alike.setdefault(_key(uri), [])
            known = next((self._chosen[other] for other in alike if _is_same(other, uri)), uri)
            alike.append(uri)
            self._chosen[uri] = known
        return known


def _key(uri: str) -> str:
    return uri.lower() if "%" not in uri else without_case(unquote(uri, errors="surrogateescape"))


def _is_same(one: str, other: str) -> bool:
    first, second = uri_to_path(one), uri_to_path(other)
    return first is not None and second is not None and is_same_file(first, second)
