"""Studies in an editor: diagnostics by the validation process, lenses, and files that are not open."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

import pytest
from lsprotocol import types
from pytest_lsp import LanguageClient

from kit import FOLDER, MODEL, SCENE
from lsp_kit import CLIENTS, Editor
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.campaign.study_place import study_folder
from robbdd_tools.graph.shapes.project_shapes import EditorShapes
from robbdd_tools.lsp.framing import Forget, Request
from robbdd_tools.lsp.server import RobbddServer
from robbdd_tools.lsp.study_lenses import study_lenses
from robbdd_tools.lsp.worker import Inbox, Worker
from robbdd_tools.names.project import Project
from robbdd_tools.run.study_schema import NAME

STUDY = 'import "pickplace.bdd"\n\nStudy s {\n    scenarios: { <gone> }\n    repeat: 0\n}\n'


def study_of(editor: Editor, client: LanguageClient) -> Editor:
    (editor.path.parent / "x.study").write_text(STUDY, encoding="utf-8")
    return Editor(client, editor.path.parent.parent, "pickplace/x.study")


@CLIENTS
async def test_a_study_is_checked_as_it_is_edited(client: LanguageClient, editor: Editor) -> None:
    study = study_of(editor, client)
    study.open()
    (found,) = await study.diagnostics("syntax")
    assert found.message.startswith("'repeat' is a whole number")
    study.change("repeat: 0", "repeat: 2")
    (found,) = await study.diagnostics("study")
    assert found.message.startswith("there is no scenario 'gone'")
    assert found.range.start == study.position("<gone>")
    completion = await client.text_document_completion_async(types.CompletionParams(**study.at("<gone", after=True)))
    assert isinstance(completion, list)
    name = completion[0].label
    study.change("<gone>", f"<{name}>")
    await study.diagnostics()
    editor.open(editor.text.replace(name, "other-name"))
    (found,) = await study.diagnostics("study")
    assert found.message.startswith(f"there is no scenario '{name}'")
    edits = await client.text_document_formatting_async(
        types.DocumentFormattingParams(
            text_document=types.TextDocumentIdentifier(uri=study.uri),
            options=types.FormattingOptions(tab_size=4, insert_spaces=True),
        )
    )
    assert not edits


def surveyed(folder: Path, name: str) -> list[str]:
    inbox: Inbox[Request | Forget] = Inbox(BytesIO())
    worker = Worker(inbox)
    answer = worker.answer(Request(1, path_to_uri(folder / name), {}, EditorShapes(), surveyed=True))
    assert answer is not None
    assert answer.error == ""
    return [f"{one.uri.rpartition('/')[2]} {one.message}" for one in answer.diagnostics]


def test_a_study_that_is_not_open_is_checked_with_the_workspace(tmp_path: Path) -> None:
    for name, text in {"lab.scene": SCENE, "main.bdd": MODEL, "robbdd.toml": ""}.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    study = tmp_path / "x.study"
    study.write_text('import "main.bdd"\nStudy s { scenarios: { <gone> } }\n', encoding="utf-8")
    (found,) = surveyed(tmp_path, "x.study")
    assert found.startswith("x.study there is no scenario 'gone'")
    study.write_text('import "main.bdd"\nStudy s { seed: -1 }\n', encoding="utf-8")
    (found,) = surveyed(tmp_path, "x.study")
    assert found.startswith("x.study 'seed' is a whole number")
    study.write_text('import "main.bdd"\nStudy s { seed: 1 }\n', encoding="utf-8")
    assert surveyed(tmp_path, "x.study") == []


@pytest.mark.parametrize("able", [True, False])
def test_the_lenses_fit_what_was_executed(tmp_path: Path, able: bool) -> None:
    study = tmp_path / "x.study"
    study.write_text('import "main.bdd"\nStudy s { }\n', encoding="utf-8")
    (tmp_path / "robbdd.toml").write_text("", encoding="utf-8")
    uri = path_to_uri(study)
    project = Project()
    project.open(uri, 1, study.read_text(encoding="utf-8"))
    server = RobbddServer()
    server.runs_studies = able

    def titles() -> list[str]:
        found = study_lenses(server, project.snapshot(), uri)
        assert all(one.command is not None and one.command.arguments == [{"uri": uri}] for one in found)
        return [one.command.title for one in found if one.command is not None]

    try:
        assert titles() == (["Run study"] if able else [])
        folder = study_folder(study)
        folder.mkdir(parents=True)
        (folder / NAME).write_bytes(b"")
        assert titles() == (["Resume study", "Show results", "Show executions"] if able else [])
        project.open(uri, 2, "Study")
        assert titles() == []
        assert study_lenses(server, project.snapshot(), f"{FOLDER}other.study") == []
    finally:
        server.stop()
