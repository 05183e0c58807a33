"""``robbdd graph`` and ``robbdd gherkin``: a model in another form."""

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


def write_gherkin(path: Path, folder: Path) -> int:
    """Write the features of a model and print their paths; returns the exit code."""
    from robbdd_tools.graph.build import build_graph
    from robbdd_tools.graph.read import read_model
    from robbdd_tools.run.prepare import write_features

    snapshot = sound_model(path)
    if snapshot is None:
        return FAILED
    model = read_model(build_graph(snapshot, path_to_uri(path)).graph)
    if not model.stories:
        print(f"robbdd: {path} has no user story with a scenario, so there is no feature to write", file=sys.stderr)
        return FAILED
    try:
        for written in write_features(model, folder):
            print(written)
    except OSError as error:
        print(f"robbdd: cannot write to {folder}: {error.strerror or error}", file=sys.stderr)
        return FAILED
    return OK
