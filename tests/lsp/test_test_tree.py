"""The test tree, as requested by a client, and runs of selected items."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from lsprotocol import types

from kit import schema_errors
from lsp_kit import CLIENTS, Editor, plain
from robbdd_tools.base.files import path_to_uri

VARIANT = "https://example.org/robbdd/criteria/part-to-bin"
TABLE = """                | <pick-place.thing> | <pick-place.robot> | <pick-place.source> | <pick-place.goal> |
                |---|---|---|---|
                | <cubes.cube0> | <arms.panda> | <places.table_ws> | <places.left_ws> |
                | <balls.ball0> | <arms.panda> | <places.table_ws> | <places.left_ws> |
"""


def with_table(editor: Editor) -> str:
    head, _, _ = editor.text.partition("                var <pick-place.thing>:")
    return head + TABLE + "        }\n}\n"


async def tests(editor: Editor, **params: object) -> Any:
    answer = plain(await editor.client.protocol.send_request_async("robbdd/tests", params))
    assert schema_errors("tests.schema.json", answer) == []
    return answer


def written(editor: Editor, place: Any) -> str:
    """The text from the start of a place to the end of its line."""
    start = place["range"]["start"]
    line: bytes = editor.text.split("\n")[int(start["line"])].encode("utf-16-le")
    return line[2 * int(start["character"]) :].decode("utf-16-le")


@CLIENTS
async def test_each_level_is_told_with_its_places(editor: Editor) -> None:
    files = await tests(editor)
    assert files["files"] == [editor.uri, f"{editor.uri}x"]
    editor.open("// 😀\n" + with_table(editor))
    answer = await tests(editor, uri=editor.uri)
    assert [uri.rsplit("/", 1)[-1] for uri in answer["files"]] == ["pickplace.bdd", "bench.scene"]
    (story,) = answer["tests"]
    (variant,) = story["tests"]
    assert (story["name"], story["detail"]) == ("tidy-bench", "the arm to put loose parts into a bin")
    assert (variant["id"], variant["count"], variant["detail"]) == (VARIANT, 2, "2 scenarios")
    assert written(editor, variant["place"]).startswith("part-to-bin {")
    scenarios = (await tests(editor, uri=editor.uri, variant=VARIANT))["tests"]
    assert [(one["name"], one["detail"]) for one in scenarios] == [
        ("thing = cube0", "row 1, robot = panda, source = table_ws, goal = left_ws"),
        ("thing = ball0", "row 2, robot = panda, source = table_ws, goal = left_ws"),
    ]
    assert written(editor, scenarios[1]["place"]).startswith("| <balls.ball0>")
    clauses = scenarios[1]["tests"]
    assert [f"{one['role']} {one['name']}" for one in clauses] == [
        "given at-source",
        "when carry",
        "then in-hand",
        "then at-goal",
        "then goal-untouched",
    ]
    assert clauses[2]["detail"] == "ball0 is held by panda after evt-pick-end"
    assert written(editor, clauses[2]["place"]).startswith("in-hand: holds(")


async def test_the_tree_follows_an_edit_and_says_why_it_has_no_scenarios(editor: Editor) -> None:
    editor.open()
    editor.change("part-to-bin", "parts-away")
    (story,) = (await tests(editor, uri=editor.uri))["tests"]
    assert [variant["name"] for variant in story["tests"]] == ["parts-away"]
    editor.change("task: <pick-place-task>", "task: <pick-place-tas>")
    answer = await tests(editor, uri=editor.uri, variant=story["tests"][0]["id"])
    assert answer["tests"] == []
    assert answer["problem"].startswith("the model has errors, the first: ")
    line = editor.text[: editor.text.index("task: <pick-place-tas>")].count("\n") + 1
    assert answer["problem"].endswith(f" (pickplace.bdd, line {line})")
    (story,) = (await tests(editor, uri=editor.uri))["tests"]
    assert [variant["name"] for variant in story["tests"]] == ["parts-away"]


async def test_a_part_of_many_scenarios_is_told_at_a_time(editor: Editor) -> None:
    answer = await tests(editor, uri=editor.uri, variant=VARIANT, first=3, most=1)
    assert [one["number"] for one in answer["tests"]] == [3]


async def test_a_file_that_is_gone_is_answered_with_why(editor: Editor, tmp_path: Path) -> None:
    answer = await tests(editor, uri=path_to_uri(tmp_path / "gone.bdd"))
    assert answer["tests"] == []
    assert "there is no file 'gone.bdd'" in answer["problem"]


@pytest.mark.physics
async def test_chosen_scenarios_of_an_unopened_file_are_run_under_the_clients_name(
    editor: Editor, run_messages: list[Any]
) -> None:
    target = {"uri": editor.uri, "only": [{"variant": VARIANT, "variations": [2, 4]}], "token": "mine"}
    params = types.ExecuteCommandParams(command="robbdd.run", arguments=[target])
    answer: Any = await editor.client.workspace_execute_command_async(params)
    assert (answer["run"], answer["total"]) == ("mine", 2)
    ((variant,),) = [story["tests"] for story in (await tests(editor, uri=editor.uri))["tests"]]
    assert variant["detail"][1:].startswith(" 2 of 4 executed, ")
    assert {entry.run for entry in run_messages} == {"mine"}
    messages = [entry.message for entry in run_messages]
    assert sorted(one.variation for one in messages if one.type == "ScenarioStarted") == [2, 4]
    listed = (await tests(editor, uri=editor.uri, variant=VARIANT, first=2, most=1))["tests"][0]["tests"]
    for judged in (one for one in messages if one.type == "ClauseJudged"):
        assert judged.clause == listed[int(judged.position)]["id"]


@pytest.mark.parametrize(
    ("only", "words"),
    [
        ([{"variant": "https://example.org/gone"}], "the model no longer has these scenarios"),
        ([{"variant": VARIANT, "variations": [99]}], "no scenario fits the selection"),
        ([{"variations": [1]}], "no usable 'only'"),
    ],
)
async def test_a_choice_that_cannot_be_run_is_answered(editor: Editor, only: list[object], words: str) -> None:
    params = types.ExecuteCommandParams(command="robbdd.run", arguments=[{"uri": editor.uri, "only": only}])
    answer = plain(await editor.client.workspace_execute_command_async(params))
    assert words in answer["problem"]
    assert any(words in message.message for message in editor.client.messages), editor.client.messages
