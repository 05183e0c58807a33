"""Errors in users' code on the command line: each once, with traceback, printed lines and the clauses' reason."""

from __future__ import annotations

import json
import shutil
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

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
    # The same if it ends the judging process.
    code.write_text(code.read_text(encoding="utf-8").replace("del np\n", "import os\n"), encoding="utf-8")
    line = edit(code, "CLEARANCE = 0.1\nimport os\n", "CLEARANCE = 0.1\nimport os\nos._exit(7)\n") + 2
    ran = robbdd("judge", "latest", "pickplace.bddx", folder=folder)
    assert ran.returncode == 2
    assert f'  File "{code}", line {line}, in <module>\n    os._exit(7)\nthe process ended with code 7\n' in ran.stdout


WAYS = {
    "segfault": ("__import__('ctypes').string_at(0)", "the process ended with signal SIGSEGV"),
    "exit": ("__import__('os')._exit(3)", "the process ended with code 3"),
    "hang": ("[0 for _ in iter(int, 1)]", "timed out after 3 s"),
}


@pytest.mark.skipif(sys.platform == "win32", reason="Windows names no signals")
@pytest.mark.parametrize("way", list(WAYS))
def test_code_that_ends_its_process_or_never_returns_is_reported_at_its_line(cell: Path, way: str) -> None:
    expression, words = WAYS[way]
    code = cell / "carrying.py"
    line = edit(code, 'arguments["workspace"]', f'print("here") or {expression}')
    ran = robbdd("run", "tidy.bddx", "--jobs", "1", "--timeout", "3", "--junit", "out.xml", folder=cell)
    assert ran.returncode == 1, ran.stderr
    lines = ran.stdout.splitlines()
    begin = lines.index("error 1: carrying:Carry failed")
    end = lines.index(words)
    assert f'  File "{code}", line {line}, in reset' in lines[begin:end]
    assert f'    place = print("here") or {expression}' in lines[begin:end]
    assert lines.count(words) == 1, "two scenarios have one cause"
    assert lines.count("      no evidence, because of error 1") == lines.count("  │ here") == 2
    assert "error 2" not in ran.stdout
    suite = ElementTree.parse(cell / "out.xml").getroot()[0]
    errors = [case.find("error") for case in suite if case.find("error") is not None]
    assert len(errors) == 2
    for error in errors:
        assert error is not None
        assert error.text is not None
        assert f'  File "{code}", line {line}, in reset' in error.text
        assert words in error.text
    printed = [case.findtext("system-out") or "" for case in suite if case.find("error") is not None]
    assert all("\n│ here" in text for text in printed)
    logs = cell / ".robbdd" / "runs" / "1" / "logs"
    assert [path.suffix for path in logs.iterdir() if path.suffix != ".log"] == []


@pytest.mark.skipif(sys.platform == "win32", reason="Windows names no signals")
def test_code_whose_process_is_killed_is_named_with_its_definition(cell: Path) -> None:
    """As the system does where memory runs out: no handler sees it."""
    code = cell / "carrying.py"
    edit(code, 'arguments["workspace"]', "__import__('os').kill(__import__('os').getpid(), 9)")
    text = code.read_text(encoding="utf-8")
    line = text[: text.index("def reset")].count("\n") + 1
    ran = robbdd("run", "tidy.bddx", "--jobs", "1", folder=cell)
    assert ran.returncode == 1
    assert "error 1: carrying:Carry failed\n" in ran.stdout
    assert f'  File "{code}", line {line}\n' in ran.stdout
    assert "the process ended with signal SIGKILL (often: memory ran out)\n" in ran.stdout


@pytest.mark.skipif(sys.platform == "win32", reason="Windows names no signals")
def test_a_step_that_ends_its_process_leads_to_the_file_that_the_user_edits(tmp_path: Path) -> None:
    folder = shutil.copytree(EXAMPLES / "pickplace", tmp_path / "pickplace")
    steps = folder / "steps" / "pickplace_steps.py"
    steps.parent.mkdir()
    sentence = '@when(\'"{agent}" picks "env:ball0" and places it at "{workspace}"\')'
    text = f"import os\nfrom behave import when\n{sentence}\ndef leave(context, agent, workspace):\n    os._exit(5)\n"
    steps.write_text(text, encoding="utf-8")
    ran = robbdd("run", "pickplace.bdd", "--where", "goal = left_ws", folder=folder)
    assert ran.returncode == 1
    assert "error 1: pickplace_steps:leave failed\n" in ran.stdout, ran.stdout
    assert f'  File "{steps}", line 5, in leave\n    os._exit(5)\n' in ran.stdout
    assert "2 scenarios: 1 hold, 0 violated, 1 unknown" in ran.stdout


@pytest.mark.skipif(sys.platform == "win32", reason="Windows names no signals")
def test_steps_that_end_their_process_while_they_are_loaded_are_reported_at_their_line(tmp_path: Path) -> None:
    folder = shutil.copytree(EXAMPLES / "pickplace", tmp_path / "pickplace")
    steps = folder / "steps" / "pickplace_steps.py"
    steps.parent.mkdir()
    steps.write_text("import os\nos._exit(6)\n", encoding="utf-8")
    ran = robbdd("run", "pickplace.bdd", "--jobs", "1", "--junit", "out.xml", folder=folder)
    assert ran.returncode == 1
    assert f'  File "{steps}", line 2, in <module>\n    os._exit(6)\nthe process ended with code 6\n' in ran.stdout
    assert f"failed: the process ended with code 6 ({steps}:2)" in ran.stdout
    assert ran.stdout.count("the process ended with code 6\n") == 1
    errors = ["".join(error.itertext()) for error in ElementTree.parse(folder / "out.xml").iter("error")]
    assert len(errors) == 4
    assert all(f'File "{steps}", line 2, in <module>' in error for error in errors)
