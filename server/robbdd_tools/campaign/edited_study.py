"""Check a study that is being edited, against the editor's texts instead of the files on disk."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Related, Severity
from robbdd_tools.base.files import path_to_uri, uri_to_path
from robbdd_tools.campaign.study_file import StudyLoader, StudyModels
from robbdd_tools.names.project import MAX_RELATED
from robbdd_tools.syntax.study_text import read_study
from robbdd_tools.workbench.model import NO_SCENARIO, DraftFile, Model, read_instances

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import SceneInstance
    from robbdd_tools.names.project import Project
    from robbdd_tools.syntax.study_content import StudyText


class EditedModels(StudyModels):
    """The models of a project, in which open texts replace the files on disk. Their shapes are not validated."""

    def __init__(self, project: Project) -> None:
        self._project = project

    def load(self, paths: Sequence[Path]) -> Model:
        """Return the models."""
        uris = [self._project.spellings.of(path_to_uri(path)) for path in paths]
        for uri in uris:
            self._project.load(uri)
        snapshot = self._project.snapshot()
        files = [DraftFile(snapshot, uri, str(path)) for uri, path in zip(uris, paths, strict=True)]
        return Model(paths[0], files, paths)

    def instances(self, paths: Sequence[Path]) -> tuple[SceneInstance, ...]:
        """Return the scene instances of files."""
        return read_instances(paths, lambda path: self.load([path]))


def study_diagnostics(project: Project, uri: str) -> list[Diagnostic]:
    """Return the findings about a study that need its models. The fast diagnostics have the findings about its form."""
    document, path = project.snapshot().document(uri), uri_to_path(uri)
    content, faults = read_study(document)
    if path is None:
        return []
    models = EditedModels(project)
    loader = StudyLoader(path, document, content, models, is_complete=not faults)
    for _ in loader.cells():
        pass
    return [*loader.faults, *(_of_models(uri, path.parent, content, models) if loader.broken else ())]


def _of_models(uri: str, folder: Path, content: StudyText, models: EditedModels) -> Iterator[Diagnostic]:
    """Yield a finding for each import of a model that has errors or no scenario."""
    for word in content.imports:
        (file,) = models.load([folder / word.text]).files
        errors = [one for one in file.diagnostics if one.severity is Severity.ERROR]
        if errors:
            related = tuple(Related(one.uri, one.span, one.message) for one in islice(errors, MAX_RELATED))
            counted = "an error" if len(errors) == 1 else f"{len(errors)} errors"
            message = f"'{word.text}' has {counted}, the first: {errors[0].message}"
            yield Diagnostic(uri, word.span, Severity.ERROR, "broken-import", message, related)
        elif not file.has_scenarios:
            yield Diagnostic(uri, word.span, Severity.ERROR, "study", NO_SCENARIO)
