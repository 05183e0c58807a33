"""The request ``robbdd/scene``: draw the scene instances of a ``.scenex`` while it is edited.

The parameter is ``uri``. ``docs/schemas/scene.schema.json`` describes the answer. A process of its own sets up the
scenes; it executes no users' code. While one request is being drawn, only the latest further request for the same
document waits.
"""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.document import Span
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.lsp.convert import Converter, document_of
from robbdd_tools.lsp.last_valid import first_problem
from robbdd_tools.lsp.parameters import Parameters
from robbdd_tools.workbench.scene_drawing import DrawingRequest, draw, drawing_request

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer
    from robbdd_tools.names.project import Snapshot

SCENE = "robbdd/scene"
NONE = "this file declares no scene instance (scene inst …)"
Json = dict[str, Any]


@dataclass(slots=True)
class _Drawn:
    """The last drawing of a document, and the number of its latest request."""

    asked: DrawingRequest | None = None
    scenes: list[Json] = field(default_factory=list[Json])
    latest: int = 0


class ScenePreviews:
    """Draws scenes one after the other."""

    def __init__(self) -> None:
        self._drawn: dict[str, _Drawn] = {}
        self._turn = asyncio.Lock()

    def forget(self, uri: str) -> None:
        """Drop the drawing of a document."""
        self._drawn.pop(uri, None)

    async def show(self, ls: RobbddServer, uri: str) -> Json:
        """Return the answer about a document."""
        known = self._drawn.setdefault(uri, _Drawn())
        known.latest += 1
        number = known.latest
        async with self._turn:
            if number != known.latest:
                return _answer(uri, "a newer request replaces this one", known)
            problem, asked, snapshot = await ls.in_background(lambda snapshot: _request(snapshot, uri), uri)
            if problem is None and asked is not None and asked != known.asked:
                found = await asyncio.to_thread(draw, asked)
                if isinstance(found, str):
                    problem = f"the scene cannot be drawn: {found}"
                else:
                    known.asked, known.scenes = asked, [_scene(ls.convert, snapshot, one) for one in found]
        return _answer(uri, problem, known)


def register_scene(server: RobbddServer) -> None:
    """Add the request to a server."""
    previews = ScenePreviews()
    server.when_closed.append(previews.forget)

    @server.feature(SCENE)
    async def show(ls: RobbddServer, params: Any) -> Json:
        return await previews.show(ls, Parameters(params).text("uri"))


def _request(snapshot: Snapshot, uri: str) -> tuple[str | None, DrawingRequest | None, Snapshot]:
    """Return the reason why nothing can be drawn, such as the first error of the text, and the request to draw."""
    problem = first_problem(snapshot, uri)
    asked = None if problem is not None else drawing_request(snapshot, uri)
    return problem or (NONE if asked is None else None), asked, snapshot


def _scene(convert: Converter, snapshot: Snapshot, drawn: Json) -> Json:
    """Return a drawn scene with the places of its faults in the text that was drawn."""

    def place(origin: Json | None) -> Json | None:
        if origin is None:
            return None
        uri = path_to_uri(Path(origin["file"]))
        document = document_of(snapshot, uri)
        start = document.line_starts[int(origin["line"]) - 1] + int(origin["column"]) - 1
        return {"uri": uri, "range": convert.range(document, Span(start, start))}

    faults = [{"kind": one["kind"], "reason": one["reason"], "source": place(one["origin"])} for one in drawn["faults"]]
    name = drawn["iri"].replace("#", "/").rpartition("/")[2]
    return {**drawn, "name": name, "faults": faults}


def _answer(uri: str, problem: str | None, known: _Drawn) -> Json:
    return {"uri": uri, "problem": problem, "scenes": known.scenes}
