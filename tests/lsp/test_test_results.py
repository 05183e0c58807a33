"""Results of runs before and elsewhere, as the tree of tests shows them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from lsprotocol import types

from kit import schema_errors
from lsp_kit import Editor, plain
from robbdd_tools.base.files import path_to_uri

VARIANT = "https://example.org/robbdd/criteria/part-to-bin"
CASE = """<testsuites><testsuite name="{story}">
<testcase name="crit:part-to-bin -- 3 [thing = ball0]" classname="x" time="0.5">
<system-out>seed 7
✔ +16 mm  [Given ball0 is located at table_ws before evt-pick-start]
✗ −12 mm at 3.20 s  [Then ball0 is located at left_ws after evt-place-end]</system-out>
</testcase></testsuite></testsuites>"""


async def ask(editor: Editor, method: str, **params: object) -> Any:
    answer = plain(await editor.client.protocol.send_request_async(f"robbdd/{method}", params))
    assert schema_errors("testresults.schema.json", answer) == []
    return answer


async def imported(editor: Editor, path: Path, text: str) -> Any:
    path.write_text(text, encoding="utf-8")
    return await ask(editor, "importResults", uri=path_to_uri(path))


async def test_junit_is_matched_by_the_names_of_story_and_variant(editor: Editor, tmp_path: Path) -> None:
    answer = await imported(editor, tmp_path / "ci.xml", CASE.format(story="tidy-bench"))
    (scenario,) = answer["scenarios"]
    assert (scenario["uri"], scenario["variant"], scenario["variation"]) == (editor.uri, VARIANT, 3)
    assert [(one["position"], one["verdict"]) for one in scenario["clauses"]] == [(0, "holds"), (1, "violated")]
    elsewhere = await imported(editor, tmp_path / "other.xml", CASE.format(story="another"))
    assert (elsewhere["left"], elsewhere["scenarios"]) == (1, [])


async def test_a_broken_file_is_answered_with_its_place(editor: Editor, tmp_path: Path) -> None:
    answer = await imported(editor, tmp_path / "ci.json", '{\n "scenarios": [,]}')
    assert answer["problem"].startswith("ci.json, line 2, column 16: this is neither JSON nor XML")
    answer = await ask(editor, "importResults", uri=path_to_uri(tmp_path / "none.xml"))
    assert "there is no file 'none.xml'" in answer["problem"]


@pytest.mark.physics
async def test_results_of_runs_are_kept_and_stale_after_an_edit(editor: Editor) -> None:
    target = {"uri": editor.uri, "only": [{"variant": VARIANT, "variations": [2]}]}
    params = types.ExecuteCommandParams(command="robbdd.run", arguments=[target])
    await editor.client.workspace_execute_command_async(params)
    kept = await ask(editor, "testResults")
    (scenario,) = kept["scenarios"]
    assert (scenario["variation"], scenario["stale"]) == (2, False)
    assert all(not one["stale"] and one["said"].startswith("✔") for one in scenario["clauses"])
    editor.open(editor.text)
    editor.change("<thing> is located at <goal>", "<thing> is located at <source>")
    (scenario,) = (await ask(editor, "testResults"))["scenarios"]
    assert scenario["stale"]
    stale = [one["clause"].rsplit("/", 1)[-1] for one in scenario["clauses"] if one["stale"]]
    assert stale == ["at-goal"]


async def test_json_is_matched_by_the_variants_iri(editor: Editor, tmp_path: Path) -> None:
    clause = {
        "iri": f"{VARIANT}/c", "name": "c", "role": "then", "sentence": 'the "crit:cube0" is there',
        "verdict": "unknown", "robustness": None, "unit": "", "at": None, "reason": "timed out",
    }  # fmt: skip
    scenario = {
        "story": "https://example.org/robbdd/criteria/tidy-bench", "variant": VARIANT, "variation": 1, "name": "x -- 1",
        "values": {"crit:var-thing": "env:cube0"}, "seed": 1, "verdict": "unknown", "clauses": [clause],
    }  # fmt: skip
    other = {**scenario, "variant": "https://example.org/other"}
    answer = await imported(editor, tmp_path / "ci.json", json.dumps({"scenarios": [scenario, other]}))
    assert answer["left"] == 1
    (found,) = answer["scenarios"]
    assert (found["values"], found["clauses"][0]["said"]) == ("thing = cube0", "? unknown: timed out")
    assert found["clauses"][0]["sentence"] == "the cube0 is there"
