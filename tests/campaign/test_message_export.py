"""Cucumber Messages of a run: valid by the official schema, shown by the official formatter, equal for equal runs."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from campaign.study_agents import QuickAgent, write_study
from kit import ROOT
from robbdd_tools.cli import main
from robbdd_tools.run import scheduler

PACKAGES = ROOT / "client-vscode" / "node_modules" / "@cucumber"
NEEDED = pytest.mark.skipif(
    not (PACKAGES / "html-formatter").is_dir() or shutil.which("node") is None,
    reason="needs Node and the packages of client-vscode: npm ci",
)
FORMAT = """
import { readFileSync } from "node:fs";
import * as formatter from "@cucumber/html-formatter";
const Stream = formatter.CucumberHtmlStream ?? formatter.default;
const out = new Stream();
out.on("data", (part) => process.stdout.write(part));
for (const line of readFileSync(0, "utf8").trim().split("\\n")) out.write(JSON.parse(line));
out.end();
"""


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The messages of a run with two repetitions of four scenarios, some of which are violated."""
    monkeypatch.setattr(scheduler, "Agent", QuickAgent)
    monkeypatch.chdir(tmp_path)
    write_study(tmp_path)
    assert main(["run", "m.bdd", "--repeat", "2", "--seed", "7"]) == 1
    assert main(["export", "latest", "--messages", "-o", "run.ndjson"]) == 0
    return tmp_path / "run.ndjson"


def messages(path: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def of_kind(found: Sequence[dict[str, Any]], kind: str) -> list[Any]:
    return [one[kind] for one in found if kind in one]


def test_executions_are_test_cases_and_clauses_are_steps(run: Path) -> None:
    found = messages(run)
    assert list(found[0]) == ["meta"]
    assert list(found[-1]) == ["testRunFinished"]
    names = [one["name"] for one in of_kind(found, "pickle")]
    assert names == [f"t:bench-to-tray -- {n} (repetition {k})" for n in (1, 2, 3, 4) for k in (1, 2)]
    results = json.loads(next(Path(".robbdd/runs").glob("*/results.json")).read_text(encoding="utf-8"))
    verdicts = Counter(clause["verdict"] for one in results["scenarios"] for clause in one["clauses"])
    statuses = Counter(one["testStepResult"]["status"] for one in of_kind(found, "testStepFinished"))
    # Four steps of each execution set up the scene.
    assert statuses == {"PASSED": verdicts["holds"] + 8 * 4, "FAILED": verdicts["violated"]}
    assert verdicts["violated"] > 0
    assert of_kind(found, "testRunFinished")[0]["success"] is False


def test_each_execution_has_a_scenario_of_its_own_in_the_text(run: Path) -> None:
    found = messages(run)
    (source,) = of_kind(found, "source")
    lines = source["data"].split("\n")
    for pickle in of_kind(found, "pickle"):
        assert lines[pickle["location"]["line"] - 1].strip() == f"Scenario: {pickle['name']}"


def test_margins_and_reasons_are_attached_to_their_steps(run: Path) -> None:
    found = messages(run)
    failed = {
        (one["testCaseStartedId"], one["testStepId"]): one["testStepResult"]["message"]
        for one in of_kind(found, "testStepFinished")
        if one["testStepResult"]["status"] == "FAILED"
    }
    attached = {(one["testCaseStartedId"], one["testStepId"]): one["body"] for one in of_kind(found, "attachment")}
    assert failed
    for place, words in failed.items():
        match = re.fullmatch(r"violated by (−\d+ mm): it moved", words)
        assert match is not None
        assert attached[place] == f"margin {match[1]} at 1.00 s; it moved"


def test_times_are_those_of_the_run_and_the_bytes_are_the_same(run: Path) -> None:
    assert main(["export", "latest", "--messages", "-o", "again.ndjson"]) == 0
    assert Path("again.ndjson").read_bytes() == run.read_bytes()
    (started,) = of_kind(messages(run), "testRunStarted")
    assert started["timestamp"]["seconds"] > 1_700_000_000


def test_other_options_are_refused(run: Path, capsys: pytest.CaptureFixture[str]) -> None:
    del run
    assert main(["export", "latest", "--messages", "-o", "x.ndjson", "--scenario", "t:bench-to-tray -- 1"]) == 2
    assert "messages are of a whole run" in capsys.readouterr().err


@NEEDED
def test_the_official_schema_accepts_every_message(run: Path) -> None:
    schema = json.loads((PACKAGES / "messages" / "messages.schema.json").read_text(encoding="utf-8"))
    validator: Any = Draft202012Validator(schema)
    found = messages(run)
    assert [error.message for one in found for error in validator.iter_errors(one)] == []
    assert not validator.is_valid({"testRunStarted": {"timestamp": "now"}})


@NEEDED
def test_the_official_formatter_makes_its_report(run: Path) -> None:
    done = subprocess.run(
        ["node", "--input-type=module", "--eval", FORMAT],
        cwd=PACKAGES.parent.parent,
        input=run.read_text(encoding="utf-8"),
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("<!DOCTYPE html>")
    assert "t:bench-to-tray -- 4 (repetition 2)" in done.stdout
