"""The workflow of the host's continuous integration calls what this repository has."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Iterator
from typing import Any

import yaml

from kit import ROOT

WORKFLOW: dict[Any, Any] = yaml.safe_load((ROOT / ".github" / "workflows" / "ci.yml").read_text(encoding="utf-8"))
JOBS: dict[str, dict[str, Any]] = WORKFLOW["jobs"]
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def steps() -> Iterator[dict[str, Any]]:
    for job in JOBS.values():
        yield from job["steps"]


def commands(*jobs: str) -> list[str]:
    return [step["run"] for job in jobs for step in JOBS[job]["steps"] if "run" in step]


def recipe(target: str) -> list[str]:
    found = re.search(rf"^{target}:.*\n((?:\t.*\n)+)", MAKEFILE, re.MULTILINE)
    assert found is not None, target
    return [line.strip().removeprefix("$(BIN)/") for line in found[1].splitlines()]


def test_python_is_tested_on_three_systems_from_the_lowest_version_to_the_newest() -> None:
    matrix = JOBS["python"]["strategy"]["matrix"]
    assert {name.partition("-")[0] for name in matrix["os"]} == {"ubuntu", "windows", "macos"}
    assert matrix["python"] == [PROJECT["requires-python"].removeprefix(">="), "3.x"]
    assert JOBS["client"]["strategy"]["matrix"]["os"] == matrix["os"]


def test_it_runs_the_same_tests_as_make() -> None:
    assert set(recipe("test-python")) <= set(commands("python"))
    made = [part.replace(" --silent", "").strip() for part in recipe("test-client")[0].split("&&")[1:]]
    assert set(made) <= set(commands("client"))
    assert "make lint" in commands("lint")
    assert re.search(r"^test: lint test-client test-python$", MAKEFILE, re.MULTILINE)


def test_every_command_exists() -> None:
    scripts = json.loads((ROOT / "client-vscode" / "package.json").read_text(encoding="utf-8"))["scripts"]
    targets = set(re.findall(r"^([\w-]+):", MAKEFILE, re.MULTILINE))
    for command in commands(*JOBS):
        match command.split():
            case ["make", target]:
                assert target in targets
            case ["npm", "run", script]:
                assert script in scripts
            case ["robbdd" | "robbdd-lsp" as program, *_]:
                assert f"{program}.py" in PROJECT["scripts"]
            case [program, *_]:
                assert program in {"python", "pytest", "npm", "sudo"}, command
            case _:
                raise AssertionError(command)


def test_every_action_is_pinned_to_a_major_version() -> None:
    actions = [step["uses"] for step in steps() if "uses" in step]
    assert actions
    assert [action for action in actions if not re.fullmatch(r"[\w-]+/[\w-]+@v\d+", action)] == []


def test_only_windows_free_jobs_use_make() -> None:
    for name, job in JOBS.items():
        if any(command.startswith("make ") for command in commands(name)):
            assert job["runs-on"] == "ubuntu-latest", name


def test_the_job_may_only_read() -> None:
    assert WORKFLOW["permissions"] == {"contents": "read"}
