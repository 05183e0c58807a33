"""Errors in users' code in the editor: at the Python line, at the name in the model and at the scenario, each once."""

from __future__ import annotations

import asyncio
import shutil
import sys
from pathlib import Path
from typing import Any

import pytest
from lsprotocol import types
from pytest_lsp import LanguageClient

from kit import EXAMPLES, schema_errors
from lsp.test_runs import execute
from lsp_kit import PATIENCE, Editor, plain
from robbdd_tools.base.files import path_to_uri

pytestmark = pytest.mark.physics
CODE = "user-code-error"
FIRST = 'print("begin") or arguments["workspace"]'


class Cell:
    """The example with its own behaviour, which reads an argument that it does not get."""

    def __init__(self, client: LanguageClient, folder: Path) -> None:
        self.client = client
        self.folder = shutil.copytree(EXAMPLES / "ownrobot", folder / "ownrobot")
        self.code = self.folder / "carrying.py"
        self.model = Editor(client, self.folder, "tidy.bddx")
        self.write('print("begin") or arguments["goal"]')

    def write(self, argument: str) -> None:
        text = (EXAMPLES / "ownrobot" / "carrying.py").read_text(encoding="utf-8")
        assert text.count('arguments["workspace"]') == 1
        self.code.write_text(text.replace('arguments["workspace"]', argument), encoding="utf-8")

    async def until(self, expected: dict[str, list[int]]) -> None:
        await until_shown(self.client, expected)

    def changed_on_disk(self, path: Path) -> None:
        event = types.FileEvent(uri=path_to_uri(path), type=types.FileChangeType.Changed)
        self.client.workspace_did_change_watched_files(types.DidChangeWatchedFilesParams(changes=[event]))

    @property
    def three_places(self) -> dict[str, list[int]]:
        return {
            "carrying.py": [line_of(self.code, 'arguments["goal"]')],
            "tidy.bddx": [line_of(self.model.path, "bhv: <ours>")],
            "tidy.bdd": [line_of(self.folder / "tidy.bdd", "Scenario cube-to-bin")],
        }


def line_of(path: Path, words: str) -> int:
    """The first line, from 0, that has these words."""
    lines = path.read_text(encoding="utf-8").splitlines()
    return next(number for number, line in enumerate(lines) if words in line)


def shown(client: LanguageClient) -> dict[str, list[int]]:
    """The lines of the errors by file."""
    found = {
        uri.rpartition("/")[2]: [entry.range.start.line for entry in entries if entry.code == CODE]
        for uri, entries in client.diagnostics.items()
    }
    return {name: lines for name, lines in found.items() if lines}


async def until_shown(client: LanguageClient, expected: dict[str, list[int]]) -> None:
    async with asyncio.timeout(PATIENCE):
        while shown(client) != expected:
            await asyncio.sleep(0.02)


@pytest.fixture
def cell(client: LanguageClient, tmp_path: Path) -> Cell:
    return Cell(client, tmp_path)


async def test_an_error_is_shown_once_at_each_of_three_places_until_the_code_is_edited(
    cell: Cell, run_messages: list[Any]
) -> None:
    cell.model.open()
    await execute(cell.model, "run")
    await cell.until(cell.three_places)
    async with asyncio.timeout(PATIENCE):
        # It is shown with the first scenario already.
        while "2 scenarios" not in cell.client.diagnostics[path_to_uri(cell.code)][0].message:
            await asyncio.sleep(0.02)
    (in_code,) = cell.client.diagnostics[path_to_uri(cell.code)]
    assert in_code.message == "KeyError: 'goal' (in the last run, 2 scenarios)"
    assert in_code.range.start.character == 8, "the line without its indentation"
    assert in_code.severity is types.DiagnosticSeverity.Error
    (at_name,) = (one for one in cell.client.diagnostics[cell.model.uri] if one.code == CODE)
    assert at_name.message.startswith("carrying:Carry failed: KeyError: 'goal' (carrying.py:")
    assert at_name.range.start == cell.model.position("<ours>") or at_name.range.start == cell.model.position("ours>")
    assert at_name.related_information is not None
    assert at_name.related_information[0].location.uri == path_to_uri(cell.code)
    codes = {str(one.code) for found in cell.client.diagnostics.values() for one in found}
    assert "clause-unknown" not in codes, "one cause is reported once, not at every clause"

    messages = [entry.message for entry in run_messages]
    for notification in run_messages:
        assert schema_errors("runmessage.schema.json", plain(notification)) == [], notification
    failed = [message for message in messages if message.type == "UserCodeFailed"]
    assert len({message.id for message in failed}) == 1
    assert failed[0].lines[-1] == "KeyError: 'goal'"
    assert [message.text for message in messages if message.type == "Output"] == ["begin", "begin"]
    judged = [message for message in messages if message.type == "ClauseJudged" and message.fault]
    assert {message.fault for message in judged} == {failed[0].id}
    assert all("KeyError" in message.reason for message in judged)

    cell.code.write_text("# fixed\n" + cell.code.read_text(encoding="utf-8"), encoding="utf-8")
    cell.changed_on_disk(cell.code)
    await cell.until({})


@pytest.mark.skipif(sys.platform == "win32", reason="exit codes in words")
@pytest.mark.parametrize(
    ("way", "words"),
    [
        ("__import__('os')._exit(4)", "the process ended with code 4"),
        ("__import__('ctypes').string_at(0)", "the process ended with signal SIGSEGV"),
    ],
)
async def test_code_that_ends_its_process_is_shown_once_at_each_of_three_places(
    cell: Cell, run_messages: list[Any], way: str, words: str
) -> None:
    cell.write(f'{way} or arguments["goal"]')
    cell.model.open()
    await execute(cell.model, "run")
    await cell.until(cell.three_places)
    async with asyncio.timeout(PATIENCE):
        # It is shown with the first scenario already.
        while [one.message for one in cell.client.diagnostics[path_to_uri(cell.code)]] != [
            f"{words} (in the last run, 2 scenarios)"
        ]:
            await asyncio.sleep(0.02)
    (at_name,) = (one for one in cell.client.diagnostics[cell.model.uri] if one.code == CODE)
    assert at_name.message.startswith(f"carrying:Carry failed: {words} (carrying.py:")
    codes = {str(one.code) for found in cell.client.diagnostics.values() for one in found}
    assert "clause-unknown" not in codes
    failed = [entry.message for entry in run_messages if entry.message.type == "UserCodeFailed"]
    assert failed[0].lines[-1] == words


async def test_an_error_vanishes_with_an_unsaved_edit_of_the_code_or_of_the_model_and_with_the_next_run(
    cell: Cell,
) -> None:
    cell.model.open()
    await execute(cell.model, "run")
    await cell.until(cell.three_places)
    cell.model.change("bhv: <ours>\n    seed: 1", "bhv: <ours>\n    seed: 2")
    await cell.until({})
    cell.model.change("seed: 2", "seed: 1")
    await cell.until(cell.three_places)
    cell.client.protocol.notify("robbdd/codeEdited", {"uri": path_to_uri(cell.code)})
    await cell.until({})
    await execute(cell.model, "run")
    await cell.until(cell.three_places)
    cell.write(FIRST)
    await execute(cell.model, "run")
    await cell.until({})


async def test_steps_that_cannot_be_loaded_are_an_error_at_their_line_and_at_every_scenario(editor: Editor) -> None:
    steps = editor.path.parent / "steps" / "pickplace_steps.py"
    steps.parent.mkdir()
    steps.write_text("\nimport no_such_module\n", encoding="utf-8")
    editor.open()
    await execute(editor, "run")
    (found,) = await editor.diagnostics(CODE)
    assert found.message.startswith("4 scenarios have no result: steps failed: ModuleNotFoundError")
    async with asyncio.timeout(PATIENCE):
        while not editor.client.diagnostics.get(path_to_uri(steps)):
            await asyncio.sleep(0.02)
    (in_code,) = editor.client.diagnostics[path_to_uri(steps)]
    assert in_code.range.start.line == 1


async def test_an_error_of_a_policy_is_shown_at_its_line_at_the_policy_and_at_the_scenario(
    client: LanguageClient, tmp_path: Path
) -> None:
    folder = tmp_path / "pickplace"
    code = folder / "policies.py"
    text = code.read_text(encoding="utf-8").replace('arguments["goal"]', 'arguments["aim"]')
    code.write_text(text, encoding="utf-8")
    model = Editor(client, folder, "pickplace.bddx")
    model.open()
    await execute(model, "run")
    expected = {
        "policies.py": [line_of(code, 'arguments["aim"]')],
        "pickplace.bddx": [line_of(model.path, "obs policy (ns=exec) starts-outside")],
        "pickplace.bdd": [line_of(folder / "pickplace.bdd", "Scenario part-to-bin")],
    }
    await until_shown(client, expected)
    (at_policy,) = (one for one in client.diagnostics[model.uri] if one.code == CODE)
    assert at_policy.message.startswith("policies:apart failed: KeyError: 'aim' (policies.py:")
    assert at_policy.range.start == model.position("starts-outside")
