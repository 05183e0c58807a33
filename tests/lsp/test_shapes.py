"""The validation process: shapes of a project and an editor, crashes, outdated work."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

import psutil
import pytest
from lsprotocol import types
from pytest_lsp import LanguageClient

from kit import FOLDER, MODEL, SCENE
from lsp_kit import CLIENTS, PATIENCE, Editor
from robbdd_tools.base.limits import VALIDATION_SECONDS
from robbdd_tools.graph.shapes.project_shapes import EditorShapes
from robbdd_tools.lsp import shapes
from robbdd_tools.lsp.framing import Answer, Request
from robbdd_tools.lsp.shapes import ShapeValidator

SAFETY = """@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix bdd: <https://secorolab.github.io/metamodels/acceptance-criteria/bdd#> .
@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .
<urn:safety> a sh:NodeShape ; sh:targetClass bdd:ScenarioTemplate ; sh:property [
    sh:path ( bdd:has-clause [ sh:zeroOrMorePath rdf:rest ] rdf:first ) ;
    sh:qualifiedValueShape [ sh:class bdd:DoesNotDropPredicate ] ; sh:qualifiedMinCount 1 ;
    sh:message "{focus} states no safety clause" ] .
"""
MAIN = f"{FOLDER}main.bdd"


@pytest.fixture
def rules(tmp_path: Path) -> Path:
    folder = tmp_path / "rules"
    folder.mkdir()
    (folder / "safety.ttl").write_text(SAFETY, encoding="utf-8")
    return folder


def configured(client: LanguageClient, shapes: object) -> None:
    client.set_configuration({"robbdd": {"shapes": shapes}})
    client.workspace_did_change_configuration(
        types.DidChangeConfigurationParams(settings={"robbdd": {"shapes": shapes}})
    )


@CLIENTS
@pytest.mark.usefixtures("rules")
async def test_shapes_of_the_editor_count_as_long_as_it_names_them(client: LanguageClient, editor: Editor) -> None:
    editor.open()
    await editor.diagnostics()
    configured(client, ["rules/*.ttl"])
    (found,) = await editor.diagnostics("shape-safety")
    assert found.message == "pick-place states no safety clause"
    assert found.range.start == editor.position("pick-place {")
    assert [place.location.uri.rpartition("/")[2] for place in found.related_information or ()] == ["safety.ttl"]
    configured(client, [])
    await editor.diagnostics()


async def test_a_pattern_without_files_is_told_on_the_model(client: LanguageClient, editor: Editor) -> None:
    editor.open()
    configured(client, ["nothing/*.ttl"])
    (found,) = await editor.diagnostics("shapes-unchecked")
    assert "no file matches the shapes 'nothing/*.ttl'" in found.message


async def test_a_setting_of_the_wrong_kind_is_told_to_the_user(client: LanguageClient) -> None:
    configured(client, "rules/*.ttl")
    async with asyncio.timeout(PATIENCE):
        while not client.messages:
            await client.wait_for_notification(types.WINDOW_SHOW_MESSAGE)
    assert "'robbdd.shapes' is a list of file patterns" in client.messages[0].message


class Answers:
    """What a validator delivers."""

    def __init__(self) -> None:
        self.queue: asyncio.Queue[Answer] = asyncio.Queue()
        self.validator = ShapeValidator(self.queue.put_nowait)

    def ask(self, revision: int, text: str) -> None:
        texts = {f"{FOLDER}lab.scene": (1, SCENE), MAIN: (revision, text)}
        self.validator.request(Request(revision, MAIN, texts, EditorShapes()))

    async def next(self) -> Answer:
        async with asyncio.timeout(PATIENCE):
            return await self.queue.get()


@pytest.fixture
def answers() -> Any:
    found = Answers()
    yield found
    found.validator.stop()


async def test_a_killed_process_is_started_again_with_what_it_owes(answers: Answers) -> None:
    answers.ask(1, MODEL)
    assert (await answers.next()).diagnostics == ()
    killed = answers.validator.process_id
    assert killed is not None
    psutil.Process(killed).kill()
    answers.ask(2, MODEL.replace("0.5 seconds", "0 seconds"))
    answer = await answers.next()
    assert (answer.revision, [entry.code for entry in answer.diagnostics]) == (2, ["shacl-horizon"])
    assert answers.validator.process_id != killed


@pytest.mark.parametrize(
    ("fault", "told"), [("error", "RuntimeError"), ("end", "ended over it"), ("hang", "longer than 5 seconds")]
)
async def test_a_file_that_validation_fails_over_is_told_and_all_others_are_answered(
    answers: Answers, monkeypatch: pytest.MonkeyPatch, fault: str, told: str
) -> None:
    folder = str(Path(__file__).parent)
    monkeypatch.setattr(
        shapes, "_WORKER", f"import sys; sys.path.insert(0, {folder!r}); from planted_worker import main; main"
    )
    monkeypatch.setenv(VALIDATION_SECONDS.variable, "5")
    other = f"{FOLDER}other.bdd"
    texts = {f"{FOLDER}lab.scene": (1, SCENE), other: (1, MODEL.replace("0.5 seconds", "0 seconds"))}
    texts |= {MAIN: (1, f"{MODEL}// planted {fault}")}
    for number, uri in enumerate((MAIN, other)):
        answers.validator.request(Request(number, uri, texts, EditorShapes()))
    found = {answer.uri: answer for answer in (await answers.next(), await answers.next())}
    assert told in found[MAIN].error
    assert (found[other].error, [entry.code for entry in found[other].diagnostics]) == ("", ["shacl-horizon"])
    answers.ask(3, MODEL)
    assert (await answers.next()) == Answer(3, MAIN, ())


async def test_only_the_newest_revision_is_answered(answers: Answers) -> None:
    answers.ask(1, MODEL)
    await answers.next()
    for revision in range(2, 30):
        answers.ask(revision, MODEL.replace("0.5 seconds", f"{revision % 2} seconds"))
        await asyncio.sleep(0)
    answer = await answers.next()
    assert (answer.revision, [entry.code for entry in answer.diagnostics]) == (29, [])
    assert answers.queue.empty()


async def test_a_file_that_is_forgotten_gets_no_answer(answers: Answers) -> None:
    answers.ask(1, MODEL)
    answers.validator.forget(MAIN)
    other = f"{FOLDER}other.bdd"
    answers.validator.request(Request(2, other, {other: (1, MODEL), f"{FOLDER}lab.scene": (1, SCENE)}, EditorShapes()))
    assert (await answers.next()).uri == other
    assert answers.queue.empty()
