"""The agent process: messages on its standard output, and the same verdicts from plain behave."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from kit import write_manifest
from robbdd_tools.protocol.manifest_file import MANIFEST
from robbdd_tools.protocol.messages import (
    ClauseJudged,
    ClauseStarted,
    Execute,
    LogLine,
    RunFinished,
    RunMessage,
    RunStarted,
    ScenarioFinished,
    ScenarioStarted,
    decode,
    encode,
)
from robbdd_tools.protocol.specs import ConfigSpec, Manifest, ScenarioSpec
from robbdd_tools.world.composition import build_world
from world.worlds import BIN_WS, CUBE, OTHER_WS, PANDA, SCENE, Steps, write_run

pytestmark = pytest.mark.physics
CLAUSES = (
    ("given", f'"{CUBE}" is located at "env:bench_ws" before event "t:pick-start"', "holds"),
    ("given", f'"{CUBE}" has config "mass" = "0.04" before event "t:pick-start"', "holds"),
    ("given", f'"{CUBE}" has config "friction" = "0.9" before event "t:pick-start"', "violated"),
    ("when", f'"{PANDA}" picks "{CUBE}" and places it at "{BIN_WS}"', "holds"),
    ("when", 'event "t:place-end" occurs', "holds"),
    ("then", f'"{CUBE}" is located at "{BIN_WS}" for 0.5 seconds after event "t:place-end"', "holds"),
    ("then", f'"{CUBE}" is located at "{OTHER_WS}" after event "t:place-end"', "violated"),
    ("then", 'the lamp is green after event "t:place-end"', "unknown"),
    ("then", f'"{CUBE}" is located at "any of [\'{OTHER_WS}\', \'{BIN_WS}\']" after event "t:place-end"', "holds"),
    ("then", f'not ( "{CUBE}" is held by "{PANDA}" after event "t:place-end" )', "holds"),
    ("then", f'"{PANDA}" does not collide "{BIN_WS}" from "t:pick-start" until "t:place-end"', "holds"),
    ("then", f'"{CUBE}" is located at "env:bench_ws" for 1 seconds before event "t:pick-start"', "holds"),
)
SET_UP = replace(SCENE, config=(ConfigSpec(CUBE, "mass", "0.04"),))
STEPS = tuple((role, text) for role, text, _ in CLAUSES)
EXPECTED = [verdict for *_, verdict in CLAUSES]
GIZMO = replace(SCENE, objects=(*SCENE.objects, "env:gizmo"))


def agent(folder: Path, *more: str, orders: Sequence[int] = (0,)) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "robbdd_tools.agent", str(folder), *more]
    lines = "".join(encode(Execute(index)) + "\n" for index in orders)
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder, input=lines)


def messages(output: str) -> list[RunMessage]:
    return [decode(line) for line in output.splitlines()]


def verdicts(found: Sequence[RunMessage], spec: ScenarioSpec, index: int) -> list[str]:
    by_line = {
        message.line: message.verdict
        for message in found
        if isinstance(message, ClauseJudged) and message.index == index
    }
    return [by_line[clause.line] for clause in spec.clauses]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("run") / "folder"


@pytest.fixture(scope="module")
def specs(folder: Path) -> tuple[ScenarioSpec, ...]:
    folder.mkdir()
    return write_run(folder, [Steps(STEPS, SET_UP, 1), Steps(STEPS, GIZMO), Steps(STEPS, SET_UP, 2)])


@pytest.fixture(scope="module")
def found(folder: Path, specs: tuple[ScenarioSpec, ...]) -> list[RunMessage]:
    assert specs
    done = agent(folder, orders=range(3))
    assert done.returncode == 0, done.stderr
    return messages(done.stdout)


def test_every_clause_gets_its_verdict(found: list[RunMessage], specs: tuple[ScenarioSpec, ...]) -> None:
    assert verdicts(found, specs[0], 0) == EXPECTED
    assert verdicts(found, specs[2], 2) == EXPECTED


def test_the_messages_come_in_order(found: list[RunMessage], specs: tuple[ScenarioSpec, ...]) -> None:
    assert isinstance(found[0], RunStarted)
    assert found[0].total == len(specs)
    assert found[-1] == RunFinished(True)
    frames = [message for message in found if isinstance(message, ScenarioStarted | ScenarioFinished)]
    assert [(type(frame), frame.index) for frame in frames] == [
        (kind, index) for index in range(3) for kind in (ScenarioStarted, ScenarioFinished)
    ]
    waiting: set[tuple[int, int]] = set()
    for message in found:
        if isinstance(message, ClauseStarted):
            waiting.add((message.index, message.line))
    judged = [(message.index, message.line) for message in found if isinstance(message, ClauseJudged)]
    assert len(set(judged)) == len(judged) == 3 * len(CLAUSES)
    assert waiting <= set(judged)


def test_a_verdict_carries_margin_unit_and_instant(found: list[RunMessage], specs: tuple[ScenarioSpec, ...]) -> None:
    line = specs[0].clauses[6].line
    (wrong,) = [m for m in found if isinstance(m, ClauseJudged) and (m.index, m.line) == (0, line)]
    assert wrong.unit == "m"
    assert wrong.robustness is not None
    assert wrong.robustness < -0.5
    assert wrong.at is not None
    assert wrong.at > 5.0


def test_what_nothing_says_is_unknown_with_its_words(found: list[RunMessage], specs: tuple[ScenarioSpec, ...]) -> None:
    line = specs[0].clauses[7].line
    (lamp,) = [m for m in found if isinstance(m, ClauseJudged) and (m.index, m.line) == (0, line)]
    assert lamp.reason == "no step definition for 'the lamp is green after event \"t:place-end\"'"


def test_a_scene_without_models_is_unknown_and_the_next_scenario_runs(
    found: list[RunMessage], specs: tuple[ScenarioSpec, ...]
) -> None:
    assert set(verdicts(found, specs[1], 1)) == {"unknown"}
    reasons = {m.reason for m in found if isinstance(m, ClauseJudged) and m.index == 1}
    assert len(reasons) == 1
    assert "there is no model for object 'env:gizmo'" in reasons.pop()


def test_a_scenario_reports_its_times(found: list[RunMessage]) -> None:
    first = next(message for message in found if isinstance(message, ScenarioFinished))
    assert first.simulated > first.wall > first.stepping > 0


def test_a_scenario_reports_how_many_places_were_drawn_again(tmp_path: Path) -> None:
    crowd = replace(SCENE, objects=(*SCENE.objects, *(f"env:ball{number}" for number in range(2, 12))))
    (spec,) = write_run(tmp_path, [Steps(STEPS[:1], crowd)])
    done = agent(tmp_path)
    (finished,) = [message for message in messages(done.stdout) if isinstance(message, ScenarioFinished)]
    assert finished.resampled == build_world(spec.scene, spec.seed).resampled > 0


def test_plain_behave_gives_the_same_verdicts(folder: Path, specs: tuple[ScenarioSpec, ...]) -> None:
    report = folder / "behave.json"
    command = [sys.executable, "-m", "behave", str(folder / "features"), "--format=json", f"--outfile={report}"]
    subprocess.run(command, capture_output=True, check=False, cwd=folder)
    scenarios = json.loads(report.read_text())[0]["elements"]
    for index in (0, 2):
        steps = scenarios[index]["steps"][-len(CLAUSES) :]
        assert [step["location"].rpartition(":")[2] for step in steps] == [str(c.line) for c in specs[index].clauses]
        for step, verdict in zip(steps, EXPECTED, strict=True):
            result = step.get("result", {"status": "undefined"})
            passed = result["status"] == "passed"
            assert passed == (verdict == "holds"), step["name"]
            if result["status"] == "failed":
                assert verdict in result["error_message"]
                assert "Traceback" not in result["error_message"]


def test_a_broken_manifest_is_explained(tmp_path: Path) -> None:
    (tmp_path / MANIFEST).write_text("{")
    done = agent(tmp_path)
    error, end = messages(done.stdout)
    assert done.returncode == 2
    assert isinstance(error, LogLine)
    assert "cannot be read" in error.text
    assert end == RunFinished(False)
    assert "Traceback" not in done.stderr


def test_an_agent_without_features_says_that_it_cannot_work(tmp_path: Path) -> None:
    (spec,) = write_run(tmp_path / "run", [Steps(STEPS)])
    (tmp_path / "run" / spec.feature).unlink()
    done = agent(tmp_path / "run")
    _, complaint, end = messages(done.stdout)
    assert done.returncode == 1
    assert isinstance(complaint, LogLine)
    assert "No feature files" in complaint.text
    assert end == RunFinished(False)
    assert "Traceback" not in done.stderr


def test_a_feature_that_is_no_gherkin_leaves_every_clause_unknown(tmp_path: Path) -> None:
    (spec,) = write_run(tmp_path / "run", [Steps(STEPS)])
    (tmp_path / "run" / spec.feature).write_text("Scenario: of no feature\n")
    done = agent(tmp_path / "run")
    found = messages(done.stdout)
    assert set(verdicts(found, spec, 0)) == {"unknown"}
    assert any(isinstance(message, LogLine) and message.level == "error" for message in found)
    assert "Traceback" not in done.stderr


def test_scenarios_that_moved_in_the_feature_are_not_mistaken(tmp_path: Path) -> None:
    (spec,) = write_run(tmp_path / "run", [Steps(STEPS)])
    feature = tmp_path / "run" / spec.feature
    feature.write_text("\n" + feature.read_text())
    found = messages(agent(tmp_path / "run").stdout)
    assert set(verdicts(found, spec, 0)) == {"unknown"}
    assert any(isinstance(message, LogLine) and "was the feature changed?" in message.text for message in found)


def test_an_agent_without_orders_finishes(tmp_path: Path) -> None:
    write_run(tmp_path, [Steps(STEPS)])
    found = messages(agent(tmp_path, orders=()).stdout)
    assert isinstance(found[0], RunStarted)
    assert found[1:] == [RunFinished(True)]


def test_nonsense_on_the_command_line_is_explained(tmp_path: Path) -> None:
    done = agent(tmp_path, "more")
    assert done.returncode == 2
    assert done.stderr.startswith("usage: ")


def test_a_scenario_is_executed_as_often_as_it_is_ordered(tmp_path: Path) -> None:
    (spec,) = write_run(tmp_path / "run", [Steps(STEPS[:1])])
    found = messages(agent(tmp_path / "run", orders=(0, 0)).stdout)
    judged = [message for message in found if isinstance(message, ClauseJudged)]
    assert [message.line for message in judged] == [spec.clauses[0].line] * 2
    assert judged[0] == judged[1]


def test_repetitions_share_the_scenario_of_their_feature(tmp_path: Path) -> None:
    """How far the cube is from the bin follows from the seed."""
    folder = tmp_path / "run"
    (spec,) = write_run(folder, [Steps((("then", f'"{CUBE}" is located at "{BIN_WS}" after event "t:end"'),))])
    write_manifest(folder, Manifest("t", 1, (spec, replace(spec, seed=2))))
    judged = [message for message in messages(agent(folder, orders=(1, 0)).stdout) if isinstance(message, ClauseJudged)]
    assert [message.index for message in judged] == [1, 0]
    assert judged[0].robustness != judged[1].robustness


def test_python_files_that_nobody_brought_are_not_run(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    (spec,) = write_run(folder, [Steps((("given", f'"{CUBE}" is located at "env:bench_ws" before event "t:end"'),))])
    stranger = f"open({str(tmp_path / 'ran')!r}, 'w')\n"
    for name in ("environment.py", "json.py", "numpy.py", "steps/other_steps.py", "steps/json.py"):
        (folder / "features" / name).write_text(stranger)
    (folder / "features" / "steps" / "model_steps.py").write_text("import json, numpy\n")
    found = messages(agent(folder).stdout)
    assert verdicts(found, spec, 0) == ["holds"]
    assert not (tmp_path / "ran").exists()


@pytest.mark.skipif(os.name == "nt", reason="Windows does not send these signals to a process")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_ends_it_without_a_traceback(tmp_path: Path, number: signal.Signals) -> None:
    write_run(tmp_path / "run", [Steps(STEPS, seed=seed) for seed in range(50)])
    command = [sys.executable, "-m", "robbdd_tools.agent", str(tmp_path / "run")]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=pipe, text=True) as process:
        assert process.stdin is not None
        process.stdin.writelines(encode(Execute(index)) + "\n" for index in range(50))
        process.stdin.flush()
        assert process.stdout is not None
        assert process.stderr is not None
        while not isinstance(decode(process.stdout.readline()), ClauseJudged):
            pass
        process.send_signal(number)
        rest = process.stdout.read()
        assert "Traceback" not in process.stderr.read()
    assert process.returncode == 128 + number
    assert not any(isinstance(message, RunFinished) for message in messages(rest))
