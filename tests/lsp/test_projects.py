"""Projects begun from the editor."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from kit import schema_errors
from lsp_kit import CLIENTS, Editor, plain
from robbdd_tools.base.files import path_to_uri, uri_to_path


async def ask(editor: Editor, method: str, **params: str) -> Any:
    answer = await editor.client.protocol.send_request_async(method, params)
    assert schema_errors(f"{method.removeprefix('robbdd/').lower()}.schema.json", plain(answer)) == []
    return answer


@CLIENTS
async def test_a_project_begins_from_a_template(editor: Editor, tmp_path: Path) -> None:
    (template, *_) = await ask(editor, "robbdd/templates")
    folder = tmp_path / "cell"
    answer = await ask(editor, "robbdd/newProject", template=template["name"], uri=path_to_uri(folder))
    assert answer.problem is None
    models = [uri_to_path(uri) for uri in answer.models]
    assert models == sorted(folder.glob("*.bdd"))
    assert models

    again = await ask(editor, "robbdd/newProject", template=template["name"], uri=path_to_uri(folder))
    assert list(again.models) == []
    assert "exists already" in again.problem
