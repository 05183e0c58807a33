"""``robbdd graph``: a model as its knowledge graph."""

from __future__ import annotations

import sys
from pathlib import Path

from robbdd_tools.base.files import path_to_uri
from robbdd_tools.commands import FAILED, OK
from robbdd_tools.commands.models import sound_model


def print_graph(path: Path, form: str) -> int:
    """Print the graph of a model and its imports; returns the exit code."""
    from robbdd_tools.graph.build import build_graph
    from robbdd_tools.graph.serialize import serialize

    snapshot = sound_model(path)
    if snapshot is None:
        return FAILED
    sys.stdout.write(serialize(build_graph(snapshot, path_to_uri(path)).graph, form))
    return OK
