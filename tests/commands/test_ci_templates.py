"""What others copy into their continuous integration: its commands are executed as the hosts would do."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from fork_kit import ROBBDD
from kit import DOCS, EXAMPLES, ROOT
from robbdd_tools.syntax.parse import LANGUAGES

pytestmark = [
    pytest.mark.physics,
    pytest.mark.skipif(os.name == "nt", reason="the commands are those of a POSIX shell"),
]
PAGE = (DOCS / "continuous-integration.md").read_text(encoding="utf-8")
BLOCKS: list[tuple[str, str]] = re.findall(r"^```(\w*)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
ACTION: dict[str, Any] = yaml.safe_load((ROOT / ".github/actions/robbdd/action.yml").read_text(encoding="utf-8"))
GITLAB: dict[str, Any] = yaml.safe_load((DOCS / "ci" / "gitlab.yml").read_text(encoding="utf-8"))
HOOKS: list[dict[str, Any]] = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text(encoding="utf-8"))
CONTAINERFILE = (DOCS / "ci" / "Containerfile").read_text(encoding="utf-8")
EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
INPUTS = {name: str(one["default"]) for name, one in ACTION["inputs"].items()}
INSTALLERS = ("python", "sudo", "apt-get", "uvx", "pipx", "podman")
GOAL = "at-goal: holds(<thing> is located at <goal>, after <evt-place-end>)"
TOO_EARLY = GOAL.replace("after <evt-place-end>", "before <evt-pick-start>")

Shell = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def shell(tmp_path: Path) -> Shell:
    """Run commands in a folder with one scenario, which holds; installers only note their arguments."""
    programs = tmp_path / "programs"
    cell = tmp_path / "cell"
    (cell / "models").mkdir(parents=True)
    programs.mkdir()
    model = (EXAMPLES / "pickplace" / "pickplace.bdd").read_text(encoding="utf-8")
    for several, one in ((", <balls.ball0> }", " }"), (", <places.right_ws> }", " }")):
        assert several in model
        model = model.replace(several, one)
    (cell / "models" / "pickplace.bdd").write_text(model, encoding="utf-8")
    shutil.copy(EXAMPLES / "pickplace" / "bench.scene", cell / "models")
    note = f'echo "$(basename "$0") $*" >> {shlex.quote(str(tmp_path / "installed"))}'
    for name, body in (("robbdd", f'exec {shlex.join(ROBBDD)} "$@"'), *((name, note) for name in INSTALLERS)):
        (programs / name).write_text(f"#!/bin/sh\n{body}\n", encoding="utf-8")
        (programs / name).chmod(0o755)
    path = f"{programs}{os.pathsep}{os.environ['PATH']}"

    def run(script: str, **variables: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", script],
            cwd=cell,
            env={**os.environ, "PATH": path, **variables},
            capture_output=True,
            encoding="utf-8",
        )

    return run


class Host:
    """Executes the steps of the action: expressions, conditions, outputs and the summary as GitHub documents them."""

    def __init__(self, shell: Shell, folder: Path, inputs: dict[str, str]) -> None:
        assert inputs.keys() <= INPUTS.keys()
        self.values = {f"inputs.{name}": value for name, value in {**INPUTS, **inputs}.items()}
        self.values["runner.os"] = "Linux"
        self.output, self.summary = folder / "output", folder / "summary.md"
        self.output.write_text("", encoding="utf-8")
        self.summary.write_text("", encoding="utf-8")
        self.used: list[str] = []
        self.failed = ""
        for step in ACTION["runs"]["steps"]:
            self._step(shell, step)

    def _holds(self, condition: str) -> bool:
        code = re.sub(r"[a-z]+(?:\.[\w-]+)+", lambda found: repr(self.values[found[0]]), condition)
        return bool(eval(code.replace("||", " or ").replace("&&", " and "), {"always": lambda: True}))

    def _filled(self, text: str) -> str:
        return re.sub(r"\$\{\{ ([\w.-]+) \}\}", lambda found: self.values[found[1]], text)

    def _step(self, shell: Shell, step: dict[str, Any]) -> None:
        condition = step.get("if", "true == true").replace("true == true", "True")
        if (self.failed and "always()" not in condition) or not self._holds(condition):
            return
        if "uses" in step:
            self.used.append(step["uses"])
            return
        variables = {name: self._filled(value) for name, value in step.get("env", {}).items()}
        known = {"GITHUB_OUTPUT": str(self.output), "GITHUB_STEP_SUMMARY": str(self.summary)}
        done = shell(step["run"], **known, **variables, GITHUB_ACTION_PATH=str(ROOT / ".github/actions/robbdd"))
        assert "Traceback" not in done.stderr
        for line in self.output.read_text(encoding="utf-8").splitlines():
            name, _, value = line.partition("=")
            self.values[f"steps.{step.get('id', 'run')}.outputs.{name}"] = value
        if done.returncode:
            self.failed = step["name"]


def violate(cell: Path) -> None:
    model = cell / "models" / "pickplace.bdd"
    text = model.read_text(encoding="utf-8")
    assert GOAL in text
    model.write_text(text.replace(GOAL, TOO_EARLY), encoding="utf-8")


def release(shell: Shell) -> None:
    assert shell("robbdd run models --json release.json").returncode == 0


def test_the_action_passes_a_cell_that_holds_and_keeps_its_results(shell: Shell, tmp_path: Path) -> None:
    host = Host(shell, tmp_path, {"models": "models"})
    assert host.failed == ""
    summary = host.summary.read_text(encoding="utf-8")
    assert summary.startswith("## ✅ models: run 1\n\n**1 of 1 executions hold**")
    assert {path.name for path in (tmp_path / "cell" / "robbdd-results").iterdir()} == {
        "junit.xml",
        "results.json",
        "run.txt",
        "summary.md",
    }
    assert [name.partition("@")[0] for name in host.used] == ["actions/setup-python", "actions/upload-artifact"]
    noted = (tmp_path / "installed").read_text(encoding="utf-8").splitlines()
    source = noted[-1].removeprefix("python -m pip install ")
    assert Path(source.removesuffix("[statistics]")).resolve() == ROOT
    assert "statistics" in EXTRAS


def test_the_action_fails_at_a_violated_clause_after_its_results_are_kept(shell: Shell, tmp_path: Path) -> None:
    violate(tmp_path / "cell")
    host = Host(shell, tmp_path, {"models": "models"})
    assert (host.failed, len(host.used)) == ("Judge", 2)
    summary = host.summary.read_text(encoding="utf-8")
    assert "1 violated" in summary
    assert "✗ at-goal | −" in summary


def test_the_action_compares_with_a_baseline(shell: Shell, tmp_path: Path) -> None:
    release(shell)
    inputs = {"models": "models", "baseline": "release.json"}
    host = Host(shell, tmp_path, inputs)
    assert host.failed == ""
    assert "**identical: every verdict and every margin is the same**" in host.summary.read_text(encoding="utf-8")
    violate(tmp_path / "cell")
    host = Host(shell, tmp_path, {**inputs, "gate-only": "true"})
    assert (host.failed, len(host.used)) == ("Compare", 2)
    assert "| at-goal |" in host.summary.read_text(encoding="utf-8")
    assert Host(shell, tmp_path, {**inputs, "baseline": "missing.json"}).failed == "Compare"


def test_violations_pass_only_if_the_gate_alone_decides(shell: Shell, tmp_path: Path) -> None:
    violate(tmp_path / "cell")
    assert shell("robbdd run models --json release.json").returncode == 1
    inputs = {"models": "models", "baseline": "release.json"}
    assert Host(shell, tmp_path, inputs).failed == "Judge"
    assert Host(shell, tmp_path, {**inputs, "gate-only": "true"}).failed == ""
    assert Host(shell, tmp_path, {"models": "models", "gate-only": "true"}).failed == "Judge"


def test_the_action_judges_nothing_where_the_models_have_errors(shell: Shell, tmp_path: Path) -> None:
    (tmp_path / "cell" / "models" / "broken.bdd").write_text("Task (ns=nowhere) fetch\n", encoding="utf-8")
    assert Host(shell, tmp_path, {"models": "models"}).failed == "Check"
    assert Host(shell, tmp_path, {"models": "$(touch planted)"}).failed == "Check"
    assert not (tmp_path / "cell" / "planted").exists()
    assert Host(shell, tmp_path, {"models": "models/bench.scene", "repeat": "none"}).failed == "Run"


def test_the_template_of_gitlab_passes_and_fails_as_the_action_does(shell: Shell, tmp_path: Path) -> None:
    job = GITLAB["robbdd"]
    script = "\n".join([*job["before_script"], *job["script"]])
    variables = {**GITLAB["variables"], "MODELS": "models"}
    done = shell(script, **variables)
    assert (done.returncode, done.stderr) == (0, "kept as run 1\n")
    results = tmp_path / "cell" / job["artifacts"]["paths"][0]
    assert (tmp_path / "cell" / job["artifacts"]["reports"]["junit"]).exists()
    shutil.copy(results / "results.json", tmp_path / "cell" / "release.json")
    variables["BASELINE"] = "release.json"
    assert shell(script, **variables).returncode == 0
    assert "**identical" in (results / "comparison.md").read_text(encoding="utf-8")
    violate(tmp_path / "cell")
    assert shell(script, **{**variables, "BASELINE": ""}).returncode == 1
    assert shell(script, **variables).returncode in (1, 3)
    assert shell(script, **{**variables, "MODELS": "missing"}).returncode == 2


def test_the_hooks_check_and_format_the_files_they_are_given(shell: Shell, tmp_path: Path) -> None:
    entries = {hook["id"]: hook["entry"] for hook in HOOKS}
    assert re.findall(r"- id: ([\w-]+)", PAGE) == list(entries)
    for hook in HOOKS:
        assert hook["language"] == "python"
        assert [name for name in LANGUAGES if not re.search(hook["files"], f"cell.{name}")] == []
        assert not re.search(hook["files"], "cell.bdd.txt")
    files = "models/pickplace.bdd models/bench.scene"
    model = tmp_path / "cell" / "models" / "pickplace.bdd"
    tidy = model.read_text(encoding="utf-8")
    model.write_text(tidy.replace("    var thing\n", "  var   thing\n"), encoding="utf-8")
    assert shell(f"{entries['robbdd-check']} {files}").returncode == 0
    assert shell(f"{entries['robbdd-format']} {files}").returncode == 0
    assert model.read_text(encoding="utf-8") == tidy
    model.write_text(tidy.replace("<places.left_ws>", "<places.lost_ws>"), encoding="utf-8")
    assert shell(f"{entries['robbdd-check']} {files}").returncode == 1


def test_the_commands_of_the_page(shell: Shell, tmp_path: Path) -> None:
    commands = [line for kind, block in BLOCKS if not kind for line in block.splitlines()]
    assert len(commands) == 13
    (tmp_path / "cell" / "robbdd.toml").touch()  # the root of the project, as a repository's is: its runs are kept here
    for command in commands:
        done = shell(command.replace("--repeat 30", "--repeat 1"))
        assert done.returncode == 0, (command, done.stdout, done.stderr)
    noted = (tmp_path / "installed").read_text(encoding="utf-8").splitlines()
    assert {line.split()[0] for line in noted} == {"podman", "uvx", "pipx"}
    rows = dict(re.findall(r"^\| `([\w-]+)` \|(?: `([^`]*)`)? \|", PAGE, re.MULTILINE))
    assert rows == INPUTS
    assert all(f"`{name}`" in PAGE for name in GITLAB["variables"])
    given = yaml.safe_load(BLOCKS[0][1])[1]["with"]
    assert given.keys() <= INPUTS.keys()


def test_the_container_installs_this_checkout() -> None:
    lines = [line.split(maxsplit=1) for line in CONTAINERFILE.splitlines() if not line.startswith("#")]
    assert [line[0] for line in lines] == ["FROM", "RUN", "COPY", "RUN", "WORKDIR", "ENTRYPOINT"]
    assert lines[2][1] == ". /source"
    assert "'/source[statistics]'" in lines[3][1]
    assert lines[-1][1] == '["robbdd"]'
