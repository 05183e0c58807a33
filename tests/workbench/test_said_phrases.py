"""A text that has the words of several phrases is judged by the phrase that takes its values."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

import robbdd_tools as robbdd
from kit import EXAMPLES
from robbdd_tools.workbench.folder import Keeping
from robbdd_tools.workbench.plan import Plan, Selection

CLAUSES = "rim-untouched: holds(<box> does not touch <rim>, from <evt-pick-start> until <evt-end>)"
SAID = """said: holds(pred("{{x}} {words} {{y}}", x=<subject>, y=<places.table_ws>), from <evt-start> until <evt-end>)
            and by-arm: holds(<robot> does not collide <places.table_ws>, from <evt-start> until <evt-end>)
            and by-box: holds(<box> does not collide with <places.table_ws>, from <evt-start> until <evt-end>)"""
WORDS = ("does not collide", "does not collide with")


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """A model whose text is about the arm in one scenario and about the box in the other."""
    shutil.copytree(EXAMPLES / "rim", tmp_path, dirs_exist_ok=True)
    path = tmp_path / "rim.bdd"
    text = path.read_text(encoding="utf-8").replace("{ 0.3, 0.265 }", "{ 0.3 }")
    text = text.replace("    var height\n", "    var height\n    var subject\n")
    text = text.replace(
        "variation:\n", "variation:\n                var <pack.subject>: { <arms.panda>, <goods.box> }\n"
    )
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.physics
@pytest.mark.parametrize("words", WORDS)
def test_verdict_and_margin_are_those_of_the_phrase_that_takes_the_values(words: str, model: Path) -> None:
    model.write_text(model.read_text(encoding="utf-8").replace(CLAUSES, SAID.format(words=words)), encoding="utf-8")
    loaded = robbdd.load(model.with_suffix(".bddx"))
    assert [one.code for one in loaded.diagnostics if one.severity < robbdd.Severity.INFORMATION] == []
    with Plan.of(loaded, Selection()).run(seed=1, keeping=Keeping(keep=False)) as run:
        found = [{clause.name.rpartition(":")[2]: clause for clause in result.clauses} for result in run.results]
    assert len(found) == 2
    for clauses, own in zip(found, ("by-arm", "by-box"), strict=True):
        assert clauses["said"].verdict == clauses[own].verdict == "holds"
        assert (clauses["said"].margin, clauses["said"].unit) == (clauses[own].margin, clauses[own].unit)
    assert found[0]["said"].margin != found[1]["said"].margin
