"""The scene instances of a ``.scenex`` as shapes and poses, as requested by a client."""

from __future__ import annotations

import asyncio
import shutil
from pathlib import Path
from typing import Any

import pytest
from pytest_lsp import LanguageClient

from kit import EXAMPLES, schema_errors
from lsp_kit import Editor, plain

MARK = "executed.txt"


@pytest.fixture
def cell(client: LanguageClient, tmp_path: Path) -> Editor:
    """The executable scene of the example with an own robot."""
    shutil.copytree(EXAMPLES / "ownrobot", tmp_path / "ownrobot")
    return Editor(client, tmp_path, "ownrobot/cell.scenex")


async def scenes_of(editor: Editor) -> Any:
    return plain(await editor.client.protocol.send_request_async("robbdd/scene", {"uri": editor.uri}))


def places(scene: dict[str, Any]) -> dict[str, list[float]]:
    return {body["name"]: body["position"] for body in scene["bodies"]}


async def test_the_scene_follows_the_edit_and_keeps_the_last_good_one(cell: Editor) -> None:
    cell.open()
    first = await scenes_of(cell)
    assert schema_errors("scene.schema.json", first) == []
    assert first["problem"] is None
    (scene,) = first["scenes"]
    assert (scene["name"], scene["sampled"], scene["missing"]) == ("cell_sim", ["cube0", "cube1"], [])
    assert scene["faults"] == []
    before = places(scene)
    assert before["table"][:2] == [0.5, 0.0]
    assert any(name.startswith("five/") for name in before)
    cell.change("xyz: (50, 0, 10) cm", "xyz: (80, 20, 10) cm")
    (moved,) = (await scenes_of(cell))["scenes"]
    assert places(moved)["table"][:2] == [0.8, 0.2]
    cell.change("wrt: <top.middle>", "wrt: <top.midle>")
    broken = await scenes_of(cell)
    assert broken["problem"].startswith("line ")
    assert broken["scenes"] == [moved]


async def test_faults_have_their_place(cell: Editor) -> None:
    cell.open(cell.text.replace('tool: "tcp"', 'tool: "tpc"').replace("(-100, 500, 0) mm", "(-480, 0, 0) mm"))
    (scene,) = (await scenes_of(cell))["scenes"]
    (fault,) = scene["faults"]
    assert (fault["kind"], "no site or body 'tpc'" in fault["reason"]) == ("model", True)
    assert fault["source"]["uri"] == cell.uri
    assert fault["source"]["range"]["start"]["line"] == cell.position("model five_model").line
    assert scene["missing"] == ["five"]
    cell.change('"tpc"', '"tcp"')
    (scene,) = (await scenes_of(cell))["scenes"]
    assert [one["kind"] for one in scene["faults"]] == ["overlap"]


async def test_users_code_is_not_executed(cell: Editor) -> None:
    mark = cell.path.parent / MARK
    code = f"open({str(mark)!r}, 'w').close()\ndef cube():\n    return '<mujoco/>'\n"
    (cell.path.parent / "made.py").write_text(code, encoding="utf-8")
    cell.open(cell.text.replace('{ catalog "cube" map', "{ py { module: made, attr: cube } map"))
    (scene,) = (await scenes_of(cell))["scenes"]
    assert scene["missing"] == ["cube0", "cube1"]
    assert not mark.exists()


async def test_a_file_without_a_scene_instance_has_a_reason(client: LanguageClient, tmp_path: Path) -> None:
    editor = Editor(client, tmp_path, "pickplace/bench.scene")
    editor.open()
    answer = await scenes_of(editor)
    assert (answer["scenes"], answer["problem"]) == ([], "this file declares no scene instance (scene inst …)")


async def test_of_several_requests_only_the_latest_is_drawn(cell: Editor) -> None:
    cell.open()
    answers = await asyncio.gather(*(scenes_of(cell) for _ in range(4)))
    assert [one["problem"] for one in answers[1:-1]] == ["a newer request replaces this one"] * 2
    assert answers[-1]["problem"] is None
    assert answers[-1]["scenes"]
