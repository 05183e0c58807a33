"""Parameters of our own requests, which the protocol's schema does not check."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, cast

from lsprotocol import types
from pygls.exceptions import JsonRpcInvalidParams

LARGEST = 2**31 - 1
"""The largest number of the protocol."""


class Parameters:
    """The parameters sent by a client; each method raises ``JsonRpcInvalidParams`` for a value of another type."""

    def __init__(self, given: Any) -> None:
        # pygls converts JSON objects to named tuples and leaves all other values unchanged.
        self._given = cast("Mapping[str, Any]", given._asdict() if hasattr(given, "_asdict") else {})

    def text(self, name: str) -> str:
        """Return a required text."""
        found = self.optional_text(name)
        if found is None:
            raise JsonRpcInvalidParams(f"'{name}' is missing: it must be a text")
        return found

    def optional_text(self, name: str) -> str | None:
        """Return an optional text, ``None`` if absent."""
        found = self._given.get(name)
        if found is not None and not isinstance(found, str):
            raise JsonRpcInvalidParams(f"'{name}' must be a text")
        return found

    def optional_number(self, name: str) -> int | None:
        """Return an optional non-negative integer, ``None`` if absent."""
        found = self._given.get(name)
        if found is None:
            return None
        if isinstance(found, bool) or not isinstance(found, int) or not 0 <= found <= LARGEST:
            raise JsonRpcInvalidParams(f"'{name}' must be a whole number from 0 to {LARGEST}")
        return found

    def optional_position(self, name: str) -> types.Position | None:
        """Return an optional text position, ``None`` if absent."""
        found = self._given.get(name)
        if found is None:
            return None
        place = Parameters(found)
        line, character = place.optional_number("line"), place.optional_number("character")
        if line is None or character is None:
            raise JsonRpcInvalidParams(f"'{name}' must be a position with 'line' and 'character'")
        return types.Position(line, character)

    def run(self) -> str | None:
        """Return the stored run, a number or a word, ``None`` if absent."""
        found = self._given.get("run")
        return str(self.optional_number("run")) if isinstance(found, int) else self.optional_text("run")

    def others(self, *names: str) -> dict[str, Any]:
        """Return the present ones of some values."""
        return {name: self._given[name] for name in names if self._given.get(name) is not None}
