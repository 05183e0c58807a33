"""The request ``robbdd/tests``: the items that can be run, level by level, for a test tree.

Without parameters, the answer has the files that contain such items. With ``uri``, it has the stories of the file and
their variants, or the executions of a ``.bddx``. With ``uri`` and ``variant`` (IRI), it has ``most`` scenarios from
number ``first`` on, and their clauses. ``docs/schemas/tests.schema.json`` describes the answer.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.features.executions import PlacedExecution, executions_of
from robbdd_tools.features.pass_rates import execution_rate, pass_rate
from robbdd_tools.features.project_findings import ProjectFindings
from robbdd_tools.features.run_verdicts import execution_digest, variant_digest
from robbdd_tools.features.scenarios import number_of_scenarios
from robbdd_tools.features.stories import ListedStory, ListedVariant, stories_in, story_files
from robbdd_tools.lsp.document_models import feature_plan, reason
from robbdd_tools.lsp.locations import Places, places_of
from robbdd_tools.lsp.parameters import Parameters
from robbdd_tools.names.clause_places import clauses_in
from robbdd_tools.workbench.judged_scenarios import project_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from lsprotocol import types

    from robbdd_tools.features.pass_rates import PassRate
    from robbdd_tools.features.run_verdicts import Findings
    from robbdd_tools.lsp.convert import Converter
    from robbdd_tools.lsp.server import RobbddServer
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.run.listing import ListedScenario

TESTS = "robbdd/tests"
MAX_SCENARIOS = 10_000
"""Maximum number of scenarios in one answer unless fewer are requested."""


def register_tests(server: RobbddServer) -> None:
    """Add the request to a server."""

    @server.feature(TESTS)
    async def tests(ls: RobbddServer, params: Any) -> dict[str, Any]:
        asked = Parameters(params)
        uri, variant = asked.optional_text("uri"), asked.optional_text("variant")
        if uri is None:
            folders = list(ls.workspace.folders)
            files = await ls.in_background(lambda snapshot: story_files(snapshot, folders))
            return {"problem": None, "files": files, "tests": []}
        if variant is None:
            await ls.stored_verdicts.look_beside(uri)
            # Those that the server shows may be older: it gathers results before it shows them.
            findings = ProjectFindings(ls.results, ls.rejudging.executions)
            return await ls.in_background(
                lambda snapshot: _stories(snapshot, ls.convert, uri, findings.of_file(snapshot, uri, project_of(uri))),
                uri,
            )
        first = max(1, asked.optional_number("first") or 1)
        most = min(MAX_SCENARIOS, asked.optional_number("most") or MAX_SCENARIOS)
        return await ls.in_background(lambda snapshot: _scenarios(snapshot, ls.convert, uri, variant, first, most), uri)


def _stories(snapshot: Snapshot, convert: Converter, uri: str, findings: Findings) -> dict[str, Any]:
    """Answer with the stories of a file. If its text has errors, answer with the stories that can be recognised.

    A variant or an execution of which only some scenarios have results says so, because a tree shows that it passed.
    """

    def story(listed: ListedStory) -> dict[str, Any]:
        return {
            **_declared("story", listed.iri, listed.definition),
            "detail": listed.wants,
            "tests": [variant(each) for each in listed.variants],
        }

    def variant(listed: ListedVariant) -> dict[str, Any]:
        placed = listed.placed
        partly = _partly(pass_rate(snapshot, placed, findings, listed.count))
        return {
            **_declared("variant", placed.iri, placed.definition),
            "detail": partly or _counted(listed.count, "scenario"),
            "count": listed.count,
            "digest": variant_digest(snapshot, placed),
            "variation": convert.location(snapshot, placed.definition.uri, listed.variation),
        }

    def execution(one: PlacedExecution) -> dict[str, Any]:
        variant, count = one.variant, number_of_scenarios(one.variant)
        partly = _partly(execution_rate(snapshot, one, findings, count))
        return {
            **_declared("execution", one.iri, one.definition),
            "detail": " · ".join(
                part for part in (partly, variant.definition.symbol.path, *_execution_words(one, count)) if part
            ),
            "variant": variant.iri,
            "count": count,
            "digest": execution_digest(snapshot, one),
            "variation": convert.location(snapshot, variant.definition.uri, variant.site.span(variant.node.variation)),
        }

    def _declared(kind: str, iri: str, definition: Definition) -> dict[str, Any]:
        place = convert.location(snapshot, definition.uri, definition.span)
        return {"kind": kind, "id": iri, "name": definition.symbol.name, "place": place, "tests": []}

    unreadable = snapshot.unreadable(uri)
    executions = [execution(one) for one in executions_of(snapshot, uri)]
    file = {"kind": "file", "id": uri, "name": unquote(uri.rpartition("/")[2]), "detail": "", "place": None}
    return {
        "problem": None if unreadable is None else unreadable.reason,
        "files": [file.document.uri for file in snapshot.closure(uri)] if unreadable is None else [uri],
        "tests": [
            *(story(each) for each in stories_in(snapshot, uri)),
            *([{**file, "detail": _counted(len(executions), "execution"), "tests": executions}] * bool(executions)),
        ],
    }


def _counted(count: int | None, word: str) -> str:
    return "" if count is None else f"{count:,} {word}{'' if count == 1 else 's'}"


def _partly(rate: PassRate | None) -> str:
    return "" if rate is None or rate.missing == 0 else rate.label


def _execution_words(execution: PlacedExecution, count: int | None) -> Iterator[str]:
    """Yield the settings of an execution as text, except for its variant."""
    node = execution.node
    yield _counted(count, "scenario")
    yield "" if node.repeat is None or node.repeat.value == 1 else f"{node.repeat.value} times each"
    yield f"by {node.behaviour.path}"
    yield f"in {node.scene.path}"
    yield f"policies {', '.join(policy.path for policy in node.policies)}" if node.policies else ""
    yield "" if node.seed is None else f"seed {node.seed.value}"


def _scenarios(snapshot: Snapshot, convert: Converter, uri: str, variant: str, first: int, most: int) -> dict[str, Any]:
    """Answer with scenarios of a variant, or with the reason why there are none."""
    from robbdd_tools.graph.acceptance_model import Iri

    try:
        model = feature_plan(snapshot, uri).model
    except RobbddError as error:
        return {"problem": reason(error), "files": [uri], "tests": []}
    places = places_of(snapshot, convert, uri)
    # Show the name of a behaviour or an event in the text instead of its IRI.
    names = {clause.iri: clause.name for file in places.uris for clause in clauses_in(snapshot, file)}
    from robbdd_tools.run.listing import listed_scenarios

    listed = listed_scenarios(model, Iri(variant), first, most)
    tests = [_scenario(each, places.rows.get((variant, each.number)), places, names) for each in listed]
    return {"problem": None, "files": places.uris, "tests": tests}


def _scenario(
    listed: ListedScenario,
    row: types.Location | None,
    places: Places,
    names: Mapping[str, str],
) -> dict[str, Any]:
    counted = f"scenario {listed.number}" if row is None else f"row {listed.number}"
    return {
        "kind": "scenario",
        "id": str(listed.number),
        "name": listed.varying or listed.shared or counted,
        "detail": ", ".join(part for part in (counted, listed.shared if listed.varying else "") if part),
        "number": listed.number,
        "place": row,
        "tests": [
            {
                "kind": "clause",
                "id": clause.iri,
                "name": names.get(clause.iri, clause.name),
                "detail": clause.sentence,
                "role": clause.role,
                "place": places.declarations.get(clause.iri),
                "tests": [],
            }
            for clause in listed.clauses
        ],
    }
