"""Names and sentences that try to be markup, escape sequences, CI commands or formulas are shown as text."""

from __future__ import annotations

import ast
import csv
import io
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

from commands.terminals import environment, on_a_terminal, screen_lines
from commands.test_graph_models import PICKPLACE, robbdd
from kit import EXAMPLES
from robbdd_tools.graph.rdf.serialize import parse

SENTENCE = "the part is [/nope] fine [bold]really[/bold] :smile: ['a', 'b'] 12"
HOSTILE = "[red]x[/] \x1b[2J\x9b2J\r\n::error::forged \u202e"
DISPLAY = """
import sys
from robbdd_tools.commands.progress import Display
from robbdd_tools.protocol.messages import *
from robbdd_tools.protocol.specs import *
from robbdd_tools.run.results import RunResults
from robbdd_tools.monitor.verdict import Outcome
text = sys.argv[1]
clauses = tuple(ClauseSpec(line, f"https://x/c{line}", "c", "then", text) for line in (5, 6))
spec = ScenarioSpec("f.feature", 3, text, "s", "v", 1, {text: text}, 7, SceneSpec(), {}, clauses)
results = RunResults(Manifest("m.bdd", 1, (spec,)))
with Display(results) as display:
    for message in (
        RunStarted(1, "s"), ScenarioStarted(0), LogLine("warning", text),
        ClauseJudged(0, 5, Outcome.VIOLATED, -1.0, text, 1.0, text),
        ClauseJudged(0, 6, Outcome.UNKNOWN, None, "", None, "why " + text),
        ScenarioFinished(0, 1.0, 1.0, 1.0),
    ):
        results.apply(message)
        display.watch(message)
        display.show(message)
    display.broken(text)
    display.summary(results)
"""


def shown(text: str, columns: int) -> list[str]:
    return screen_lines(on_a_terminal([sys.executable, "-c", DISPLAY, text], columns))


@pytest.mark.parametrize("text", [SENTENCE, HOSTILE.replace("\x00", "")])
def test_a_terminal_shows_what_a_pipe_gets(text: str) -> None:
    piped = subprocess.run(
        [sys.executable, "-c", DISPLAY, text], capture_output=True, encoding="utf-8", check=True, env=environment()
    ).stdout
    assert [" ".join(line.split()) for line in shown(text, 400)] == [
        " ".join(line.split()) for line in piped.split("\n")
    ]


def test_a_sentence_is_shown_with_its_brackets() -> None:
    assert sum(SENTENCE in line for line in shown(SENTENCE, 300)) >= 5


@pytest.mark.physics
def test_a_run_of_a_model_with_brackets_keeps_its_results(tmp_path: Path) -> None:
    model = model_with(
        "in-hand: holds(<thing> is held by <robot>, after <evt-pick-end>)",
        f'"{SENTENCE}" after <evt-pick-end>',
        tmp_path,
    )
    command = [sys.executable, "-m", "robbdd_tools.cli", "run", str(model), "--first", "1", "--no-store"]
    lines = screen_lines(on_a_terminal(command, 300, expected=1))
    assert any(line.startswith(f"  ? {SENTENCE}") for line in lines)
    assert lines[-2].startswith("1 scenario: 0 hold, 0 violated, 1 unknown")


def test_nothing_in_a_run_acts_on_the_terminal_or_begins_a_line() -> None:
    lines = shown(HOSTILE, 600)
    assert not any(re.search(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202e]", line) for line in lines)
    assert not any(line.lstrip().startswith("::") for line in lines)
    assert any(r"\x1b[2J\x9b2J\r\n::error::forged \u202e" in line for line in lines)


def test_findings_cannot_forge_lines(tmp_path: Path) -> None:
    name = "::error file=x::\x1b[31m\nforged.bdd"
    (tmp_path / name).write_text('import "a\x1b]0;t\x07\u202e.scene"\n', encoding="utf-8")
    done = robbdd("check", ".", folder=tmp_path)
    assert done.returncode == 1
    assert "\x1b" not in done.stdout
    assert "\u202e" not in done.stdout
    assert done.stdout.startswith(r"\x3a:error file=x::\x1b[31m\nforged.bdd:1:")
    assert len(done.stdout.splitlines()) == 3
    findings = map(json.loads, robbdd("check", "--json", ".", folder=tmp_path).stdout.splitlines())
    assert {finding["file"] for finding in findings} == {name}


def test_a_missing_file_with_a_hostile_name_is_refused_on_one_line(tmp_path: Path) -> None:
    for command in ("check", "run", "graph", "format"):
        done = robbdd(command, "x\n::error::\x1b.bdd", folder=tmp_path)
        assert done.returncode == 2
        assert "\x1b" not in done.stderr + done.stdout
        assert len(done.stderr.splitlines()) <= 1


def test_an_unknown_argument_is_refused_without_acting(tmp_path: Path) -> None:
    assert "\x1b" not in robbdd("check", ".", "--\x1b[2J", folder=tmp_path).stderr


def model_with(old: str, new: str, tmp_path: Path) -> Path:
    shutil.copytree(EXAMPLES / "pickplace", tmp_path, dirs_exist_ok=True)
    model = tmp_path / "pickplace.bdd"
    text = model.read_text(encoding="utf-8")
    assert old in text
    model.write_text(text.replace(old, new), encoding="utf-8")
    return model


def model_with_role(tmp_path: Path, role: str) -> Path:
    return model_with("line operator", role, tmp_path)


ASK = "SELECT ?role { ?story a bdd:UserStory ; rbw:role ?role }"


@pytest.mark.parametrize("role", ["=1+1", "+cmd", "-2+3", "@SUM(A1)", " =1", "\uff1d1", "\t=1", "\r=1"])
def test_a_cell_is_no_formula(tmp_path: Path, role: str) -> None:
    text = robbdd("query", model_with_role(tmp_path, role), ASK, "--format", "csv").stdout
    (_, (cell,)) = csv.reader(io.StringIO(text))
    assert cell.startswith(("'", "\\"))


def test_numbers_stay_numbers_whatever_their_sign() -> None:
    ask = "SELECT * { VALUES ?x { '-1.5'^^xsd:decimal 2 '-3e-7'^^xsd:double '-12' } }"
    text = robbdd("query", PICKPLACE, ask, "--format", "csv").stdout
    assert sorted(map(float, text.split()[1:])) == [-12, -1.5, -3e-7, 2]


def test_answers_to_queries_are_escaped(tmp_path: Path) -> None:
    model = model_with_role(tmp_path, "::error::a\x1b[2J\u202e")
    for form in ("table", "csv"):
        last = robbdd("query", model, ASK, "--format", form).stdout.splitlines()[-1]
        assert last == r"\x3a:error::a\x1b[2J\u202e"
    text = robbdd("query", model, ASK, "--format", "json").stdout
    assert json.loads(text)["results"]["bindings"][0]["role"]["value"] == "::error::a\x1b[2J\u202e"
    assert "\x1b" not in text


def test_graphs_with_control_characters_are_valid_or_refused(tmp_path: Path) -> None:
    model = model_with_role(tmp_path, "a\x01\x85\u202eb")
    refused = robbdd("graph", model, "--format", "xml")
    assert (refused.returncode, refused.stdout) == (2, "")
    assert r"xml cannot hold \x01 of 'a\x01\x85\u202eb'; ttl, nt and json-ld can" in refused.stderr
    picture = robbdd("graph", model, "--format", "svg").stdout
    assert ElementTree.fromstring(picture).tag.endswith("svg")
    for form in ("ttl", "nt", "json-ld"):
        text = robbdd("graph", model, "--format", form).stdout
        assert not set("\x01\x85\u202e") & set(text)
        known = parse(text, form)
        assert any(str(term) == "a\x01\x85\u202eb" for term in known.objects())


def test_half_characters_are_refused_where_a_format_cannot_hold_them(tmp_path: Path) -> None:
    (tmp_path / "half.json").write_text(
        robbdd("graph", PICKPLACE, "--format", "json-ld").stdout.replace("line operator", r"a\ud800b"), encoding="utf-8"
    )
    for form in ("ttl", "nt", "xml"):
        done = robbdd("graph", "half.json", "--format", form, folder=tmp_path)
        assert (done.returncode, done.stdout) == (2, "")
        assert rf"{form} cannot hold \ud800" in done.stderr


COMMANDS = r"a\n::error::forged\n  ::set-output name=x::y ##vso[task.complete]##[error]"


def turtle(tmp_path: Path, role: str) -> Path:
    text = robbdd("graph", PICKPLACE, "--format", "ttl").stdout
    assert "line operator" in text
    (tmp_path / "m.ttl").write_text(text.replace("line operator", role), encoding="utf-8")
    return tmp_path / "m.ttl"


@pytest.mark.parametrize("form", ["ttl", "nt", "xml", "json-ld", "svg"])
def test_a_literal_of_a_graph_is_no_command_to_a_ci_service(tmp_path: Path, form: str) -> None:
    done = robbdd("graph", turtle(tmp_path, COMMANDS), "--format", form)
    assert done.returncode == 0, done.stderr
    lines = (done.stdout + done.stderr).splitlines()
    assert [line for line in lines if line.lstrip().startswith("::") or re.search(r"##[\w-]*\[", line)] == []
    if form != "svg":
        expected = COMMANDS.replace(r"\n", "\n")
        assert any(str(term) == expected for term in parse(done.stdout, form).objects())


def test_findings_and_pictures_of_a_graph_act_on_no_terminal(tmp_path: Path) -> None:
    model = turtle(tmp_path, COMMANDS + r"\u001B[2J\u009B2J")
    for arguments in (("check",), ("graph", "--format", "svg"), ("graph", "--format", "ttl")):
        done = robbdd(arguments[0], model, *arguments[1:])
        assert not set("\x1b\x9b") & set(done.stdout + done.stderr)


def test_a_picture_of_half_characters_is_valid(tmp_path: Path) -> None:
    document = robbdd("graph", PICKPLACE, "--format", "json-ld").stdout
    assert "line operator" in document
    (tmp_path / "half.json").write_text(document.replace("line operator", r"a\ud800b"), encoding="utf-8")
    done = robbdd("graph", "half.json", "--format", "svg", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert ElementTree.fromstring(done.stdout.encode()).tag.endswith("svg")


def test_steps_of_a_hostile_sentence_are_no_command_and_valid_python(tmp_path: Path) -> None:
    model = model_with(
        "in-hand: holds(<thing> is held by <robot>, after <evt-pick-end>)",
        "'so ##vso[task.complete] it is' after <evt-pick-end>",
        tmp_path,
    )
    text = robbdd("steps", model).stdout
    assert "##vso" not in text
    strings = [str(node.value) for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Constant)]
    assert any("so ##vso[task.complete] it is" in string for string in strings)
