"""Read the acceptance criteria or the scene instances of a file with the source positions of their executed parts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.base.files import uri_to_path
from robbdd_tools.catalog.executable import Origin
from robbdd_tools.graph.read.acceptance import read_instances, read_model

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import SceneInstance
    from robbdd_tools.graph.acceptance_model import AcceptanceModel
    from robbdd_tools.graph.read.instances import Places
    from robbdd_tools.graph.write.built import BuiltGraph
    from robbdd_tools.names.project import Snapshot


def placed_model(built: BuiltGraph, snapshot: Snapshot) -> AcceptanceModel:
    """Return the acceptance criteria of a graph, with source positions. The graph was built from the snapshot."""
    return read_model(built.graph, _places(built, snapshot))


def placed_instances(built: BuiltGraph, snapshot: Snapshot) -> tuple[SceneInstance, ...]:
    """Return the scene instances of a graph, with source positions. The graph was built from the snapshot."""
    return read_instances(built.graph, _places(built, snapshot))


def _places(built: BuiltGraph, snapshot: Snapshot) -> Places:
    def place(node: str) -> Origin | None:
        location = built.sources.node(node)
        analysis = None if location is None else snapshot.file(location.uri)
        path = None if location is None else uri_to_path(location.uri)
        if location is None or analysis is None or path is None:
            return None
        start = analysis.document.position(location.span.start)
        return Origin(str(path), start.line + 1, start.column + 1)

    return place
