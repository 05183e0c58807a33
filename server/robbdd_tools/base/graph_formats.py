"""The formats of graph files, by their extensions."""

from __future__ import annotations

from pathlib import PurePosixPath

GRAPH_FORMATS = {"ttl": "ttl", "json": "json-ld", "jsonld": "json-ld"}
"""Extension of a graph file → its format."""


def graph_format(uri: str) -> str:
    """Return the graph format of a file by its extension; ``""`` for any other file."""
    return GRAPH_FORMATS.get(PurePosixPath(uri).suffix.removeprefix(".").lower(), "")
