"""The requests ``robbdd/runs`` and ``robbdd/trace``: list stored runs, and return a recorded execution for drawing.

The parameters of both contain the ``uri`` of a document in the project; that of a ``.study`` means the executions of
the study that were executed again, and ``number`` is the number of one in the study. The schemas ``runs.schema.json``
and ``trace.schema.json`` in ``docs/schemas`` describe the answers.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import path_to_uri, uri_to_path
from robbdd_tools.features.studies import is_study
from robbdd_tools.lsp.document_models import feature_plan
from robbdd_tools.lsp.locations import places_of
from robbdd_tools.lsp.parameters import Parameters
from robbdd_tools.names.variant_places import variants_of
from robbdd_tools.run.database import DatabaseProblem
from robbdd_tools.run.json_documents import NoTrace, find_trace, scenarios, summary, trace_document
from robbdd_tools.run.store import NoSuchRun, RunStore

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.run.store import StoredRun

RUNS, TRACE = "robbdd/runs", "robbdd/trace"
Result = TypeVar("Result")


def register_stored_runs(server: RobbddServer) -> None:
    """Add the requests to a server."""

    @server.feature(RUNS)
    async def runs(ls: RobbddServer, params: Any) -> dict[str, Any]:
        asked = Parameters(params)
        uri = asked.text("uri")
        return await answered(lambda: _runs(_store(ls, uri), asked))

    @server.feature(TRACE)
    async def trace(ls: RobbddServer, params: Any) -> dict[str, Any]:
        def places(snapshot: Snapshot) -> dict[str, types.Location]:
            found = [places_of(snapshot, ls.convert, uri).declarations for uri in files]
            return {iri: place for declarations in found for iri, place in declarations.items()}

        def now(snapshot: Snapshot) -> set[tuple[str, str]] | None:
            return _stated(snapshot, files, scenario["variant"], scenario["variation"])

        asked = Parameters(params)
        uri = asked.text("uri")
        found = await answered(lambda: _trace(_store(ls, uri), asked))
        model, scenario = found.pop("model"), found["scenario"]
        files = [model] if is_study(uri) else list(dict.fromkeys([uri, model]))
        placed, sentences = await ls.in_background(lambda snapshot: (places(snapshot), now(snapshot)))
        for clause in found["clauses"]:
            iri, written = clause["iri"], clause.pop("written")
            clause["source"] = placed.get(iri)
            clause["stale"] = None if sentences is None else (iri, written) not in sentences
        return {**found, "source": placed.get(scenario["variant"])}


def _store(ls: RobbddServer, uri: str) -> RunStore:
    path = uri_to_path(uri)
    if path is None or not is_study(uri):
        return ls.stores.of(uri)
    from robbdd_tools.campaign.replayed_executions import replays_in
    from robbdd_tools.campaign.study_place import study_folder

    return replays_in(study_folder(path))


def _runs(store: RunStore, asked: Parameters) -> dict[str, Any]:
    word = asked.run()
    if word is None:
        listed = [summary(run) for run in store.runs()]
    else:
        run = store.find(word)
        listed = [{**summary(run), "scenarios": list(scenarios(run))}]
    return {"store": path_to_uri(store.folder), "runs": listed}


def _trace(store: RunStore, asked: Parameters) -> dict[str, Any]:
    word, index, number = asked.run(), asked.optional_number("index"), asked.optional_number("number")
    if number is not None:
        run, index = _replay(store, number)
    elif index is None:
        run, index = find_trace(store, word, asked.others("variant", "variation", "execution", "repetition"))
    else:
        run = store.find(word or "latest")
    return {**trace_document(run, index), "model": path_to_uri(run.model())}


def _replay(store: RunStore, number: int) -> tuple[StoredRun, int]:
    from robbdd_tools.campaign.replayed_executions import replay_of

    found = replay_of(store, number)
    if found is None:
        raise NoTrace(f"there is no recording of execution {number}: `robbdd study replay FILE {number}` makes one")
    return found


def _stated(snapshot: Snapshot, files: Sequence[str], variant: str, variation: int) -> set[tuple[str, str]] | None:
    """Return the current statements of a scenario, from the first file that contains its variant.

    Returns ``None`` if that file has errors.
    """
    from robbdd_tools.gherkin.statements import statements

    for uri in files:
        known = (file.document.uri for file in snapshot.closure(uri))
        if any(placed.iri == variant for name in known for placed in variants_of(snapshot, name)):
            try:
                return statements(feature_plan(snapshot, uri).model, variant, variation)
            except RobbddError:
                return None
    return set()


async def answered(work: Callable[[], Result]) -> Result:
    """Execute work in a thread. If there is nothing to show, the user gets the reason as an error response."""
    try:
        return await asyncio.to_thread(work)
    except (NoTrace, NoSuchRun, DatabaseProblem) as error:
        raise JsonRpcException(str(error), int(types.LSPErrorCodes.RequestFailed)) from error
