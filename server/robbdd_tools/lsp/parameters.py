"""Read the parameters of RobBDD's own requests, which the schema of the protocol does not check."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, cast

from lsprotocol import types
from pygls.exceptions import JsonRpcInvalidParams

LARGEST = 2**31 - 1
"""The largest number of the protocol."""


class Parameters:
    """The parameters that a client sent. Each method raises ``JsonRpcInvalidParams`` for a value of the wrong type."""

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
        """Return an optional text, or ``None`` if it is absent."""
        found = self._given.get(name)
        if found is not None and not isinstance(found, str):
            raise JsonRpcInvalidParams(f"'{name}' must be a text")
        return found

    def optional_number(self, name: str) -> int | None:
        """Return an optional non-negative integer, or ``None`` if it is absent."""
        found = self._given.get(name)
        if found is None:
            return None
        if isinstance(found, bool) or not isinstance(found, int) or not 0 <= found <= LARGEST:
            raise JsonRpcInvalidParams(f"'{name}' must be a whole number from 0 to {LARGEST}")
        return found

    def optional_position(self, name: str) -> types.Position | None:
        """Return an optional text position, or ``None`` if it is absent."""
        found = self._given.get(name)
        if found is None:
            return None
        place = Parameters(found)
        line, character = place.optional_number("line"), place.optional_number("character")
        if line is None or character is None:
            raise JsonRpcInvalidParams(f"'{name}' must be a position with 'line' and 'character'")
        return types.Position(line, character)

    def run(self) -> str | None:
        """Return the number or the word that names a stored run, or ``None`` if it is absent."""
        found = self._given.get("run")
        return str(self.optional_number("run")) if isinstance(found, int) else self.optional_text("run")

    def others(self, *names: str) -> dict[str, Any]:
        """Return those of the named parameters that are present."""
        return {name: self._given[name] for name in names if self._given.get(name) is not None}
