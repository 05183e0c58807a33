"""The requests ``robbdd/templates`` and ``robbdd/newProject``: create a project from the editor.

``robbdd/templates`` has no parameters; the answer is a list of ``name`` and ``about``. The parameters of
``robbdd/newProject`` are ``template`` and the ``uri`` of a new or empty folder. Its answer has the URIs of the
``models`` that were written there, or the ``problem``.
"""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.files import path_to_uri, uri_to_path
from robbdd_tools.base.scaffold import ScaffoldProblem, begin_project, templates
from robbdd_tools.lsp.parameters import Parameters

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer

TEMPLATES, NEW_PROJECT = "robbdd/templates", "robbdd/newProject"


def register_projects(server: RobbddServer) -> None:
    """Add the requests to a server."""

    @server.feature(TEMPLATES)
    async def list_templates(_params: Any) -> list[dict[str, str]]:
        known = await asyncio.to_thread(templates)
        return [{"name": template.name, "about": template.about} for template in known.values()]

    @server.feature(NEW_PROJECT)
    async def new_project(params: Any) -> dict[str, Any]:
        asked = Parameters(params)
        uri, template = asked.text("uri"), asked.text("template")
        folder = uri_to_path(uri)
        if folder is None:
            return {"models": [], "problem": f"{uri} is not a folder on this machine"}
        return await asyncio.to_thread(_begin, folder, template)


def _begin(folder: Path, template: str) -> dict[str, Any]:
    try:
        models = begin_project(folder, template)
    except ScaffoldProblem as problem:
        return {"models": [], "problem": str(problem)}
    except OSError as error:
        return {"models": [], "problem": f"{error.filename or folder}: {error.strerror or error}"}
    return {"models": [path_to_uri(model) for model in models], "problem": None}
