"""Documents as models of the workbench, with unsaved text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.workbench.model import NO_SCENARIO, ModelErrors, ModelFile, NothingToRun

if TYPE_CHECKING:
    from robbdd_tools.gherkin.feature_files import FeaturePlan
    from robbdd_tools.names.project import Snapshot


def runnable_model(snapshot: Snapshot, uri: str) -> ModelFile:
    """Return a document as a model with scenarios; raises ``ModelErrors`` and ``NothingToRun``."""
    file = ModelFile(snapshot, uri, uri)
    if not file.has_scenarios:
        raise NothingToRun(NO_SCENARIO)
    return file


def feature_plan(snapshot: Snapshot, uri: str) -> FeaturePlan:
    """Return the features of a document; raises ``ModelErrors`` and ``NothingToRun``."""
    from robbdd_tools.gherkin.feature_files import clause_origins, whole_plan

    file = runnable_model(snapshot, uri)
    return whole_plan(file.acceptance, clause_origins(file.graph, snapshot, file.acceptance))


def reason(error: Exception) -> str:
    """Return an error as one sentence for a message; the model's findings are already shown in its text."""
    if isinstance(error, ModelErrors):
        return f"the model has errors, the first: {error.findings[0].message}"
    return str(error)
