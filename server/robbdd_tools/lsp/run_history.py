"""The requests ``robbdd/history`` and ``robbdd/compare``: show a clause in all stored runs, and compare two runs.

The parameters of both contain the ``uri`` of a document in the project. The schemas ``history.schema.json`` and
``compare.schema.json`` in ``docs/schemas`` describe the answers.
"""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from pygls.exceptions import JsonRpcInvalidParams

from robbdd_tools.features.run_verdicts import digests_of
from robbdd_tools.lsp.convert import document_of
from robbdd_tools.lsp.parameters import Parameters
from robbdd_tools.lsp.stored_runs import answered
from robbdd_tools.names.clause_places import clauses_in
from robbdd_tools.run.clause_history import ClauseRun, clause_history
from robbdd_tools.run.json_documents import summary
from robbdd_tools.workbench.judged_text import read_texts

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.run.store import RunStore, StoredRun

HISTORY, COMPARE = "robbdd/history", "robbdd/compare"


def register_run_history(server: RobbddServer) -> None:
    """Add the requests to a server."""

    @server.feature(HISTORY)
    async def history(ls: RobbddServer, params: Any) -> dict[str, Any] | None:
        asked = Parameters(params)
        uri, wanted, position = asked.text("uri"), asked.optional_text("clause"), asked.optional_position("position")

        def find(snapshot: Snapshot) -> tuple[str, str, str | None] | None:
            """Return the IRI, the name and the current digest of the clause."""
            offset = None if position is None else ls.convert.offset(document_of(snapshot, uri), position)
            found = [
                clause
                for clause in clauses_in(snapshot, uri)
                if (clause.iri == wanted if offset is None else clause.span.contains(offset))
            ]
            clause = min(found, key=lambda one: one.span.end - one.span.start, default=None)
            digests = digests_of(snapshot, uri).clauses
            if clause is not None:
                return clause.iri, clause.name, digests.get(clause.iri)
            return None if wanted is None else (wanted, "", digests.get(wanted))

        clause = await ls.in_background(find, uri)
        if clause is None:
            return None
        return await answered(lambda: _history(ls.stores.of(uri), *clause))

    @server.feature(COMPARE)
    async def compare_runs(ls: RobbddServer, params: Any) -> dict[str, Any]:
        asked = Parameters(params)
        uri, before, after = asked.text("uri"), asked.optional_number("before"), asked.optional_number("after")
        if before is None or after is None:
            raise JsonRpcInvalidParams("'before' and 'after' must be the numbers of two stored runs")
        return await answered(lambda: _compared(ls.stores.of(uri), str(before), str(after)))


def _history(store: RunStore, iri: str, name: str, digest: str | None) -> dict[str, Any]:
    places = {run.number: run for run in store.runs()}
    judged = [one for one in clause_history(store.database, iri) if one.run in places]
    return {
        "clause": iri,
        "name": name,
        "runs": [_entry(places[one.run], one, iri, digest) for one in judged],
    }


def _entry(run: StoredRun, judged: ClauseRun, iri: str, digest: str | None) -> dict[str, Any]:
    known = _digests(run, iri)
    return {
        **summary(run),
        "began": judged.began,
        "judged": {verdict: judged.counts.get(verdict, 0) for verdict in ("holds", "violated", "unknown")},
        "margin": judged.margin,
        "unit": judged.unit,
        "worst": judged.worst,
        "stale": None if not known or digest is None else digest not in known,
    }


def _digests(run: StoredRun, iri: str) -> set[str]:
    """Return the digests of a clause in the texts that a run judged; empty if the run has none."""
    try:
        texts = read_texts(run.folder).texts
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return set()
    return {text.digests.clauses[iri] for text in texts if iri in text.digests.clauses}


def _compared(store: RunStore, before: str, after: str) -> dict[str, Any]:
    from robbdd_tools.workbench.comparison import compare

    one, other = store.find(before), store.find(after)
    found = compare(one, other)
    return {"before": summary(one), "after": summary(other), "flipped": found.flipped, **asdict(found)}
