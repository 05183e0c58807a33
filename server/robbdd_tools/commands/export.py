"""``robbdd graph``: print a model's knowledge graph."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import uri_to_path
from robbdd_tools.commands import FAILED, OK
from robbdd_tools.commands.graph_of_study import graph_of_study
from robbdd_tools.commands.graph_results import graph_with_results
from robbdd_tools.commands.models import valid_model
from robbdd_tools.commands.output import fail, print_document
from robbdd_tools.syntax.study_content import STUDY

if TYPE_CHECKING:
    from robbdd_tools.graph.write.built import BuiltGraph
    from robbdd_tools.graph.write.source_map import Location
    from robbdd_tools.names.project import Snapshot

STUDY_FILE = f".{STUDY}"
PICTURE = "svg"
"""Format of a picture of the structure; all others are formats of the graph."""


def print_graph(path: Path, more: Sequence[Path], form: str, results: str | None) -> int:
    """Print the graph of a model and its imports, and return the exit code.

    ``more`` are further graph files that belong to the model. ``results`` names a run whose results are added to the
    graph.
    """
    from robbdd_tools.graph.rdf.serialize import UnwritableGraph, serialize

    if path.suffix == STUDY_FILE:
        return _print_graph_of_study(path, form, results)
    model = valid_model(path, more)
    if model is None:
        return FAILED
    built = graph_with_results(model, path, results)
    if built is None:
        return FAILED
    try:
        print_document(_picture(model.snapshot, built, path) if form == PICTURE else serialize(built.graph, form))
    except UnwritableGraph as error:
        return fail(f"{path}: {error}")
    return OK


def _print_graph_of_study(path: Path, form: str, results: str | None) -> int:
    from robbdd_tools.graph.rdf.serialize import UnwritableGraph, serialize

    if form == PICTURE:
        return fail(f"{path} is a study, which has no picture: draw one of its models")
    built = graph_of_study(path, results)
    if built is None:
        return FAILED
    try:
        print_document(serialize(built.graph, form))
    except UnwritableGraph as error:
        return fail(f"{path}: {error}")
    return OK


def _picture(snapshot: Snapshot, built: BuiltGraph, path: Path) -> str:
    """Return the structure of a model as SVG. The places in it name files relative to the model's folder."""
    from robbdd_tools.graph.ask.structure import structure_of
    from robbdd_tools.graph.ask.svg import draw

    def source(location: Location) -> str:
        file, analysis = uri_to_path(location.uri), snapshot.file(location.uri)
        if file is None or analysis is None:
            return ""
        start = analysis.document.position(location.span.start)
        name = Path(os.path.relpath(file, path.absolute().parent)).as_posix()
        return f"{name}:{start.line + 1}:{start.column + 1}"

    return draw(structure_of(built), source)
