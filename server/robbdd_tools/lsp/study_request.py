"""The request ``robbdd/study``: the stored executions of a study, whichever process has executed it.

The parameter is the ``uri`` of a ``.study`` file. ``docs/schemas/study.schema.json`` describes the answer.
"""

from __future__ import annotations

from itertools import groupby, islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.files import uri_to_path
from robbdd_tools.features.studies import is_study
from robbdd_tools.lsp.parameters import Parameters
from robbdd_tools.lsp.stored_runs import answered
from robbdd_tools.run.store import NoSuchRun

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from robbdd_tools.lsp.server import RobbddServer
    from robbdd_tools.run.study_reader import StudyReader

STUDY = "robbdd/study"
MAX_EXECUTIONS = 10_000
"""Maximum number of executions in an answer."""


def register_study_results(server: RobbddServer) -> None:
    """Add the request to a server."""

    @server.feature(STUDY)
    async def study(params: Any) -> dict[str, Any]:
        uri = Parameters(params).text("uri")
        return await answered(lambda: _results(_path(uri)))


def _path(uri: str) -> Path:
    path = uri_to_path(uri)
    if path is None or not is_study(uri):
        raise NoSuchRun(f"'{uri}' is not the file of a study")
    return path


def _results(path: Path) -> dict[str, Any]:
    from robbdd_tools.campaign.study_place import StudyProblem, is_executed, open_results, study_folder

    folder = study_folder(path)
    try:
        with open_results(folder) as store:
            counts = {str(verdict): number for verdict, number in store.verdicts().items()}
            return {
                "name": store.fact("name") or path.stem,
                "total": int(store.fact("total") or 0),
                "running": is_executed(folder),
                "counts": {"holds": 0, "violated": 0, "unknown": 0} | counts,
                "executions": list(islice(_executions(store), MAX_EXECUTIONS)),
            }
    except StudyProblem as error:
        raise NoSuchRun(str(error)) from error


def _executions(store: StudyReader) -> Iterator[dict[str, Any]]:
    for number, group in groupby(store.rows(), key=lambda row: int(row["number"])):
        clauses = list(group)
        first = clauses[0]
        yield {
            "number": number,
            "variant": first["variant"],
            "name": first["scenario"],
            "values": {
                name.removeprefix("level."): value for name, value in first.items() if name.startswith("level.")
            },
            "verdict": first["scenario_verdict"],
            "clauses": list(map(_clause, clauses)),
        }


def _clause(row: Mapping[str, Any]) -> dict[str, Any]:
    from robbdd_tools.campaign.study_clauses import clause_words

    name = row["clause"]
    return {
        # A study stores no IRIs of clauses.
        "iri": name,
        "name": clause_words(name),
        "verdict": row["verdict"],
        "robustness": row["margin"],
        "unit": row["unit"],
    }
