"""Use open documents as models of the workbench, including unsaved text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.workbench.model import NO_SCENARIO, ModelErrors, ModelFile, NothingToRun

if TYPE_CHECKING:
    from robbdd_tools.gherkin.feature_files import FeaturePlan
    from robbdd_tools.names.project import Snapshot


def runnable_model(snapshot: Snapshot, uri: str) -> ModelFile:
    """Return a document as a model that has scenarios. Raises ``ModelErrors`` and ``NothingToRun``."""
    file = ModelFile(snapshot, uri, uri)
    if not file.has_scenarios:
        raise NothingToRun(NO_SCENARIO)
    return file


def feature_plan(snapshot: Snapshot, uri: str) -> FeaturePlan:
    """Return the plan for writing the features of a document. Raises ``ModelErrors`` and ``NothingToRun``."""
    from robbdd_tools.gherkin.feature_files import clause_origins, whole_plan

    file = runnable_model(snapshot, uri)
    return whole_plan(file.acceptance, clause_origins(file.graph, snapshot, file.acceptance))


def reason(error: Exception) -> str:
    """Return an error as one sentence for a message.

    A finding of a model is given with its place, since its file may not be open; the text shows the others.
    """
    if isinstance(error, ModelErrors):
        first = error.findings[0]
        file = first.place.uri if first.place.path is None else first.place.path.name
        return f"the model has errors, the first: {first.message} ({file}, line {first.place.line})"
    return str(error)
