"""``robbdd import``: convert a graph to RobBDD text and report what the language cannot express."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.writing import replace_file
from robbdd_tools.commands import FAILED, OK
from robbdd_tools.commands.models import valid_model
from robbdd_tools.commands.output import fail, print_line, print_note
from robbdd_tools.names.project import Project

if TYPE_CHECKING:
    from robbdd_tools.graph.text.losses import Losses
    from robbdd_tools.graph.text.model_text import ModelText
    from robbdd_tools.graph.write.built import BuiltGraph

_FOLDER = "file:///imported/"
_MODEL = "model.bdd"


def import_model(path: Path, output: Path, *, more: Sequence[Path] = (), overwrite: bool) -> int:
    """Write a model as RobBDD text to ``output``. Scenes are written to a ``.scene`` with the same name.

    ``more`` are further graph files that belong to the model.
    """
    from robbdd_tools.graph.rdf.records import Incomplete
    from robbdd_tools.graph.text.losses import compare
    from robbdd_tools.graph.text.model_text import write_model

    if output.suffix != ".bdd":
        return fail(f"{output} cannot hold the text: its name must end in .bdd")
    scene = output.with_suffix(".scene")
    present = [file for file in (output, scene) if file.exists()]
    if present and not overwrite:
        return fail(f"{present[0]} exists already; --force replaces it")
    model = valid_model(path, more)
    if model is None:
        return FAILED
    graph = model.graph.graph
    try:
        text = write_model(graph, scene.name)
    except Incomplete as error:
        return fail(f"{path} cannot be written as text: {error}")
    project = _opened(text, scene.name)
    fault = _first_error(project, scene.name)
    if fault is not None:
        return fail(f"{path} cannot be written as text, as the text would have an error: {fault}")
    losses, of_scene = (compare(graph, _graph(project, asked).graph, text.renamed) for asked in (_MODEL, scene.name))
    # Elements that no scenario uses are in the scene's own graph alone.
    _report(path, text, replace(losses, lost=tuple(line for line in losses.lost if line in set(of_scene.lost))))
    try:
        for file, content in ((output, text.criteria), (scene, text.scene)):
            if content:
                replace_file(file, content)
                print_line(str(file))
    except OSError as error:
        return fail(f"cannot write {error.filename or output}: {error.strerror or error}")
    return OK


def _opened(text: ModelText, scene_name: str) -> Project:
    """Return a project with an unsaved text."""
    project = Project()
    project.open(_FOLDER + _MODEL, 1, text.criteria)
    project.open(_FOLDER + scene_name, 1, text.scene)
    return project


def _graph(project: Project, name: str) -> BuiltGraph:
    """Return the graph of a file in the project, which is either the model or its scene."""
    from robbdd_tools.graph.write.build import build_graph

    return build_graph(project.snapshot(), _FOLDER + name)


def _first_error(project: Project, scene_name: str) -> str | None:
    """Return the first error of a written text with its line, or ``None``."""
    from robbdd_tools.features.diagnostics import fast_diagnostics

    snapshot = project.snapshot()
    for name in (scene_name, _MODEL):
        file = snapshot.file(_FOLDER + name)
        for finding in fast_diagnostics(snapshot, _FOLDER + name):
            if finding.severity is Severity.ERROR:
                line = file.document.line_text(file.document.position(finding.span.start).line) if file else ""
                return f"{finding.message}, in '{line.strip()}'"
    return None


def _report(path: Path, text: ModelText, losses: Losses) -> None:
    for node, reason in text.left_out.items():
        print_note(f"{path}: warning: {node} is not written: {reason} [left-out]")
    for old, new in losses.renamed:
        print_note(f"{path}: warning: {old} becomes {new}, as the language forms names [renamed]")
    for line in losses.lost:
        print_note(f"{path}: warning: the language cannot express: {line} [lost]")
    for line in losses.added:
        print_note(f"{path}: warning: the text adds: {line} [added]")
