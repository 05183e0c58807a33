"""A run executes a catalog behaviour instead of an unavailable one, and its results record it."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

import robbdd_tools as robbdd
from kit import EXAMPLES, corpus
from robbdd_tools.cli import main
from robbdd_tools.features.clause_results import clause_hints
from robbdd_tools.features.project_findings import findings_of
from robbdd_tools.features.result_words import result_words
from robbdd_tools.features.run_verdicts import Results, digests_of
from robbdd_tools.gherkin.select import SelectionError
from robbdd_tools.lsp.client_settings import Settings
from robbdd_tools.run.store import StoredRun
from robbdd_tools.workbench.judged_scenarios import judged_scenario, judgement
from robbdd_tools.workbench.rerun import failed_in
from robbdd_tools.workbench.substitution import substitutions_of

WORDS = "catalog behaviour 'pick-place' substitutes for ROS action '/cell/pick' of 'built-in'"
BUILT_IN = "https://example.org/robbdd/execution/built-in"


@pytest.fixture
def cell(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The example with a ROS action instead of the catalog's behaviour, and a clause that a ROS topic decides."""
    model = shutil.copytree(EXAMPLES / "pickplace", tmp_path / "cell") / "pickplace.bddx"
    text = model.read_text(encoding="utf-8").replace('catalog "pick-place"', 'bhv action: "/cell/pick"')
    topic = 'obs policy (ns=exec) by-topic for <pick-place.in-hand> { trinary topic: "/held" }\n'
    text = text.replace("Scenario Exec", topic + "Scenario Exec", 1).replace(
        "policies: {", "policies: { <by-topic>,", 1
    )
    model.write_text(text, encoding="utf-8")
    monkeypatch.chdir(model.parent)
    return Path(model.name)


def substituted(model: Path, **names: str) -> Mapping[str, str]:
    plan = robbdd.load(model).scenarios(substitutions={name.replace("_", "-"): to for name, to in names.items()})
    return substitutions_of(plan.scenarios)


@pytest.mark.parametrize("name", ["built-in", "exec:built-in", BUILT_IN])
def test_an_implementation_is_named_locally_by_curie_or_iri(cell: Path, name: str) -> None:
    plan = robbdd.load(cell).scenarios(substitutions={name: "pick-place"})
    assert substitutions_of(plan.scenarios) == {BUILT_IN: "pick-place"}
    assert {str(spec.substitution) for spec in plan.scenarios} == {WORDS}
    assert substituted(cell) == {}


@pytest.mark.parametrize(
    ("substitutions", "words"),
    [
        ({"server": "pick-place"}, "there is no behaviour implementation 'server'; the executions use built-in"),
        ({"built-in": "pik"}, "the catalog has no behaviour 'pik'; it has pick, pick-place, place"),
        ({"built-in": "place"}, "'place' of the catalog does not execute 'pick-place' of .*: substitute 'pick-place'"),
    ],
)
def test_a_wrong_name_is_refused_with_the_names_there_are(
    cell: Path, substitutions: dict[str, str], words: str
) -> None:
    with pytest.raises(SelectionError, match=words):
        robbdd.load(cell).scenarios(substitutions=substitutions)


def test_a_model_without_executions_says_so(cell: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(cell.with_suffix(".bdd")), "--bhv", "built-in=pick-place", "--no-store"]) == 2
    assert "no behaviour implementation 'built-in'; the model has no executions" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["run", str(cell), "--bhv", "built-in"])
    assert "'built-in' is not NAME=BEHAVIOUR" in capsys.readouterr().err


@pytest.mark.physics
def test_every_result_states_the_substitution(cell: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run = ["run", str(cell), "--bhv", "built-in=pick-place", "--first", "1"]
    assert main([*run, "--json", "run.json", "--junit", "run.xml"]) == 1
    assert WORDS in capsys.readouterr().out
    assert WORDS in Path("run.xml").read_text(encoding="utf-8")
    (scenario,) = json.loads(Path("run.json").read_text(encoding="utf-8"))["scenarios"]
    assert scenario["substitution"] == {
        "implementation": BUILT_IN,
        "stated": "ROS action '/cell/pick'",
        "executed": "pick-place",
    }
    by_verdict: dict[str, list[str]] = {}
    for clause in scenario["clauses"]:
        by_verdict.setdefault(clause["verdict"], []).append(f"{clause['name']}: {clause['reason']}")
    assert set(by_verdict) == {"holds", "unknown"}
    (unknown,) = by_verdict["unknown"]
    assert unknown.startswith("in-hand: ")
    assert "ROS topic '/held'" in unknown
    (past,) = robbdd.runs(cell)
    (result,) = past.results
    assert str(result.substitution) == result.rows().__next__()["substitution"] == WORDS
    assert failed_in(past.place).substitutions == {BUILT_IN: "pick-place"}
    assert WORDS in hover(past.place, robbdd.load(cell))
    assert main(["run", str(cell), "--rerun-failed"]) == 1
    assert main(["judge", "latest", str(cell)]) == 1
    assert main(["replay", "latest"]) == 0
    assert capsys.readouterr().out.count(WORDS) == 3


def hover(place: StoredRun, model: Any) -> str:
    """Return what editors show at the first clause with a result."""
    (file,) = model.files
    results, shown = place.read_results(), Results()
    assert results is not None
    digests = digests_of(file.snapshot, file.uri)
    for index, result in enumerate(results.scenarios):
        scenario = judged_scenario(result.spec, file.uri, digests, "", run=1, index=index, seed=None)
        for clause in result.spec.clauses:
            scenario.judge(clause.iri, judgement(clause, result.judged[clause.line], digests))
        shown.add([scenario])
    hints = (
        hint for each in file.snapshot.closure(file.uri)
        for hint in clause_hints(file.snapshot, each.document.uri, findings_of(shown))
    )  # fmt: skip
    return result_words(next(hints))


def test_the_setting_of_a_workspace_folder_counts_below_it() -> None:
    settings = Settings()
    assert settings.set("file:///cell", {"run": {"bhv": {"server": "pick-place"}}}) is None
    assert settings.run_defaults("file:///cell/a.bddx").bhv == {"server": "pick-place"}
    assert settings.run_defaults("file:///other/a.bddx").bhv == {}
    assert "robbdd.run.bhv" in str(settings.set("file:///cell", {"run": {"bhv": {"server": 1}}}))
    assert "robbdd.run.bhv" in str(settings.set("file:///cell", {"run": {"bhv": ["server"]}}))


def test_the_executions_of_others_run_with_a_substitution() -> None:
    (model,) = (path for path in corpus(".bddx"))
    (name,) = {execution.implementation.iri for file in robbdd.load(model).files for execution in executions(file)}
    plan = robbdd.load(model).scenarios(substitutions={name: "pick-place"})
    assert all(spec.substitution is not None for spec in plan.scenarios)


def executions(file: Any) -> Any:
    return file.acceptance.executions
