"""Stored runs and their traces, as requested by clients."""

from __future__ import annotations

from base64 import b64decode
from typing import Any

import numpy as np
import pytest
from pygls.exceptions import JsonRpcException

from kit import schema_errors
from lsp_kit import Editor, plain
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.cli import main

LARGEST = 400_000
"""Bytes of an answer about one arm and some ten seconds."""


async def ask(editor: Editor, request: str, **parameters: object) -> Any:
    answer = await editor.client.protocol.send_request_async(f"robbdd/{request}", {"uri": editor.uri, **parameters})
    return plain(answer)


def numbers(array: Any) -> Any:
    kind = np.dtype(array["type"]).newbyteorder("<")
    return np.frombuffer(b64decode(array["data"]), kind).reshape(array["shape"])


async def test_a_project_without_runs_says_so(editor: Editor) -> None:
    answer = await ask(editor, "runs")
    assert answer == {"store": path_to_uri(editor.path.parent / ".robbdd" / "runs"), "runs": []}
    for parameters in ({}, {"run": 7}, {"run": "latest", "index": 0}):
        with pytest.raises(JsonRpcException, match=r"there is no (trace of any scenario|run)"):
            await ask(editor, "trace", **parameters)


@pytest.mark.physics
async def test_a_stored_run_is_listed_and_shown_as_documented(editor: Editor) -> None:
    editor.open()
    assert main(["run", str(editor.path), "--where", "thing = cube0"]) == 0
    (listed,) = (answer := await ask(editor, "runs"))["runs"]
    assert schema_errors("runs.schema.json", answer) == []
    assert (listed["model"], listed["holds"], listed["violated"]) == (editor.uri, 2, 0)
    answer = await ask(editor, "runs", run="latest")
    assert schema_errors("runs.schema.json", answer) == []
    first, second = answer["runs"][0]["scenarios"]
    assert (first["index"], second["index"], second["verdict"], second["trace"]) == (0, 1, "holds", True)

    shown = await ask(editor, "trace", variant=second["variant"], variation=second["variation"])
    assert schema_errors("trace.schema.json", shown) == []
    assert shown["scenario"] == second
    assert len(str(shown)) < LARGEST
    frames, names = shown["frames"], [body["name"] for body in shown["bodies"]]
    times, poses = numbers(frames["times"]), numbers(frames["poses"])
    assert poses.shape == (len(times), len(frames["bodies"]), 7)
    assert times[0] == 0
    assert np.all(np.diff(times) > 0)
    assert times[-1] == pytest.approx(shown["duration"], abs=0.1)
    cube = frames["bodies"].index(next(number for number, name in enumerate(names) if name.endswith(":cube0")))
    assert np.abs(np.linalg.norm(poses[..., 3:], axis=-1) - 1).max() < 1e-3
    assert np.linalg.norm(poses[-1, cube, :3] - poses[0, cube, :3]) > 0.1
    assert {shape["kind"] for shape in shown["shapes"]} >= {"box", "plane", "cylinder"}
    assert any(workspace["name"].endswith(":right_ws") for workspace in shown["workspaces"])

    (tool,) = shown["tools"]
    assert names[tool["body"]] == f"{tool['agent']}/tool"
    away = np.linalg.norm(
        poses[:, frames["bodies"].index(tool["body"]), :3] - poses[:, cube, :3],
        axis=-1,
    )
    (grip,) = (
        one for one in shown["forces"] if [name.partition(":")[2] for name in one["between"]] == ["panda", "cube0"]
    )
    assert grip["bodies"] == [tool["body"], names.index(grip["between"][1])]
    pressed = numbers(grip["peaks"]) > 0
    assert pressed.shape == times.shape
    assert 0.2 < pressed.mean() < 0.9, "the gripper holds the cube for a part of the execution"
    assert away[pressed].max() < 0.15 < away[~pressed].max(), "only what is near is gripped"

    clause = next(entry for entry in shown["clauses"] if entry["name"] == "at-goal")
    (part,) = clause["parts"]
    end = next(event["time"] for event in shown["events"] if event["name"].endswith(":evt-place-end"))
    assert part["start"] == part["end"] == pytest.approx(end)
    at = part["margins"][part["times"].index(part["start"])]
    assert at == pytest.approx(clause["robustness"], abs=1e-6)
    assert min(part["margins"]) < 0 < at, "the goal was not reached before the end"
    line = int(clause["source"]["range"]["start"]["line"])
    assert editor.text.split("\n")[line].strip().startswith("at-goal: holds(")
    (duration,) = next(entry for entry in shown["clauses"] if entry["role"] == "when")["parts"]
    assert (duration["end"], duration["margins"]) == (pytest.approx(end), [])

    with pytest.raises(JsonRpcException, match="run 1 has no scenario number 2"):
        await ask(editor, "trace", run=1, index=2)


@pytest.mark.physics
async def test_clauses_of_a_trace_are_stale_where_the_model_states_them_no_more(editor: Editor) -> None:
    async def stale() -> dict[str, bool | None]:
        shown = await ask(editor, "trace")
        assert schema_errors("trace.schema.json", shown) == []
        return {clause["name"]: clause["stale"] for clause in shown["clauses"]}

    editor.open()
    assert main(["run", str(editor.path), "--where", "thing = cube0", "--first", "1"]) == 0
    before = await stale()
    assert len(before) == 5
    assert set(before.values()) == {False}
    editor.change("at-goal: holds(", "at-goal:   holds( ")
    assert await stale() == before
    editor.change("located at <goal>, after <evt-place-end>", "located at <goal>, after <evt-end>")
    assert await stale() == {**before, "at-goal": True}
    editor.change("Scenario Template", "Scenario Tmplate")
    assert set((await stale()).values()) == {None}


async def test_a_broken_run_is_listed_with_what_is_wrong(editor: Editor) -> None:
    folder = editor.path.parent / ".robbdd" / "runs" / "3"
    folder.mkdir(parents=True)
    answer = await ask(editor, "runs")
    assert schema_errors("runs.schema.json", answer) == []
    (listed,) = answer["runs"]
    assert "there is no run.json" in listed["problem"]
    with pytest.raises(JsonRpcException, match="holds no finished run"):
        await ask(editor, "runs", run=3)
