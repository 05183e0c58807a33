"""The request ``robbdd/preview``: show the Gherkin of a document while it is edited.

The parameters are ``uri`` and, optionally, ``scenario`` (the IRI of a variant) and ``most`` (the number of scenarios to
show). ``docs/schemas/preview.schema.json`` describes the answer.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robbdd_tools.lsp.convert import Converter, document_of
from robbdd_tools.lsp.last_valid import LastValid
from robbdd_tools.lsp.parameters import Parameters

if TYPE_CHECKING:
    from robbdd_tools.gherkin.preview import Preview
    from robbdd_tools.lsp.server import RobbddServer
    from robbdd_tools.names.project import Snapshot

PREVIEW = "robbdd/preview"


NOTHING: dict[str, Any] = {"text": "", "lines": [], "shown": 0, "total": 0}


class Previews:
    """Makes previews, and stores the last one without errors for each document and scenario."""

    def __init__(self) -> None:
        self._kept = LastValid()
        self.forget = self._kept.forget

    def show(
        self, snapshot: Snapshot, convert: Converter, asked: Parameters, *, expanded: bool = False
    ) -> dict[str, Any]:
        """Return the answer to a request. For a text with errors, this is the last preview without errors.

        If ``expanded`` is true, the definitions of named predicates replace their phrases.
        """
        from robbdd_tools.gherkin.preview import MAX_SHOWN, preview

        uri = asked.text("uri")
        scenario = asked.optional_text("scenario")
        most = asked.optional_number("most") or MAX_SHOWN
        made, problem = self._kept.of(
            snapshot,
            uri,
            scenario,
            lambda: _answer(snapshot, convert, preview(snapshot, uri, scenario, most, expanded=expanded)),
        )
        made = made or NOTHING
        return {"uri": uri, "problem": problem, **made, "text": _headed(made, _remark(made, problem))}


def register_preview(server: RobbddServer) -> None:
    """Add the request to a server."""
    previews = Previews()
    server.when_closed.append(previews.forget)

    @server.feature(PREVIEW)
    async def show(ls: RobbddServer, params: Any) -> dict[str, Any]:
        asked = Parameters(params)
        expanded = ls.settings.expands(asked.text("uri"))
        return await ls.in_background(lambda snapshot: previews.show(snapshot, ls.convert, asked, expanded=expanded))


def _answer(snapshot: Snapshot, convert: Converter, made: Preview) -> dict[str, Any]:
    return {
        "text": made.text,
        # The line that says how much is shown comes first.
        "lines": [
            {
                "line": entry.line + 1,
                "iri": entry.iri,
                "uri": entry.location.uri,
                "range": convert.range(document_of(snapshot, entry.location.uri), entry.location.span),
            }
            for entry in made.lines
        ],
        "shown": made.shown,
        "total": made.total,
    }


def _remark(made: dict[str, Any], problem: str | None) -> str:
    if problem is not None:
        made_of = "this is the last preview without errors" if made["text"] else "there is nothing to show yet"
        return f"out of date: the model has an error ({' '.join(problem.split())}); {made_of}"
    if made["shown"] < made["total"]:
        return f"the first {made['shown']} of {made['total']} scenarios"
    return f"{made['total']} scenario{'' if made['total'] == 1 else 's'}"


def _headed(made: dict[str, Any], remark: str) -> str:
    """Put a heading above a text. Line numbers include the heading."""
    return f"# {remark}\n{made['text']}"
