"""Load the graph of a study, for the commands that query or print it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.commands.models import print_findings
from robbdd_tools.commands.output import fail, print_note

if TYPE_CHECKING:
    from robbdd_tools.graph.write.built import BuiltGraph


def graph_of_study(path: Path, results: str | None) -> BuiltGraph | None:
    """Return the graph of a study, with its results unless ``results`` is ``None``.

    If it cannot be used, the problem is printed and ``None`` is returned. A study has one set of results, so
    ``results`` names no run.
    """
    from robbdd_tools.campaign.study_file import load_study
    from robbdd_tools.campaign.study_graph import study_graph
    from robbdd_tools.campaign.study_place import open_results, study_folder
    from robbdd_tools.graph.write.run_results import BadResults
    from robbdd_tools.run.store import LATEST

    if results not in (None, LATEST):
        fail(f"--results {results}: a study has one set of results: give --results without a value")
        return None
    try:
        study = load_study(path)
        print_findings((one for one in study.findings if one.is_error), print_note)
        if any(one.is_error for one in study.findings):
            return None
        if results is None:
            return study_graph(study)
        with open_results(study_folder(path, None)) as store:
            return study_graph(study, store)
    except (BadResults, OSError, RobbddError) as error:
        fail(str(error))
        return None
