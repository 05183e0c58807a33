"""Tests of pytest execute scenarios in simulation and report their verdicts."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path
from time import monotonic
from xml.etree import ElementTree

import pytest

import robbdd_tools as robbdd
from fork_kit import PYTEST, ROBBDD
from kit import DOCS, EXAMPLES

pytestmark = [pytest.mark.physics, pytest.mark.usefixtures("forked_processes")]
AFTER = "at-goal: holds(<thing> is located at <goal>, after <evt-place-end>)"
BEFORE = "at-goal: holds(<thing> is located at <goal>, before <evt-pick-start>)"
PREFIX = "pickplace.bdd::tidy-bench::part-to-bin"
CUBE_LEFT, CUBE_RIGHT, BALL_LEFT, BALL_RIGHT = (
    f"{PREFIX}[{thing}-panda-table_ws-{goal}]" for thing in ("cube0", "ball0") for goal in ("left_ws", "right_ws")
)  # fmt: skip
ALL = [CUBE_LEFT, CUBE_RIGHT, BALL_LEFT, BALL_RIGHT]
STEPS = """import os

from behave import when


@when('"{agent}" picks "env:cube0" and places it at "{workspace}"')
def fail(context, agent, workspace):
    print("about to fail")
    ACTION
"""

CONFTEST = """import pytest


def pytest_collection_modifyitems(items):
    items[0].add_marker(pytest.mark.skip(reason="no cube"))
    items[1].add_marker(pytest.mark.xfail(reason="known"))
"""


@pytest.fixture
def cell(tmp_path: Path) -> Path:
    """A project with the pick-and-place example without its executions."""
    for name in ("pickplace.bdd", "bench.scene"):
        shutil.copy(EXAMPLES / "pickplace" / name, tmp_path)
    (tmp_path / "pytest.ini").write_text("[pytest]\n", encoding="utf-8")
    return tmp_path


def run(cell: Path, *arguments: str) -> pytest.RunResult:
    """Run pytest in a separate process."""
    began = monotonic()
    command = [*PYTEST, "--robbdd", "-p", "no:asyncio", *arguments]
    done = subprocess.run(command, cwd=cell, capture_output=True, encoding="utf-8")
    assert "/_pytest/" not in done.stdout
    return pytest.RunResult(done.returncode, done.stdout.splitlines(), done.stderr.splitlines(), monotonic() - began)


def violated(cell: Path) -> None:
    """Ask for the part at its goal before it is picked."""
    path = cell / "pickplace.bdd"
    text = path.read_text(encoding="utf-8")
    assert AFTER in text
    path.write_text(text.replace(AFTER, BEFORE), encoding="utf-8")


def with_steps(cell: Path, action: str) -> None:
    """Let the user's own code carry the cube."""
    (cell / "steps").mkdir()
    (cell / "steps" / "pickplace_steps.py").write_text(STEPS.replace("ACTION", action), encoding="utf-8")


def line_of(cell: Path, text: str) -> int:
    lines = (cell / "pickplace.bdd").read_text(encoding="utf-8").splitlines()
    return next(number for number, line in enumerate(lines, start=1) if text in line)


def test_scenarios_that_hold_pass_and_are_kept_as_one_run(cell: Path) -> None:
    done = run(cell, "-v")
    done.assert_outcomes(passed=4)
    done.stdout.fnmatch_lines([f"{glob(name)} PASSED*" for name in ALL])
    done.stdout.fnmatch_lines(["4 scenarios: 4 hold, 0 violated, 0 unknown (seed 1); kept as run 1 in *"])
    (stored,) = robbdd.runs(cell)
    assert (stored.record.path, stored.status.state) == ("pickplace.bdd", "finished")
    assert robbdd.replay(stored, jobs=1).is_identical
    assert [path.name for path in (stored.folder / "logs").iterdir()] == ["agent-1.log"], "one process for all"


def glob(name: str) -> str:
    return name.replace("[", "[[]")


def test_a_violated_clause_fails_with_its_place_margin_and_trace(cell: Path) -> None:
    violated(cell)
    done = run(cell, "-v", "-k", "cube0 and left_ws")
    done.assert_outcomes(failed=1, deselected=3)
    text = done.stdout.str()
    assert f"{CUBE_LEFT} VIOLATED" in text
    (stored,) = robbdd.runs(cell)
    (clause,) = [clause for clause in stored.results[0].clauses if clause.name == "at-goal"]
    assert clause.margin is not None
    assert clause.at is not None
    assert f"    pickplace.bdd:{line_of(cell, BEFORE)}:13\n" in text
    assert f"    violated by −{abs(clause.margin) * 1000:.0f} mm at {clause.at:.2f} s\n" in text
    (trace,) = re.findall(r"^trace: (\S+) \(run 1\)$", text, re.MULTILINE)
    assert (cell / trace).read_bytes()[1:5] == b"MCAP"


def test_missing_evidence_is_an_error_and_not_a_failure(cell: Path) -> None:
    with_steps(cell, 'raise ValueError("no gripper")')
    done = run(cell, "-v", "--junitxml=out.xml")
    done.assert_outcomes(passed=2, errors=2)
    text = done.stdout.str()
    assert f"{CUBE_LEFT} UNKNOWN" in text
    assert "error in your code" in text
    assert 'pickplace_steps.py", line 9, in fail' in text
    assert "ValueError: no gripper" in text
    assert "about to fail" in text
    suite = ElementTree.parse(cell / "out.xml").getroot()[0]
    assert (suite.get("errors"), suite.get("failures")) == ("2", "0")


def test_junit_has_failures_margins_and_seeds(cell: Path) -> None:
    violated(cell)
    run(cell, "--junitxml=out.xml", "--robbdd-first=1")
    (case,) = ElementTree.parse(cell / "out.xml").getroot().iter("testcase")
    (stored,) = robbdd.runs(cell)
    (result,) = stored.results
    found = {entry.get("name"): entry.get("value") for entry in case.iter("property")}
    assert found["robbdd_verdict"] == "violated"
    assert found["seed"] == str(result.seed)
    (clause,) = [clause for clause in result.clauses if clause.name == "at-goal"]
    assert found["margin at-goal (m)"] == str(clause.margin)
    (failed,) = case.iter("failure")
    assert (failed.get("message") or "").startswith("at-goal violated by −")


def test_the_first_failure_ends_the_session_and_the_run_can_be_resumed(cell: Path) -> None:
    violated(cell)
    done = run(cell, "-x")
    done.assert_outcomes(failed=1)
    (stored,) = robbdd.runs(cell)
    assert (stored.status.state, stored.status.finished, stored.status.total) == ("interrupted", 1, 4)
    assert stored.results[3].clauses[0].reason == "pytest ended before it was executed"
    done.stdout.fnmatch_lines(["resume the run with: robbdd run --resume 1"])
    command = [*ROBBDD, "run", "--resume", "1"]
    assert subprocess.run(command, cwd=cell, capture_output=True).returncode == 1
    assert robbdd.find_run("1", cell).status.state == "finished"


def test_only_what_failed_is_executed_again(cell: Path) -> None:
    with_steps(cell, 'raise ValueError("no gripper")')
    run(cell).assert_outcomes(passed=2, errors=2)
    (cell / "steps" / "pickplace_steps.py").unlink()
    run(cell, "--lf").assert_outcomes(passed=2)
    _, again = robbdd.runs(cell)
    assert [result.values["crit:var-thing"] for result in again.results] == ["env:cube0"] * 2


def test_workers_of_xdist_record_one_run(cell: Path) -> None:
    violated(cell)
    run(cell, "-n", "2", "-v").assert_outcomes(failed=4)
    run(cell).assert_outcomes(failed=4)
    by_workers, alone = robbdd.runs(cell)
    assert by_workers.status.state == "finished"
    assert by_workers.record.simulator == alone.record.simulator != ""
    assert by_workers.results == alone.results
    assert (by_workers.status.jobs, alone.status.jobs) == (2, 1)
    assert robbdd.replay(by_workers, jobs=1).is_identical


def test_a_worker_that_dies_loses_no_result_of_others(cell: Path) -> None:
    (cell / "test_crash.py").write_text("import os\n\n\ndef test_crash():\n    os._exit(3)\n", encoding="utf-8")
    done = run(cell, "-n", "2", "pickplace.bdd", "test_crash.py")
    done.assert_outcomes(passed=4, failed=1)
    (stored,) = robbdd.runs(cell)
    assert stored.status.counts == {"holds": 4}


def test_an_agent_that_dies_leaves_its_scenario_unknown_and_is_replaced(cell: Path) -> None:
    with_steps(cell, "os._exit(7)")
    done = run(cell)
    done.assert_outcomes(passed=2, errors=2)
    done.stdout.fnmatch_lines(
        ["*unknown: pickplace_steps:fail failed: the process ended with code 7*", "about to fail"]
    )
    (stored,) = robbdd.runs(cell)
    assert len(list((stored.folder / "logs").iterdir())) == 3


def test_marks_of_a_conftest_skip_and_expect_failures(cell: Path) -> None:
    violated(cell)
    (cell / "conftest.py").write_text(CONFTEST, encoding="utf-8")
    run(cell, "--robbdd-first=2").assert_outcomes(skipped=1, xfailed=1)
    (stored,) = robbdd.runs(cell)
    assert [result.duration is None for result in stored.results] == [True, False]


def test_nothing_is_kept_when_it_is_not_wanted(cell: Path) -> None:
    violated(cell)
    done = run(cell, "--robbdd-no-store", "--robbdd-first=1")
    done.assert_outcomes(failed=1)
    done.stdout.fnmatch_lines(["trace: not kept, because the run is not kept", "1 scenario: *; not kept"])
    assert not (cell / ".robbdd").exists()


def test_a_run_that_cannot_begin_is_an_error_of_each_test(cell: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with_steps(cell, "pass")
    monkeypatch.setenv("ROBBDD_NO_USER_CODE", "1")
    done = run(cell, "--robbdd-first=2")
    done.assert_outcomes(errors=2)
    done.stdout.fnmatch_lines(["*pickplace_steps.py contains user-defined steps: *"])
    assert robbdd.runs(cell) == ()


def unnumbered(text: str) -> str:
    """Return a text without numbers: physics decides margins, and the page shows those of one version."""
    return re.sub(r"\d+(?:\.\d+)?", "N", text)


def test_the_page_shows_what_pytest_prints(cell: Path) -> None:
    page = unnumbered((DOCS / "pytest.md").read_text(encoding="utf-8"))
    passing, failing = re.findall(r"```text\n(.*?)```", page, flags=re.DOTALL)
    printed = unnumbered(run(cell, "-v").stdout.str())
    assert [line for line in passing.splitlines() if line not in printed] == []
    violated(cell)
    assert failing in unnumbered(run(cell, "-k", "cube0 and left_ws").stdout.str())
