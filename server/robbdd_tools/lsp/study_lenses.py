"""Code lenses of a study. The client executes them on the command line, because a study may take hours."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

from robbdd_tools.base.files import uri_to_path
from robbdd_tools.features.outline import outline

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer
    from robbdd_tools.names.project import Snapshot

RUN_STUDY = "robbdd.runStudy"
RESUME_STUDY = "robbdd.resumeStudy"
SHOW_RESULTS = "robbdd.showStudyResults"
SHOW_STUDY = "robbdd.showStudy"


def study_lenses(ls: RobbddServer, snapshot: Snapshot, uri: str) -> list[types.CodeLens]:
    """Return the lenses at the name of a study: to begin it or, if it has been begun, to continue and to show it."""
    from robbdd_tools.campaign.study_place import has_results, study_folder

    path = uri_to_path(uri)
    studies = outline(snapshot, uri)
    if not ls.runs_studies or path is None or not studies:
        return []
    commands = [("Run study", RUN_STUDY)]
    if has_results(study_folder(path)):
        commands = [("Resume study", RESUME_STUDY), ("Show results", SHOW_RESULTS), ("Show executions", SHOW_STUDY)]
    place = ls.convert.range(snapshot.document(uri), studies[0].span)
    target = {"uri": uri}
    return [types.CodeLens(place, types.Command(title, command, arguments=[target])) for title, command in commands]
