"""Free text that says a phrase of the catalog, in physics: judged as the predicate, unless the user judges it."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from kit import EXAMPLES
from robbdd_tools.cli import main

pytestmark = pytest.mark.physics
PHRASE = "holds(<part> is located at <bin>, after <evt-end>)"
TEXT = "holds(pred('{what} is located at {where}', what=<part>, where=<bin>), after <evt-end>)"
STEP = """from behave import then

@then('{what} is located at {where} after event "{event}"')
def judge(context, what, where, event):
    assert what != 'env:cube1', f'{what} is not where I want it'
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = shutil.copytree(EXAMPLES / "sorting", tmp_path / "sorting")
    monkeypatch.chdir(folder)
    return folder


def judgements(folder: Path, *arguments: str) -> dict[str, tuple[str, float | None, str]]:
    main([*arguments, "--json", "out.json"])
    document: Any = json.loads((folder / "out.json").read_text(encoding="utf-8"))
    return {
        f"{clause['name']} {clause.get('line', index)}": (
            clause["verdict"],
            clause["robustness"],
            clause["reason"],
        )
        for scenario in document["scenarios"]
        for index, clause in enumerate(scenario["clauses"])
    }


def rewritten(folder: Path, old: str, new: str) -> None:
    model = folder / "sorting.bdd"
    text = model.read_text(encoding="utf-8")
    assert old in text
    model.write_text(text.replace(old, new), encoding="utf-8")


def test_a_text_is_judged_as_the_phrase_that_it_says_in_a_run_and_on_its_traces(folder: Path) -> None:
    by_phrase = judgements(folder, "run", "sorting.bdd", "--first", "1")
    assert "holds" in {verdict for verdict, _, _ in by_phrase.values()}
    rewritten(folder, PHRASE, TEXT)
    assert judgements(folder, "run", "sorting.bdd", "--first", "1") == by_phrase
    assert judgements(folder, "judge", "latest", "sorting.bdd") == by_phrase


def test_a_users_step_for_the_text_takes_precedence(folder: Path) -> None:
    rewritten(folder, PHRASE, TEXT)
    (folder / "steps").mkdir()
    (folder / "steps" / "sorting_steps.py").write_text(STEP, encoding="utf-8")
    found = judgements(folder, "run", "sorting.bdd", "--first", "1")
    assert ("violated", None, "env:cube1 is not where I want it") in found.values()


def test_values_of_another_kind_leave_the_text_unknown(folder: Path) -> None:
    rewritten(folder, PHRASE, TEXT.replace("where=<bin>", "where=<part>"))
    found = judgements(folder, "run", "sorting.bdd", "--first", "1")
    reasons = [reason for verdict, _, reason in found.values() if verdict == "unknown"]
    assert reasons
    assert all(reason.startswith("no step definition for") for reason in reasons)
