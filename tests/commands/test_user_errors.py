"""Errors in users' code on the command line: each once, with traceback, printed lines and the clauses' reason."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from commands.test_gherkin import robbdd
from kit import EXAMPLES

pytestmark = pytest.mark.physics


@pytest.fixture
def cell(tmp_path: Path) -> Path:
    return shutil.copytree(EXAMPLES / "ownrobot", tmp_path / "ownrobot")


def edit(path: Path, old: str, new: str) -> int:
    """Replace a text that is there once; returns its line, from 1."""
    text = path.read_text(encoding="utf-8")
    assert text.count(old) == 1
    path.write_text(text.replace(old, new), encoding="utf-8")
    return text[: text.index(old)].count("\n") + 1


def test_an_error_is_printed_once_with_its_traceback_and_what_was_printed_with_its_scenario(cell: Path) -> None:
    code = cell / "carrying.py"
    line = edit(code, 'arguments["workspace"]', 'arguments[print("looking") or "place"]')
    ran = robbdd("run", "tidy.bddx", "--json", "out.json", folder=cell)
    assert ran.returncode == 1, ran.stderr
    lines = ran.stdout.splitlines()
    begin = lines.index("error 1: carrying:Carry failed")
    assert lines[begin + 1 : begin + 4] == [
        f'  File "{code}", line {line}, in reset',
        '    place = arguments[print("looking") or "place"]',
        "KeyError: 'place'",
    ]
    assert ran.stdout.count("KeyError") == 1, "two scenarios of four clauses have one cause"
    assert lines.count("  │ looking") == lines.count("      no evidence, because of error 1") == 2
    report: Any = json.loads((cell / "out.json").read_text(encoding="utf-8"))
    broken = [one for one in report["scenarios"] if one["verdict"] == "unknown"]
    assert len(broken) == 2
    reasons = {clause["reason"] for one in broken for clause in one["clauses"]}
    assert len(reasons) == 1
    assert f"carrying:Carry failed: KeyError: 'place' ({code}:{line})" in reasons.pop()


def test_an_error_of_the_users_steps_leads_to_the_file_that_the_user_edits(tmp_path: Path) -> None:
    folder = shutil.copytree(EXAMPLES / "sorting", tmp_path / "sorting")
    steps = folder / "steps" / "sorting_steps.py"
    steps.parent.mkdir()
    sentence = "@then('{thing} is fine after event {event}')"
    text = f"from behave import then\n{sentence}\ndef fine(context, thing, event):\n    return 1 / 0\n"
    steps.write_text(text, encoding="utf-8")
    edit(
        folder / "sorting.bdd",
        "in-its-bin: holds(<part> is located at <bin>, after <evt-end>)",
        "'it is fine' after <evt-end>",
    )
    ran = robbdd("run", "sorting.bdd", "--first", "1", folder=folder)
    assert f'  File "{steps}", line 4, in fine' in ran.stdout, ran.stdout + ran.stderr
    assert ran.stdout.count("ZeroDivisionError") == 1


def test_steps_that_cannot_be_loaded_end_the_run_with_their_traceback(tmp_path: Path) -> None:
    folder = shutil.copytree(EXAMPLES / "sorting", tmp_path / "sorting")
    steps = folder / "steps" / "sorting_steps.py"
    steps.parent.mkdir()
    steps.write_text("print('loading')\nimport no_such_module\n", encoding="utf-8")
    ran = robbdd("run", "sorting.bdd", folder=folder)
    assert ran.returncode == 1
    assert ran.stdout.count(f'  File "{steps}", line 2, in <module>') == 1
    assert ran.stdout.count("  │ loading") == 1
    assert (
        f"the steps cannot be loaded: ModuleNotFoundError: No module named 'no_such_module' ({steps}:2)" in ran.stdout
    )


def test_a_policy_that_fails_on_stored_traces_is_reported_by_judge(tmp_path: Path) -> None:
    folder = shutil.copytree(EXAMPLES / "pickplace", tmp_path / "pickplace")
    robbdd("run", "pickplace.bddx", "--where", "thing = cube0", "--first", "1", folder=folder)
    (code,) = folder.glob("*.py")
    edit(code, "CLEARANCE = 0.1\n", "CLEARANCE = 0.1\ndel np\n")
    ran = robbdd("judge", "latest", "pickplace.bddx", folder=folder)
    assert ran.stdout.count(f'  File "{code}", line ') == 1, ran.stdout + ran.stderr
    assert ran.stdout.count("NameError") == 1
