"""Studies are compared with each other, with their levels and with runs."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from campaign.executed import executions
from campaign.study_agents import QuickAgent, write_study
from robbdd_tools import compare
from robbdd_tools.campaign.aligned_sources import aligned, flipped
from robbdd_tools.campaign.matched_executions import NothingShared
from robbdd_tools.campaign.run_comparison import Decision, compare_results
from robbdd_tools.campaign.run_sources import RunSource
from robbdd_tools.cli import main
from robbdd_tools.run import scheduler
from robbdd_tools.workbench.execution_rows import ExecutionResult


def study(margins: list[float], name: str = "a.study", **levels: object) -> RunSource:
    """A study with an execution for each margin of a clause, all of which have these levels."""
    results = executions({"c": margins})
    return RunSource(name, tuple(with_levels(one, levels) for one in results), is_study=True)


def with_levels(result: ExecutionResult, levels: dict[str, object]) -> ExecutionResult:
    return replace(result, values={**levels, **result.values})


def test_a_factor_with_one_level_does_not_distinguish_executions() -> None:
    before, after, remarks = aligned(study([1.0, 1.0]), study([1.0, -1.0], tested="mine"))
    found = compare_results(before.results, after.results)
    assert (found.matched.shared, found.matched.before_only) == (2, 0)
    assert remarks == ("tested: none became mine",)
    (change,) = flipped(before, after)
    assert [clause.name for clause in change.clauses] == ["c"]


def test_a_value_that_changed_everywhere_is_the_change_that_is_examined() -> None:
    before, after, remarks = aligned(study([1.0], speed=0.2), study([1.0], speed=0.4))
    assert compare_results(before.results, after.results).matched.shared == 1
    assert remarks == ("speed: 0.2 became 0.4",)


def test_other_points_of_a_range_are_not_compared() -> None:
    before, after = study([1.0, 1.0]), study([1.0, 1.0])
    moved = [replace(one, values={"e:var-x": one.index + 10}) for one in after.results]
    one, other, _ = aligned(before, replace(after, results=tuple(moved)))
    with pytest.raises(NothingShared):
        compare_results(one.results, other.results)


def test_several_levels_of_one_side_are_refused_with_what_to_write() -> None:
    later = study([1.0], tested="mine")
    both = replace(later, results=(*later.results, *study([1.0], tested="yours").results))
    with pytest.raises(NothingShared, match=r"only the later one has the factor tested.*FILE.study:tested=mine"):
        aligned(study([1.0]), both)


def test_clauses_of_a_run_are_known_by_their_names_against_a_study() -> None:
    run = RunSource("run 1", tuple(executions({"c": [1.0, 1.0]})))
    before, after, _ = aligned(run, study([1.0, 1.0]))
    stored = tuple(replace(one, clauses=tuple(replace(c, iri="c") for c in one.clauses)) for one in after.results)
    found = compare_results(before.results, stored)
    assert found.decision is Decision.IDENTICAL
    assert [effect.name for effect in found.effects] == ["every clause", "c"]


def test_runs_stay_as_they_are() -> None:
    run = RunSource("run 1", tuple(executions({"c": [1.0]})))
    assert aligned(run, run) == (run, run, ())


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Path:
    monkeypatch.setattr(scheduler, "Agent", QuickAgent)
    monkeypatch.chdir(tmp_path)
    path = write_study(tmp_path)
    for name, seed in (("same", "3"), ("other", "4")):
        path.with_name(f"{name}.study").write_text(path.read_text().replace("seed: 3", f"seed: {seed}"))
    for name in ("x", "same", "other"):
        main(["study", "run", f"{name}.study"])
    capsys.readouterr()
    return tmp_path


def test_stored_studies_are_compared_by_name_and_by_folder(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compare", "x.study", "same.study", "--json", "out.json"]) == 0
    printed = capsys.readouterr().out
    assert "x.study (study fetching) → same.study (study fetching)" in printed
    assert "40 shared executions, compared in pairs" in printed
    assert json.loads((folder / "out.json").read_text())["decision"] == "identical"
    assert main(["compare", ".robbdd/studies/x.study", "same.study"]) == 0
    capsys.readouterr()
    assert main(["compare", "x.study", "other.study", "--html", "out.html"]) == 3
    printed = capsys.readouterr().out
    assert "as two independent samples" in printed
    assert "executions with other verdicts" in printed
    assert "Executions with other verdicts" in (folder / "out.html").read_text(encoding="utf-8")
    assert compare("x.study", "same.study").decision is Decision.IDENTICAL


def test_levels_of_a_study_are_selected_and_wrong_ones_explained(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (name, level), *_ = [(name, value) for name, value in compare_values(folder) if isinstance(value, str)]
    assert main(["compare", f"x.study:{name}={level}", f"same.study:{name}={level}"]) == 0
    capsys.readouterr()
    for word, message in (
        ("x.study:nothing=1", f"the study has no factor or variable 'nothing'; it has {name}"),
        (f"x.study:{name}=nowhere", f"no execution has {name} = 'nowhere'; its levels are {level}"),
        (f"x.study:{name}", "write levels as FACTOR=LEVEL"),
        ("y.study", "the study has no results"),
    ):
        assert main(["compare", word, "same.study"]) == 2
        assert message in capsys.readouterr().err


def compare_values(folder: Path) -> list[tuple[str, object]]:
    """The variables of the study with their first values, as words."""
    from robbdd_tools.campaign.run_sources import run_source
    from robbdd_tools.run.report import value_word, variable_word

    (first, *_) = run_source("x.study", folder).results
    return [(variable_word(name), value_word(value)) for name, value in first.values.items()]
