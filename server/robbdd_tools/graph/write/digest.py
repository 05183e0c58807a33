"""Compute digests of graphs."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING

from robbdd_tools.graph.rdf.serialize import serialize

if TYPE_CHECKING:
    from collections.abc import Iterable

    from robbdd_tools.graph.write.built import BuiltGraph


def graph_digest(built: BuiltGraph) -> str:
    """Return the SHA-256 of a graph, written as N-Triples, in hexadecimal digits."""
    return hashlib.sha256(serialize(built.graph, "nt").encode()).hexdigest()


def joint_digest(digests: Iterable[str]) -> str:
    """Return one digest for several digests, independent of their order."""
    return hashlib.sha256("".join(sorted(digests)).encode()).hexdigest()
