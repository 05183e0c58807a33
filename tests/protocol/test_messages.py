"""Messages and manifests survive the way to the other process."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit import write_manifest
from robbdd_tools.monitor.fault import Fault, Frame
from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.protocol.messages import (
    ClauseJudged,
    ClauseStarted,
    LogLine,
    Output,
    RunFinished,
    RunMessage,
    RunStarted,
    ScenarioFinished,
    ScenarioStarted,
    UserCodeFailed,
    decode,
    encode,
)
from robbdd_tools.protocol.specs import ClauseSpec, ConfigSpec, Manifest, ScenarioSpec, SceneSpec

MESSAGES = [
    RunStarted(3, "mujoco"),
    ScenarioStarted(0),
    ClauseStarted(0, 12),
    ClauseJudged(0, 12, "violated", -0.012, "m", 3.4, "pushed"),
    ClauseJudged(0, 13, "unknown", None, "", None, "event t:end never occurred"),
    ScenarioFinished(0, 9.5, 0.8, 0.5),
    UserCodeFailed(1, Fault("KeyError", "'a'", "m:f", (Frame("/m.py", 3, "f", "x['a']", True),), "https://x/b", "00")),
    UserCodeFailed(None, Fault("", "odd", "steps")),
    Output(1, 'one\ntwo "✗"'),
    LogLine("warning", 'odd "text" ✗\nsecond line'),
    RunFinished(True),
]


@pytest.mark.parametrize("message", MESSAGES, ids=lambda message: type(message).__name__)
def test_a_message_is_one_line_and_comes_back_equal(message: RunMessage) -> None:
    line = encode(message)
    assert "\n" not in line
    assert decode(line) == message


@given(st.text())
def test_anything_else_is_refused_as_a_value_error(line: str) -> None:
    with pytest.raises(ValueError, match="not a run message"):
        decode(line)


JUDGED = '"index": 1, "line": 5, "verdict": "holds", "robustness": 1, "unit": "m", "at": null, "reason": ""'


@pytest.mark.parametrize(
    "line",
    [
        '{"type": "ScenarioStarted", "index": "1"}',
        '{"type": "ScenarioStarted", "index": 1.5}',
        '{"type": "ScenarioStarted", "index": true}',
        '{"type": "ScenarioStarted", "index": null}',
        '{"type": "ScenarioStarted"}',
        '{"type": "ScenarioStarted", "index": 1, "more": 2}',
        '{"type": ["ScenarioStarted"], "index": 1}',
        '{"type": "Nothing"}',
        '{"type": "LogLine", "level": "loud", "text": ""}',
        '{"type": "RunStarted", "total": 1, "simulator": {}}',
        '{"type": "MarginRanges", "index": 1, "line": 5, "ranges": [[0, 1, 2]]}',
        '{"type": "MarginRanges", "index": 1, "line": 5, "ranges": "01"}',
        '{"type": "ScenarioFinished", "index": 1, "simulated": NaN, "wall": 0, "stepping": 0}',
        '{"type": "ScenarioFinished", "index": 1, "simulated": 1e999, "wall": 0, "stepping": 0}',
        '{"type": "ClauseJudged", ' + JUDGED.replace("holds", "fine") + "}",
        '{"type": "ClauseJudged", ' + JUDGED.replace('"m"', "7") + "}",
        "[" * 100_000,
        '{"type": ' * 100_000,
        "1" * 10_000,
    ],
)
def test_a_message_is_checked_field_by_field(line: str) -> None:
    assert decode('{"type": "ClauseJudged", ' + JUDGED + "}") == ClauseJudged(1, 5, "holds", 1, "m", None, "")
    with pytest.raises(ValueError, match="not a run message"):
        decode(line)


def test_half_characters_survive() -> None:
    message = LogLine("info", "\udc80 \ud800 ü 😀")
    assert encode(message).isascii()
    assert decode(encode(message)) == message


def test_a_manifest_comes_back_equal(tmp_path: Path) -> None:
    scene = SceneSpec(("e:a",), ("e:r",), {"e:w": ("e:t",)}, {"e:w": ("e:v",)}, {"e:a": "e:w"})
    scene = replace(scene, stated=(ConfigSpec("e:a", "mass", "0.2"),))
    clause = ClauseSpec(9, "https://x/c", "c", "then", '"e:a" is located at "e:w" after event "e:e"')
    values = {"e:var-x": "e:a", "e:var-n": 0.5, "e:var-s": ["e:a", "e:b"]}
    scenario = ScenarioSpec(
        "features/s.feature", 6, "e:v -- 1", "s", "v", 1, values, 7, scene, {"e:e": "pick-end"}, (clause,)
    )
    manifest = Manifest("m.bdd", 1, (scenario,), False, {"features/steps/own.py": "/own.py"})
    write_manifest(tmp_path, manifest)
    assert read_manifest(tmp_path) == manifest


def test_a_manifest_of_an_earlier_version_is_read(tmp_path: Path) -> None:
    clause = ClauseSpec(
        9, "https://x/g", "g", "then", '( a after event "e:e" or b after event "e:e" )', None, ("a", "b")
    )
    scenario = ScenarioSpec("s.feature", 6, "n", "s", "v", 1, {}, 7, SceneSpec(), {}, (clause,))
    write_manifest(tmp_path, Manifest("m.bdd", 1, (scenario,)))
    path = tmp_path / "manifest.json"
    data = json.loads(path.read_text(encoding="utf-8"))
    (entry,) = data["scenarios"][0]["clauses"]
    # It wrote the values for users' code and the sentence, but not the sentence's data.
    del entry["statement"]
    entry["arguments"] = [{}]
    path.write_text(json.dumps(data), encoding="utf-8")
    assert read_manifest(tmp_path).scenarios == (scenario,)
