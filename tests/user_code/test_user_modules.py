"""Search path of users' modules: after Python's library and ours, never replacing others."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from robbdd_tools.base.isolation import INHERITED, NO_USER_CODE, UNTRUSTED

SCRIPT = """
import sys
from robbdd_tools.user_code.calls import UserCodeError, load_attribute
before = list(sys.path)
for name in {names!r}:
    try:
        print(load_attribute(name, {model!r})())
    except UserCodeError as error:
        print(error)
print(sys.path[:len(before)] == before, *sys.path[len(before):])
"""


def load(folder: Path, *names: str, **environment: str) -> list[str]:
    script = SCRIPT.format(names=names, model=str(folder / "model.bddx"))
    command = [sys.executable, "-P", "-c", script]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=folder, env=environment)
    return done.stdout.splitlines()


def write(path: Path, answer: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"def answer():\n    return {answer!r}\n", encoding="utf-8")


def test_modules_beside_the_model_are_found_after_all_others(tmp_path: Path) -> None:
    write(tmp_path / "mine.py", "mine")
    assert load(tmp_path, "mine:answer") == ["mine", f"True {tmp_path}"]


def test_a_module_with_the_name_of_another_is_refused_by_its_path(tmp_path: Path) -> None:
    write(tmp_path / "calendar.py", "mine")
    write(tmp_path / "numpy" / "__init__.py", "mine")
    write(tmp_path / "json" / "__init__.py", "mine")
    standard, library, package, _ = load(tmp_path, "calendar:answer", "numpy:answer", "json.tool:answer")
    reason = "Python's standard library has a module 'calendar', too; rename the file and its uses"
    assert standard == f"{tmp_path / 'calendar.py'} is not imported: {reason}"
    assert library.startswith(f"{tmp_path / 'numpy' / '__init__.py'} is not imported: ")
    assert "site-packages" in library
    assert package.startswith(f"{tmp_path / 'json' / '__init__.py'} is not imported: Python's standard library")


def test_folders_of_the_environment_come_last_and_relative_ones_never(tmp_path: Path) -> None:
    write(tmp_path / "ros" / "rclpy_like.py", "from ros")
    write(tmp_path / "ros" / "calendar.py", "from ros")
    write(tmp_path / "ros" / "mine.py", "from ros")
    write(tmp_path / "model" / "mine.py", "mine")
    ros = str(tmp_path / "ros")
    found = load(tmp_path / "model", "rclpy_like:answer", "mine:answer", **{INHERITED: f":.:{ros}"})
    assert found == ["from ros", "mine", f"True {tmp_path / 'model'} {ros}"]


def test_an_agent_that_must_not_run_code_of_users_imports_none(tmp_path: Path) -> None:
    write(tmp_path / "mine.py", "mine")
    for value, why in (("1", "--no-user-code was given"), (UNTRUSTED, "the workspace is not trusted")):
        found = load(tmp_path, "mine:answer", **{NO_USER_CODE: value})
        assert found == [f"users' code is not run: {why}", "True"]


def test_an_edit_within_a_second_is_executed(tmp_path: Path) -> None:
    write(tmp_path / "mine.py", "one")
    changed = (tmp_path / "mine.py").stat().st_mtime
    assert load(tmp_path, "mine:answer")[0] == "one"
    write(tmp_path / "mine.py", "two")
    os.utime(tmp_path / "mine.py", (changed, changed))
    assert load(tmp_path, "mine:answer")[0] == "two"
    assert [path.name for path in tmp_path.iterdir()] == ["mine.py"]
