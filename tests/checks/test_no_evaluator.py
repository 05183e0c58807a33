"""Free text that neither a step nor a policy judges is reported at its text while editing."""

from __future__ import annotations

from pathlib import Path

import pytest

from checks.models import apply, fixes_of, text_of
from features.broken import BROKEN
from kit import MODEL, Fixture, fixture
from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.diagnostics import all_diagnostics, fast_diagnostics
from robbdd_tools.names.project import Project

CODE = "no-evaluator"
PRED, TEXT, EXECUTED = BROKEN[CODE]
STEPS = """from behave import then

@then('{step}')
def judge(context, **values): ...
"""


def reported(case: Fixture) -> list[Diagnostic]:
    return [entry for entry in fast_diagnostics(case.snapshot, case.uri) if entry.code == CODE]


@pytest.mark.parametrize(("model", "text"), [(PRED, "'{o} is up'"), (TEXT, "'It is up'")])
def test_the_text_is_reported(model: str, text: str) -> None:
    case = fixture(model)
    (finding,) = reported(case)
    assert text_of(case)[finding.span.start : finding.span.end] == text
    assert finding.severity is Severity.WARNING


def test_a_predicate_of_the_catalog_needs_nothing() -> None:
    assert reported(fixture(MODEL)) == []


@pytest.mark.parametrize(
    ("model", "step", "is_judged"),
    [
        (PRED, 'for {seconds:g} seconds after event "{event}"', False),
        (PRED, '{o} is up for {seconds:g} seconds after event "{event}"', True),
        (PRED, '"{o:Quoted}" is up for {seconds:g} seconds after event "{event:Quoted}"', True),
        (PRED, '{o} is up after event "{event}"', False),
        (PRED, '{o} is down for {seconds:g} seconds after event "{event}"', False),
        (TEXT, 'It is up after event "{event}"', True),
        (TEXT, 'It is up before event "{event}"', False),
    ],
)
def test_a_step_that_matches_judges_it(tmp_path: Path, model: str, step: str, is_judged: bool) -> None:
    (tmp_path / "steps").mkdir()
    (tmp_path / "steps" / "my_model_steps.py").write_text(STEPS.format(step=step), encoding="utf-8")
    case = fixture(model)
    project, uri = Project(), path_to_uri(tmp_path / "my-model.bdd")
    for name in case.project.texts():
        own = uri if name == case.uri else path_to_uri(tmp_path / name.rpartition("/")[2])
        project.open(own, 1, case.project.texts()[name][1])
    assert [entry.code for entry in fast_diagnostics(project.snapshot(), uri) if entry.code == CODE] == (
        [] if is_judged else [CODE]
    )


def test_the_policy_goes_into_the_executions_that_there_are() -> None:
    case = fixture(EXECUTED)
    (fix,) = fixes_of(case, reported(case)[0])
    assert fix.title == "Write a policy into 'main.bddx'"
    apply(case, fix)
    text = case.project.texts()["file:///fixture/main.bddx"][1]
    assert "    bhv: <built-in>\n    policies: { <in-tray-policy> }\n}" in text
    assert "for <fetch.in-tray> {" in text
    assert "observes var <fetch.part>" in text
    errors = [one for one in all_diagnostics(case.snapshot, "file:///fixture/main.bddx") if one.severity == 1]
    assert errors == []


def test_a_text_clause_gets_a_name_for_its_policy() -> None:
    case = fixture(TEXT)
    (fix,) = fixes_of(case, reported(case)[0])
    apply(case, fix)
    assert "it-is-up: holds(pred('It is up'), after <end>)" in text_of(case)
    assert "for <fetch.it-is-up>" in case.project.texts()["file:///fixture/main.bddx"][1]
    errors = [one for one in all_diagnostics(case.snapshot, "file:///fixture/main.bddx") if one.severity == 1]
    assert errors == []


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("pred('{a} is at rest', a=<part>)", "<part> is at rest"),
        ("pred('{a} is at rest', a=<parts.bolt>)", "<parts.bolt> is at rest"),
        ("pred('{a} moves slower than {v}', a=<robot>, v=0.25 m/s)", "<robot> moves slower than 0.25 m/s"),
        ("pred('{a} moves slower than {v}', a=<robot>, v=0.25)", None),
        ("pred('{a} moves slower than {v}', a=<robot>, v='slow')", None),
        ("pred('{a} is at rest', b=<part>)", None),
    ],
)
def test_a_text_that_says_a_phrase_with_these_values_is_judged_by_it(text: str, written: str | None) -> None:
    case = fixture(MODEL.replace("in-tray: holds(<part> is located at <goal>", f"in-tray: holds({text}"))
    found = fast_diagnostics(case.snapshot, case.uri)
    assert ([] if written is None else [f"Write '{written}'"]) == [
        fix.title for entry in found if entry.code == "catalog-phrase" for fix in entry.fixes
    ]
    assert any(entry.code == CODE for entry in found) == (written is None)
