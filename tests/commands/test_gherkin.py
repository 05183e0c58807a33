"""``robbdd gherkin`` and ``robbdd steps`` as scripts use them."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from fork_kit import ROBBDD
from kit import EXAMPLES, MODEL, SCENE
from robbdd_tools.protocol.manifest_file import read_manifest

PICKPLACE = EXAMPLES / "pickplace" / "pickplace.bdd"
ENTRY = "    obj set <cubes>"


def robbdd(*arguments: str | Path, folder: Path) -> subprocess.CompletedProcess[str]:
    command = [*ROBBDD, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", cwd=folder)
    assert "Traceback" not in done.stderr
    return done


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "main.bdd").write_text(MODEL, encoding="utf-8")
    (tmp_path / "lab.scene").write_text(SCENE, encoding="utf-8")
    return tmp_path


def test_a_folder_has_all_that_behave_needs_and_points_nowhere_else(folder: Path) -> None:
    done = robbdd("gherkin", folder / "main.bdd", "-o", "out", folder=folder)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == f"{Path('out', 'features', 'fetching.feature')}\n"
    files = sorted(path for path in (folder / "out").rglob("*") if path.is_file())
    assert [str(path.relative_to(folder / "out").as_posix()) for path in files] == [
        "behave.ini",
        "features/environment.py",
        "features/fetching.feature",
        "features/fetching.feature.map.json",
        "features/steps/catalog_steps.py",
        "main.jsonld",
        "manifest.json",
    ]
    for path in files:
        text = path.read_text(encoding="utf-8")
        assert str(folder) not in text
        assert "file:" not in text
        assert "../" not in text
    assert len(read_manifest(folder / "out").scenarios) == 4


@pytest.mark.parametrize(
    ("arguments", "numbers", "said"),
    [
        (["--where", "part=nut and goal=~tray.*"], [4], ""),
        (["--first", "3"], [1, 2, 3], ""),
        (["--sample", "4"], [1, 2, 3, 4], ""),
        (["--pairwise"], [1, 2, 3, 4], "t:bench-to-tray: 4 scenarios with 8 of 8 combinations\n"),
        (
            ["--pairwise", "3", "--where", "part=bolt"],
            [1, 2],
            "t:bench-to-tray: 2 scenarios with 2 of 2 combinations\n",
        ),
    ],
)
def test_scenarios_are_selected(folder: Path, arguments: list[str], numbers: list[int], said: str) -> None:
    done = robbdd("gherkin", "main.bdd", "-o", "out", *arguments, folder=folder)
    assert (done.returncode, done.stderr) == (0, said)
    assert [scenario.variation for scenario in read_manifest(folder / "out").scenarios] == numbers


@pytest.mark.parametrize("command", ["gherkin", "run"])
@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--where", "part=nut or"], "--where, column 12: expected a variable instead of the end"),
        (["--where", "art=nut"], "--where, column 1: unknown variable 'art'; known variables: part, robot, goal"),
        (["--where", "part=none"], "robbdd: no scenario fits the selection"),
        (["--seed", "9" * 30], "is not a whole number from -9223372036854775807 to 9223372036854775807"),
        (["--seed", "9" * 5000], "is not a whole number from"),
        (["--seed", "1.5"], "'1.5' is not a whole number from"),
        (["--first", "0"], "'0' is not a number above 0"),
        (["--sample", "many"], "'many' is not a number above 0"),
        (["--pairwise", "4"], "invalid choice: 4"),
        (["--first", "1", "--sample", "1"], "not allowed with argument"),
    ],
)
def test_a_selection_that_cannot_be_made_ends_with_2(
    folder: Path, command: str, arguments: list[str], words: str
) -> None:
    done = robbdd(command, "main.bdd", "-o", "out", *arguments, folder=folder)
    assert done.returncode == 2
    assert words in done.stderr


def test_an_own_template_is_used_and_its_error_shown_at_its_line(folder: Path) -> None:
    own = folder / "own.feature.jinja"
    own.write_text("{% extends 'default.feature.jinja' %}{% block feature %}# own\n{{ super() }}{% endblock %}")
    assert robbdd("gherkin", "main.bdd", "-o", "out", "--template", own.name, folder=folder).returncode == 0
    assert (
        (folder / "out" / "features" / "fetching.feature")
        .read_text(encoding="utf-8")
        .startswith("# own\n# wording: 2\n@story=")
    )
    own.write_text("{% block scenario %}\n\n{{ scenario.colour }}{% endblock %}")
    done = robbdd("gherkin", "main.bdd", "-o", "out", "--template", own.name, folder=folder)
    assert done.returncode == 2
    assert done.stderr.startswith("robbdd: own.feature.jinja:3: ")
    assert "has no attribute 'colour'" in done.stderr


def test_a_template_that_makes_no_gherkin_is_told_so(folder: Path) -> None:
    own = folder / "own.feature.jinja"
    scenario = "{% block scenario %}  Scenario: {{ scenario.name }}\n    Then it works\n    nonsense\n{% endblock %}"
    own.write_text("{% block feature %}Feature: f\n{% endblock %}" + scenario)
    done = robbdd("gherkin", "main.bdd", "-o", "out", "--template", own.name, folder=folder)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("robbdd: own.feature.jinja: its output is not Gherkin: ")
    assert str(Path("out", "features", "fetching.feature")) in done.stderr


@pytest.mark.physics
def test_columns_of_properties_change_neither_the_manifest_nor_the_verdicts(tmp_path: Path) -> None:
    scene = PICKPLACE.with_name("bench.scene").read_text(encoding="utf-8")
    assert ENTRY in scene
    shown: dict[str, Any] = {}
    for name, chosen in (("plain", ENTRY), ("shown", f"{ENTRY} with mass")):
        folder = tmp_path / name
        folder.mkdir()
        stated = scene.replace("count: 2 }", "count: 2  mass: 50 g }").replace(ENTRY, chosen)
        (folder / "bench.scene").write_text(stated, encoding="utf-8")
        shutil.copy(PICKPLACE, folder / "m.bdd")
        assert robbdd("gherkin", "m.bdd", "-o", "out", "--first", "1", folder=folder).returncode == 0
        shown[name] = json.loads((folder / "out" / "manifest.json").read_text(encoding="utf-8"))
    assert shown["plain"] == shown["shown"]
    (feature,) = (tmp_path / "shown" / "out" / "features").glob("*.feature")
    text = feature.read_text(encoding="utf-8")
    # A person adds a column of their own.
    edited = re.sub(r"(?m)^( +\| env:\S+ \| .*\|)$", r"\1 A3 |", text).replace(" mass |", " mass | shelf |")
    assert "| 50 g | A3 |" in edited
    command = [sys.executable, "-m", "behave", "--no-color", str(feature)]
    printed: list[str] = []
    for written in (text, edited):
        feature.write_text(written, encoding="utf-8")
        done = subprocess.run(
            command, capture_output=True, text=True, encoding="utf-8", cwd=feature.parent.parent, check=False
        )
        printed.append(done.stdout + done.stderr)
    assert "1 scenario passed" in printed[0]
    assert "1 scenario passed" in printed[1]


def test_steps_are_printed_or_added_to_a_file(folder: Path) -> None:
    printed = robbdd("steps", "main.bdd", folder=folder)
    first = robbdd("steps", "main.bdd", "-o", "steps/own.py", folder=folder)
    assert (printed.returncode, first.returncode) == (0, 0)
    assert printed.stdout == (folder / "steps" / "own.py").read_text(encoding="utf-8")
    again = robbdd("steps", "main.bdd", "-o", "steps/own.py", folder=folder)
    assert again.stdout == f"{Path('steps', 'own.py')}: 0 new steps, 8 already defined\n"
    (folder / "steps" / "own.py").write_text("\ndef (:\n", encoding="utf-8")
    broken = robbdd("steps", "main.bdd", "-o", "steps/own.py", folder=folder)
    assert broken.returncode == 2
    assert broken.stderr.startswith(f"robbdd: {Path('steps', 'own.py')}:2: ")


@pytest.mark.physics
def test_plain_behave_gives_the_verdicts_of_a_run(tmp_path: Path) -> None:
    shutil.copy(PICKPLACE.with_name("bench.scene"), tmp_path)
    text = PICKPLACE.read_text(encoding="utf-8").replace("<cubes.cube0>, <balls.ball0>", "<cubes.cube0>")
    # One clause that holds, one that is violated, groups, and a text without a judge.
    text = text.replace(
        "        (\n            in-hand:",
        """        (
            (wrong: holds(<thing> is located at <goal>, before <evt-pick-start>)
                or (not right: holds(<thing> is located at <source>, before <evt-pick-start>)))
            and
            (not false: holds(<thing> is located at <goal>, before <evt-pick-start>))
            and
            'the lamp is green' after <evt-end>
            and
            in-hand:""",
    )
    (tmp_path / "m.bdd").write_text(text, encoding="utf-8")
    done = robbdd("run", "m.bdd", "--json", "out.json", folder=tmp_path)
    report: Any = json.loads((tmp_path / "out.json").read_text(encoding="utf-8"))
    verdicts = [[clause["verdict"] for clause in scenario["clauses"]] for scenario in report["scenarios"]]
    assert verdicts == [["holds", "holds", "violated", "holds", "unknown", "holds", "holds", "holds"]] * 2, done.stdout
    for template in ("default", "compact", "de"):
        out = tmp_path / template
        assert robbdd("gherkin", "m.bdd", "-o", out, "--template", template, folder=tmp_path).returncode == 0
        assert behave_statuses(out, tmp_path) == verdicts


@pytest.mark.physics
def test_own_steps_beside_the_model_judge_what_they_define(tmp_path: Path) -> None:
    shutil.copy(PICKPLACE.with_name("bench.scene"), tmp_path)
    text = PICKPLACE.read_text(encoding="utf-8").replace(
        "            in-hand:",
        """            'the lamp is green' after <evt-end>
            and
            glows: holds(pred("the lamp glows at {g}", g=<goal>), before <evt-end>)
            and
            'the lamp is out' before <evt-start>
            and
            in-hand:""",
    )
    (tmp_path / "a-model.bdd").write_text(text, encoding="utf-8")
    own = tmp_path / "steps" / "a_model_steps.py"
    assert robbdd("steps", "a-model.bdd", "--undefined", "-o", own, folder=tmp_path).returncode == 0
    skeleton = own.read_text(encoding="utf-8")
    assert skeleton.count("raise NotImplementedError") == 3
    filled = skeleton.replace("raise NotImplementedError", "pass", 1)
    filled = filled.replace("raise NotImplementedError", "assert 'left' in g, f'dark at {g}'", 1)
    # What the catalog knows can be taken over, too: here what nothing supports.
    sentence = '"{o:Quoted}" is held by "{a:Quoted}" after event "{e:Quoted}"'
    filled += f"\n\n@then({sentence!r})\ndef held(context, o, a, e):\n    assert False\n"
    own.write_text(filled, encoding="utf-8")
    done = robbdd("run", "a-model.bdd", "--first", "2", "--json", "out.json", folder=tmp_path)
    report: Any = json.loads((tmp_path / "out.json").read_text(encoding="utf-8"))
    clauses = [scenario["clauses"] for scenario in report["scenarios"]]
    verdicts = [[clause["verdict"] for clause in judged] for judged in clauses]
    assert verdicts == [
        ["holds", "holds", "holds", "holds", "unknown", "violated", "holds", "holds"],
        ["holds", "holds", "holds", "violated", "unknown", "violated", "holds", "holds"],
    ], done.stdout
    assert clauses[1][3]["reason"] == "dark at env:right_ws"
    assert clauses[0][4]["reason"] == "the step failed: NotImplementedError"
    out = tmp_path / "out"
    assert robbdd("gherkin", "a-model.bdd", "-o", out, "--first", "2", folder=tmp_path).returncode == 0
    (tmp_path / "steps").rename(tmp_path / "gone")
    assert behave_statuses(out, tmp_path) == verdicts


def test_a_folder_has_no_steps_of_its_own_without_a_file_beside_the_model(folder: Path) -> None:
    (folder / "steps").mkdir()
    (folder / "steps" / "other_steps.py").write_text("", encoding="utf-8")
    assert robbdd("gherkin", "main.bdd", "-o", "out", folder=folder).returncode == 0
    assert [file.name for file in (folder / "out" / "features" / "steps").iterdir()] == ["catalog_steps.py"]


def behave_statuses(out: Path, elsewhere: Path) -> list[list[str]]:
    """The verdict of each clause in plain behave, run from another folder."""
    environment = {key: value for key, value in os.environ.items() if not key.startswith("BEHAVE")}
    command = [sys.executable, "-m", "behave", "--format", "json", "--outfile", str(out / "report.json")]
    subprocess.run([*command, str(out / "features")], capture_output=True, cwd=elsewhere, env=environment)
    features: Any = json.loads((out / "report.json").read_text(encoding="utf-8"))
    words = {"passed": "holds", "failed": "violated", "error": "unknown", "undefined": "unknown"}
    found: list[list[str]] = []
    for element in features[0]["elements"]:
        if element["type"] == "scenario":
            steps = [step for step in element["steps"] if step["name"].count('"') > 1 or "lamp" in step["name"]]
            found.append([words[step.get("result", {"status": "undefined"})["status"]] for step in steps])
    return found
