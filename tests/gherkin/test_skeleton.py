"""Skeletons of step functions: every step of a feature finds exactly one, and what exists is left alone."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

from gherkin_kit import edited, feature, model_of
from kit import MODEL
from robbdd_tools.gherkin.skeleton import free_patterns, patterns, skeleton

EVERYTHING = edited(
    "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)",
    """(
            in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)
            and (not held: holds(<part> is held by <robot>, after <end>))
            and (a: holds(<part> is held by <robot>, after <end>) or 'the {lamp} is green' after <end>)
            and 'the {lamp} is green' before <end>
            and shiny: holds(pred('"{class}" and {x} shine', class=<part>, x=<goal>), from <start> until <end>)
        )""",
    edited("When:", "When:\n        event <start> occurs"),
)


def test_behave_finds_one_function_for_every_step(tmp_path: Path) -> None:
    text, new = skeleton(patterns(model_of(EVERYTHING)), None, "main.bdd")
    assert new == text.count("\ndef ") - 1
    (tmp_path / "steps").mkdir()
    (tmp_path / "steps" / "own.py").write_text(text, encoding="utf-8")
    (tmp_path / "x.feature").write_text(feature(EVERYTHING), encoding="utf-8")
    command = [sys.executable, "-m", "behave", "--dry-run", "--format=steps.doc", "--no-color", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
    assert "0 undefined" in done.stdout or "undefined" not in done.stdout, done.stdout + done.stderr
    assert done.returncode == 0, done.stdout + done.stderr
    functions = [node for node in ast.parse(text).body if isinstance(node, ast.FunctionDef)]
    for function in functions[1:]:
        assert ast.unparse(function.args).startswith("context: Context")
    throughout = next(function for function in functions if "_for_seconds" in function.name)
    assert ast.unparse(throughout.args).endswith("seconds: float")


def test_what_a_file_defines_is_left_as_it_is() -> None:
    wanted = patterns(model_of(MODEL))
    text, _ = skeleton(wanted, None, "main.bdd")
    assert skeleton(wanted, text, "main.bdd") == (text, 0)
    step = '@when(\'"{agent:Quoted}" picks "{object:Quoted}" and places it at "{workspace:Quoted}"\')'
    mine = f"{step}\ndef a_set_of_objects(c): ...\n"
    extended, new = skeleton(wanted, mine, "main.bdd")
    assert extended.startswith(mine)
    assert new == len(wanted) - 1
    assert "def a_set_of_objects_2(" in extended
    compile(extended, "steps.py", "exec")


def test_a_sentence_of_two_roles_is_one_function() -> None:
    model = edited("0.5 seconds after <place-end>", "before <pick-start>")
    text, _ = skeleton(patterns(model_of(model)), None, "main.bdd")
    assert 'before event "{event:Quoted}"\')\n@then(' in text


def test_a_file_that_is_not_python_is_refused() -> None:
    with pytest.raises(SyntaxError):
        skeleton(patterns(model_of(MODEL)), "def (:", "main.bdd")


def test_a_text_that_says_a_phrase_of_the_catalog_needs_no_step() -> None:
    clause = "holds(<part> is located at <goal>, 0.5 seconds after <place-end>)"
    said, other = (
        edited(
            clause, clause.replace("<part> is located at <goal>", f"pred('{{a}} is {words} {{b}}', a=<part>, b=<goal>)")
        )
        for words in ("located at", "next to")
    )
    assert free_patterns(model_of(said)) == []
    assert [pattern.text for pattern in free_patterns(model_of(other))] == [
        '{a} is next to {b} for {seconds:g} seconds after event "{event:Quoted}"'
    ]
