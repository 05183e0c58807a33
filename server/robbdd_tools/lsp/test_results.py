"""The requests ``robbdd/testResults`` and ``robbdd/importResults``: results of earlier runs, or of runs made elsewhere.

``robbdd/testResults`` has no parameters. The parameter of ``robbdd/importResults`` is the ``uri`` of a file that
``robbdd run --json`` or ``--junit`` wrote. ``docs/schemas/testresults.schema.json`` describes both answers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robbdd_tools.base.files import Unreadable, read_text, uri_to_path
from robbdd_tools.features.clause_results import verdict_of
from robbdd_tools.features.executions import executions_of
from robbdd_tools.features.run_verdicts import Digests, JudgedScenario, digests_of
from robbdd_tools.features.stories import stories_in, story_files
from robbdd_tools.lsp.parameters import Parameters

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from robbdd_tools.lsp.server import RobbddServer
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.run.imported import ImportedScenario

KEPT = "robbdd/testResults"
IMPORT = "robbdd/importResults"


def register_test_results(server: RobbddServer) -> None:
    """Add the requests to a server."""

    @server.feature(KEPT)
    async def kept(ls: RobbddServer, _: Any) -> dict[str, Any]:
        folders = list(ls.workspace.folders)
        files = await ls.in_background(lambda snapshot: story_files(snapshot, folders))
        await ls.stored_verdicts.look_beside(*files)
        scenarios = [scenario for scenario in ls.results if _is_shown(scenario)]
        models = sorted({scenario.model for scenario in scenarios})
        return await ls.in_background(lambda snapshot: _kept(snapshot, scenarios, models), *models)

    @server.feature(IMPORT)
    async def imported(ls: RobbddServer, params: Any) -> dict[str, Any]:
        uri, folders = Parameters(params).text("uri"), list(ls.workspace.folders)
        read = await ls.in_background(lambda _: _read(uri))
        if isinstance(read, str):
            return {"problem": read, "left": 0, "scenarios": []}
        files = await ls.in_background(lambda snapshot: story_files(snapshot, folders))
        return await ls.in_background(lambda snapshot: _matched(snapshot, read, files), *files)


def _is_shown(scenario: JudgedScenario) -> bool:
    """Whether the tree of tests shows a scenario.

    A cancelled run leaves scenarios open. If all of their judged clauses hold, the tree would show that they passed.
    """
    return scenario.finished or any(judgement.outcome != "holds" for judgement in scenario.clauses.values())


def _kept(snapshot: Snapshot, scenarios: Sequence[JudgedScenario], models: Iterable[str]) -> dict[str, Any]:
    digests = {uri: digests_of(snapshot, uri) for uri in models if snapshot.file(uri) is not None}
    known = [scenario for scenario in scenarios if scenario.model in digests]
    return {
        "problem": None,
        "left": len(scenarios) - len(known),
        "scenarios": [_kept_scenario(scenario, digests[scenario.model]) for scenario in known],
    }


def _kept_scenario(scenario: JudgedScenario, now: Digests) -> dict[str, Any]:
    row = now.rows.get((scenario.variant, scenario.variation), "")
    same = scenario.digest == now.variants.get(scenario.variant) and scenario.row == row
    return {
        "uri": scenario.model,
        "variant": scenario.variant,
        "execution": scenario.execution or None,
        "variation": scenario.variation,
        "values": scenario.values,
        "seconds": None,
        "stale": not same or scenario.execution_digest != now.executions.get(scenario.execution, ""),
        "clauses": [
            {
                "clause": iri,
                "position": None,
                "sentence": "",
                "verdict": verdict_of(judgement.outcome),
                "margin": judgement.margin,
                "said": judgement.said,
                "failure": judgement.failure or judgement.said,
                "because": _because(judgement.because or None, None, judgement.because_words),
                "stale": judgement.digest != now.clauses.get(iri),
            }
            for iri, judgement in scenario.clauses.items()
        ],
    }


def _read(uri: str) -> list[ImportedScenario] | str:
    """Return the contents of a results file, or the reason why it cannot be read."""
    from robbdd_tools.run.imported import BrokenResults, read_results

    path = uri_to_path(uri)
    text = Unreadable("file-missing", f"'{uri}' is not a file") if path is None else read_text(path)
    if isinstance(text, Unreadable):
        return text.reason
    try:
        return read_results(text)
    except BrokenResults as error:
        name = uri if path is None else path.name
        return f"{name}, line {error.line}, column {error.column}: {error}"


def _matched(snapshot: Snapshot, scenarios: Sequence[ImportedScenario], files: Sequence[str]) -> dict[str, Any]:
    """Match imported results with variants and executions of models.

    A variant is matched by its IRI or, without one, by the names of its story and of itself.
    """
    places: dict[str, list[tuple[str, str]]] = {}
    executions: dict[tuple[str, str], list[tuple[str, str]]] = {}
    for uri in files:
        for one in executions_of(snapshot, uri):
            executions.setdefault((one.variant.iri, one.definition.symbol.name), []).append((uri, one.iri))
        for story in stories_in(snapshot, uri):
            for variant in story.variants:
                place = (uri, variant.placed.iri)
                named = f"{story.definition.symbol.name} {variant.placed.definition.symbol.name}"
                for key in (variant.placed.iri, named):
                    places.setdefault(key, []).append(place)
    answers: list[dict[str, Any]] = []
    for scenario in scenarios:
        place = _place(scenario, places.get(scenario.variant) or places.get(f"{scenario.story} {scenario.variant}"))
        if place is not None:
            executed = _place(scenario, executions.get((place[1], scenario.execution)))
            answers.append(_imported_scenario(scenario, *place, *(executed or ())))
    return {"problem": None, "left": len(scenarios) - len(answers), "scenarios": answers}


def _place(scenario: ImportedScenario, candidates: Sequence[tuple[str, str]] | None) -> tuple[str, str] | None:
    """Return the file and the IRI of a matching variant.

    If several files match, prefer the one that the results name.
    """
    candidates = candidates or ()
    name = scenario.model.replace("\\", "/").rsplit("/", 1)[-1]
    return next((place for place in candidates if name and place[0].endswith(f"/{name}")), next(iter(candidates), None))


def _imported_scenario(
    scenario: ImportedScenario, uri: str, variant: str, executing: str = "", execution: str | None = None
) -> dict[str, Any]:
    return {
        "uri": executing or uri,
        "variant": variant,
        "execution": execution,
        "variation": scenario.variation,
        "values": scenario.values,
        "seconds": scenario.seconds,
        "stale": False,
        "clauses": [
            {
                "clause": clause.iri,
                "position": position,
                "sentence": clause.sentence,
                "verdict": clause.verdict,
                "margin": clause.margin,
                "said": clause.said,
                "failure": clause.failure,
                "because": clause.because
                and _because(clause.because.iri, clause.because.position, clause.because.words),
                "stale": False,
            }
            for position, clause in enumerate(scenario.clauses)
        ],
    }


def _because(clause: str | None, position: int | None, words: str) -> dict[str, Any] | None:
    """Return the clause that makes another one unknown; ``None`` if ``words`` name no clause."""
    return {"clause": clause, "position": position, "words": words} if words else None
