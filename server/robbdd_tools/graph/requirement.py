"""A requirement as plain data."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Requirement:
    """A requirement. ``identifier`` is its identifier in other tools; it and ``source`` are empty if not stated."""

    iri: str
    text: str
    identifier: str = ""
    source: str = ""
