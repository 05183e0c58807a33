"""Runs from an editor: results at the clauses, immediately, again after a restart, stale after an edit."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any, cast

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcException, JsonRpcInvalidParams
from pytest_lsp import LanguageClient, client_capabilities, make_test_lsp_client

from fork_kit import ROBBDD_LSP
from kit import make_endless, schema_errors
from lsp_kit import CLIENTS, PATIENCE, Editor, plain
from robbdd_tools.base.files import path_to_uri, uri_to_path
from robbdd_tools.cli import main

LAMP = "            and\n            'the lamp is green' after <evt-end>\n        )"


async def execute(editor: Editor, command: str, **options: object) -> Any:
    target = {"uri": editor.uri, **options}
    params = types.ExecuteCommandParams(command=f"robbdd.{command}", arguments=[target])
    answer = await editor.client.workspace_execute_command_async(params)
    if command in ("run", "rerunFailed", "record"):
        assert schema_errors("runanswer.schema.json", plain(answer)) == [], answer
    return answer


async def hints(editor: Editor) -> dict[str, str]:
    """The results that are shown, by the beginnings of their lines."""
    document = types.TextDocumentIdentifier(uri=editor.uri)
    params = types.InlayHintParams(text_document=document, range=editor.everything())
    found = await editor.client.text_document_inlay_hint_async(params) or []
    results = [hint for hint in found if hint.kind is None]
    assert all(schema_errors("verdictdata.schema.json", plain(hint.data)) == [] for hint in results if hint.data)
    return {editor.text.split("\n")[hint.position.line].split(":")[0].strip(): str(hint.label) for hint in results}


async def lenses(editor: Editor) -> list[types.Command]:
    document = types.TextDocumentIdentifier(uri=editor.uri)
    found = await editor.client.text_document_code_lens_async(types.CodeLensParams(text_document=document))
    return [lens.command for lens in found or [] if lens.command is not None]


async def appearances(editor: Editor) -> dict[str, object]:
    """What decides the colours of the results that are shown, by their words."""
    document = types.TextDocumentIdentifier(uri=editor.uri)
    params = types.InlayHintParams(text_document=document, range=editor.everything())
    shown = {str(hint.label): hint.data for hint in await editor.client.text_document_inlay_hint_async(params) or []}
    found = await editor.client.text_document_code_lens_async(types.CodeLensParams(text_document=document)) or []
    shown |= {lens.command.title: lens.data for lens in found if lens.command is not None}
    return {words: plain(data) for words, data in shown.items() if data is not None}


async def another_client(folder: Path) -> LanguageClient:
    """A client of another server in the same workspace."""
    client = make_test_lsp_client()
    # The type of its further arguments is left open.
    start = cast(Any, client).start_io
    await start(*ROBBDD_LSP, "--stdio")
    root = types.WorkspaceFolder(uri=path_to_uri(folder), name="test")
    await client.initialize_session(
        types.InitializeParams(capabilities=client_capabilities("neovim"), workspace_folders=[root])
    )
    return client


def short(editor: Editor) -> str:
    """The example with one scenario."""
    return editor.text.replace("<cubes.cube0>, <balls.ball0>", "<cubes.cube0>").replace(", <places.right_ws>", "")


@CLIENTS
@pytest.mark.physics
async def test_a_run_shows_each_clauses_verdict_where_the_clause_stands(
    editor: Editor, run_messages: list[Any]
) -> None:
    editor.open(short(editor))
    await editor.diagnostics()
    command = (await lenses(editor))[0]
    assert command.title == "Run"
    params = types.ExecuteCommandParams(command=command.command, arguments=command.arguments)
    answer: Any = await editor.client.workspace_execute_command_async(params)
    assert {name: answer[name] for name in ("total", "holds", "violated", "unknown", "cancelled")} == {
        "total": 1,
        "holds": 1,
        "violated": 0,
        "unknown": 0,
        "cancelled": False,
    }
    shown = await hints(editor)
    assert set(shown) == {"at-source", "in-hand", "at-goal", "goal-untouched", "Behaviour (ns=crit) carry {"}
    assert all(label.startswith("✔") for label in shown.values()), shown
    assert "mm" in shown["at-goal"]
    messages = [notification.message for notification in run_messages]
    started = next(message for message in messages if message.type == "ScenarioStarted")
    assert (started.name, started.values.split(",")[0]) == ("crit:part-to-bin -- 1", "thing = cube0")
    sentences = [message.sentence for message in messages if message.type == "ClauseJudged"]
    assert "cube0 is located at left_ws after evt-place-end" in sentences
    assert (messages[-1].type, messages[-1].ok) == ("RunFinished", True)
    assert {notification.run for notification in run_messages} == {answer["run"]}


@pytest.mark.physics
async def test_messages_are_as_documented_and_lead_to_the_text(editor: Editor, run_messages: list[Any]) -> None:
    editor.open("// 😀\n" + short(editor).replace("\n        )\n", f"\n{LAMP}\n", 1))
    await execute(editor, "run")
    for notification in run_messages:
        assert schema_errors("runmessage.schema.json", plain(notification)) == [], notification
    assert {entry.message.type for entry in run_messages} >= {"RunStarted", "ClauseStarted", "ScenarioFinished"}
    written = editor.text.split("\n")
    for message in (entry.message for entry in run_messages if entry.message.type == "ClauseJudged"):
        start = message.source.range.start
        line = written[int(start.line)][int(start.character) :]
        assert line.startswith((f"{message.name}:", "Behaviour (ns=crit) carry", "'the lamp is green'")), line


@pytest.mark.physics
async def test_results_survive_a_restart_and_are_stale_after_an_edit(editor: Editor, tmp_path: Path) -> None:
    editor.open(short(editor))
    await execute(editor, "run")
    before = await hints(editor)
    fresh = {"verdict": "holds", "stale": False}
    assert await appearances(editor) == dict.fromkeys((*before.values(), "✔ 1/1 passed"), fresh)
    assert [command.title for command in await lenses(editor)][-2:] == ["1 scenario", "✔ 1/1 passed"]
    restarted = await another_client(tmp_path)
    later = Editor(restarted, tmp_path)
    later.open(editor.text)
    async with asyncio.timeout(PATIENCE):
        while await hints(later) != before:
            await asyncio.sleep(0.02)
    later.change("<thing> is located at <goal>", "<thing>  is located at <source>")
    changed = await hints(later)
    assert changed.pop("at-goal") == f"{before['at-goal']} (stale)"
    assert changed == {name: label for name, label in before.items() if name != "at-goal"}
    assert [command.title for command in await lenses(later)][-1] == "✔ 1/1 passed (stale)"
    stale = {words for words, data in (await appearances(later)).items() if data == {"verdict": "holds", "stale": True}}
    assert stale == {f"{before['at-goal']} (stale)", "✔ 1/1 passed (stale)"}
    await restarted.shutdown_session()


@pytest.mark.physics
async def test_a_clause_without_a_step_is_reported_with_a_fix_that_writes_one(editor: Editor) -> None:
    editor.open(short(editor).replace("\n        )\n", f"\n{LAMP}\n", 1))
    await execute(editor, "run")
    both = await editor.diagnostics("clause-undefined", "no-evaluator")
    (found,) = (one for one in both if one.code == "clause-undefined")
    assert "no step definition for 'the lamp is green after event" in found.message
    context = types.CodeActionContext(diagnostics=[found], only=[types.CodeActionKind.QuickFix])
    document = types.TextDocumentIdentifier(uri=editor.uri)
    params = types.CodeActionParams(text_document=document, range=found.range, context=context)
    actions = await editor.client.text_document_code_action_async(params) or []
    # The test client takes an action that is but a command for a command.
    (action,) = (one for one in actions if one.title == "Write a step skeleton")
    assert "robbdd.steps" in str(action.command)
    answer = await execute(editor, "steps")
    written = editor.path.parent / "steps" / "pickplace_steps.py"
    assert answer == {"files": [path_to_uri(written)]}
    assert written.read_text(encoding="utf-8").count("\ndef ") == 2
    assert "@then('the lamp is green after event \"{event:Quoted}\"')" in written.read_text(encoding="utf-8")
    again = written.read_bytes()
    await execute(editor, "steps")
    assert written.read_bytes() == again


@pytest.mark.physics
async def test_a_failed_scenario_is_run_again_alone_and_others_keep_their_results(
    editor: Editor, run_messages: list[Any]
) -> None:
    # The second one cannot be carried out: nothing is there to be picked.
    table = """                | <pick-place.thing> | <pick-place.robot> | <pick-place.source> | <pick-place.goal> |
                |---|---|---|---|
                | <cubes.cube0> | <arms.panda> | <places.table_ws> | <places.left_ws> |
                | <cubes.cube0> | <arms.panda> | <places.right_ws> | <places.left_ws> |
"""
    head, _, _ = editor.text.partition("                var <pick-place.thing>:")
    editor.open(head + table + "        }\n}\n")
    answer = await execute(editor, "run", seed=3)
    failed = answer["total"] - answer["holds"]
    rows = [label for line, label in (await hints(editor)).items() if line.startswith("|")]
    assert len(rows) == answer["total"] == 2
    assert sum(not label.startswith("✔") for label in rows) == failed
    titles = [command.title for command in await lenses(editor)]
    assert (f"Rerun {failed} failed" in titles) == (failed > 0)
    rate = f"{'✗' if failed else '✔'} {answer['holds']}/2 passed"
    assert rate in titles
    run_messages.clear()
    again = await execute(editor, "run", variation=1)
    assert again["total"] == 1
    assert [entry.message.variation for entry in run_messages if entry.message.type == "ScenarioStarted"] == [1]
    assert rate in [command.title for command in await lenses(editor)]
    repeated = await execute(editor, "rerunFailed")
    assert repeated.get("total", 0) == failed


@pytest.mark.physics
async def test_a_run_that_stops_at_a_failure_leaves_no_results_of_what_it_did_not_execute(editor: Editor) -> None:
    editor.open(short(editor).replace("after <evt-place-end>", "after <evt-pick-end>"))
    answer = await execute(editor, "run", repeat=3, jobs=1, stop_on_failure=True)
    assert (answer["failed"], answer["total"], answer["violated"], answer["unknown"]) == (0, 3, 1, 2)
    assert (await hints(editor))["at-goal"].startswith("✗ −"), "one execution, and no other that is unknown"
    kept = plain(await editor.client.protocol.send_request_async("robbdd/testResults", {}))["scenarios"]
    assert len(kept) == 1


@pytest.mark.physics
async def test_the_lens_record_runs_a_scenario_and_pictures_what_it_violates(editor: Editor, tmp_path: Path) -> None:
    editor.open(short(editor).replace("after <evt-pick-end>", "after <evt-place-end>", 1))
    await editor.diagnostics("unused-event")
    command = next(command for command in await lenses(editor) if command.title == "Record")
    params = types.ExecuteCommandParams(command=command.command, arguments=command.arguments)
    answer: Any = await editor.client.workspace_execute_command_async(params)
    assert (answer["total"], answer["violated"]) == (1, 1)
    pictures = [path for uri in answer["pictures"] if (path := uri_to_path(uri)) is not None]
    assert pictures
    assert all(path.is_relative_to(tmp_path) for path in pictures)
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in pictures)


def _indices(run_messages: list[Any], kind: str) -> set[int]:
    """Return the numbers of the executions that have a message of this type."""
    return {entry.message.index for entry in run_messages if entry.message.type == kind}


@pytest.mark.physics
async def test_a_cancelled_run_leaves_its_open_clauses_unknown(editor: Editor, run_messages: list[Any]) -> None:
    make_endless(editor.path)
    editor.open()
    await editor.diagnostics()
    running = asyncio.ensure_future(execute(editor, "run"))
    async with asyncio.timeout(PATIENCE):
        while not (finished := _indices(run_messages, "ScenarioFinished")) or not any(
            index > 1 for index in _indices(run_messages, "ClauseJudged")
        ):
            await asyncio.sleep(0.01)
    await editor.client.workspace_execute_command_async(types.ExecuteCommandParams(command="robbdd.cancel"))
    assert (await running)["cancelled"]
    messages = [entry.message for entry in run_messages]
    assert (messages[-1].type, messages[-1].ok) == ("RunFinished", False)
    judged = [message for message in messages if message.type == "ClauseJudged"]
    assert {message.verdict for message in judged if message.cancelled} == {"unknown"}
    assert len(judged) == 20
    results = await editor.client.protocol.send_request_async("robbdd/testResults", {})
    kept = [clause for scenario in plain(results)["scenarios"] for clause in scenario["clauses"]]
    assert 0 < len(kept) < 20
    assert "unknown" not in {clause["verdict"] for clause in kept}
    # The ball was at its source, but its scenario has not passed.
    assert {scenario["variation"] - 1 for scenario in plain(results)["scenarios"]} >= finished
    assert {len(scenario["clauses"]) for scenario in plain(results)["scenarios"]} == {5}


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"scenario": "none"}, "there is no scenario 'none'"),
        ({"variation": 9}, "no scenario fits the selection"),
        ({"where": "thing="}, "--where, column 7: expected a value"),
        ({"where": "thing=none"}, "no scenario fits the selection"),
        ({"failed": True}, "no scenario failed"),
        ({"seed": "seven"}, "no usable 'seed'"),
        ({"only": [7]}, "no usable 'only'"),
    ],
)
async def test_options_that_cannot_be_followed_are_answered(
    editor: Editor, options: dict[str, object], words: str
) -> None:
    editor.open()
    answer = plain(await execute(editor, "run", **options))
    assert words in answer["problem"]
    assert ("momentary" in answer) is (words == "no scenario failed"), "only that says nothing of the scenarios"
    assert any(words in message.message for message in editor.client.messages), editor.client.messages


async def test_a_run_of_a_broken_model_says_why_it_cannot_run(editor: Editor) -> None:
    editor.open(editor.text.replace("task: <pick-place-task>", "task <pick-place-task>"))
    params = types.ExecuteCommandParams(command="robbdd.run", arguments=[{"uri": editor.uri}])
    answer = plain(await editor.client.workspace_execute_command_async(params))
    assert "the model has errors" in answer["problem"]
    assert any("the model has errors" in message.message for message in editor.client.messages)


@pytest.mark.physics
async def test_a_run_is_kept_as_the_command_line_keeps_its_runs(
    editor: Editor, capsys: pytest.CaptureFixture[str]
) -> None:
    editor.open()
    answer = await execute(editor, "run", variation=2, seed=5)
    folder = editor.path.parent / ".robbdd" / "runs" / "1"
    assert plain(answer["stored"]) == {"run": 1, "folder": path_to_uri(folder)}
    listed = plain(await editor.client.protocol.send_request_async("robbdd/runs", {"uri": editor.uri}))["runs"]
    assert [(run["run"], run["model"], run["seed"], run["holds"]) for run in listed] == [(1, editor.uri, 5, 1)]
    shown = await editor.client.protocol.send_request_async("robbdd/trace", {"uri": editor.uri})
    assert (shown.run, shown.scenario.variation) == (1, 2)
    assert main(["replay", "latest", "--store", str(folder.parent)]) == 0
    assert main(["judge", "latest", str(editor.path)]) == 0
    assert "1 of 1 traces are the same" in capsys.readouterr().out


@pytest.mark.physics
async def test_a_client_may_call_two_runs_by_one_name(editor: Editor) -> None:
    editor.open(short(editor))
    answers = [await execute(editor, "run", token="mine") for _ in range(2)]
    assert [(answer["run"], answer["holds"]) for answer in answers] == [("mine", 1)] * 2


@pytest.mark.physics
async def test_a_folder_that_cannot_be_written_does_not_keep_a_run_from_being_looked_at(editor: Editor) -> None:
    (editor.path.parent / ".robbdd").write_text("in the way", encoding="utf-8")
    editor.open(short(editor))
    answer = await execute(editor, "run")
    assert answer["holds"] == 1
    (told,) = editor.client.messages
    assert "this run is kept in" in told.message
    assert "cannot be written" in told.message
    shown = await editor.client.protocol.send_request_async("robbdd/trace", {"uri": editor.uri})
    assert shown.folder == plain(answer["stored"])["folder"]
    assert {label[0] for label in (await hints(editor)).values()} == {"✔"}


@pytest.mark.physics
async def test_two_servers_run_one_model_at_once(editor: Editor, tmp_path: Path) -> None:
    other = Editor(await another_client(tmp_path), tmp_path)
    for one in (editor, other):
        one.open(short(one))
    answers = await asyncio.gather(execute(editor, "run"), execute(other, "run"))
    assert {plain(answer["stored"])["run"] for answer in answers} == {1, 2}
    assert {answer["holds"] for answer in answers} == {1}
    await other.client.shutdown_session()


@pytest.mark.parametrize("command", ["run", "rerunFailed", "record", "gherkin", "steps"])
@pytest.mark.parametrize("arguments", [None, ["a.bdd"], [{}], [{"uri": 1}]])
async def test_a_command_that_names_no_model_is_told_what_it_takes(
    editor: Editor, command: str, arguments: list[Any] | None
) -> None:
    params = types.ExecuteCommandParams(command=f"robbdd.{command}", arguments=arguments)
    told = f"robbdd.{command} takes an object with the 'uri' of a model"
    with pytest.raises(JsonRpcException, match=told) as refused:
        await editor.client.workspace_execute_command_async(params)
    assert refused.value.code == JsonRpcInvalidParams.CODE
