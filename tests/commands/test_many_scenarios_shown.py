"""A run of many scenarios prints its failures and pass rates by factor."""

from __future__ import annotations

from dataclasses import replace

import pytest

from robbdd_tools.commands.progress import Display
from robbdd_tools.commands.rate_lines import MAX_LEVELS, rate_lines
from robbdd_tools.protocol.messages import ClauseJudged, Output, RunMessage, ScenarioFinished
from robbdd_tools.protocol.specs import ClauseSpec, Manifest, ScenarioSpec, SceneSpec
from robbdd_tools.run.results import RunResults

CLAUSES = tuple(ClauseSpec(line, f"https://x/c{line}", f"c{line}", "then", f'"e:a" {line}') for line in (5, 6))
SPEC = ScenarioSpec(
    "features/s.feature", 3, "e:v -- 1", "https://x/s", "https://x/v", 1, {}, 7, SceneSpec(), {}, CLAUSES
)  # fmt: skip


def run_of(values: list[dict[str, object]]) -> RunResults:
    return RunResults(Manifest("m.bdd", 1, tuple(replace(SPEC, values=one) for one in values)))


def messages_of(index: int, outcome: str) -> list[RunMessage]:
    return [
        Output(index, f"said by {index}"),
        ClauseJudged(index, 5, "holds", 0.01, "m", 1.0, ""),
        ClauseJudged(index, 6, outcome, 0.01, "m", 1.0, ""),
        ScenarioFinished(index, 9.0, 1.0, 0.5),
    ]


def finish(found: RunResults, index: int, outcome: str) -> None:
    for message in messages_of(index, outcome):
        found.apply(message)


def twenty(*, brief: bool = False) -> RunResults:
    """Show 20 executions: of the cubes one fails and one is unknown; balls hold."""
    found = run_of([{"e:var-thing": "e:cube" if i < 10 else "e:ball", "e:var-goal": "e:bin"} for i in range(20)])
    display = Display(found, brief=brief)
    for index in range(20):
        for message in messages_of(index, {3: "violated", 7: "unknown"}.get(index, "holds")):
            found.apply(message)
            display.show(message)
    display.summary(found)
    return found


def test_rates_are_those_of_all_scenarios_and_of_factors_with_several_levels() -> None:
    assert rate_lines(twenty().scenarios, 20) == [
        "all scenarios: 18 of 20 hold (90.0 %; 95 % interval 69.9 % to 97.2 %)",
        "  thing = cube: 8 of 10 hold (80.0 %; 95 % interval 49.0 % to 94.3 %)",
        "  thing = ball: 10 of 10 hold (100.0 %; 95 % interval 72.2 % to 100.0 %)",
    ]


def test_the_rate_of_a_cancelled_run_is_not_that_of_all_scenarios() -> None:
    shown = rate_lines(twenty().scenarios, 50)
    assert shown[0].startswith("20 of 50 scenarios, the others have not finished: 18 of 20 hold (90.0 %;")


@pytest.mark.usefixtures("without_scipy")
def test_without_scipy_rates_have_no_interval() -> None:
    assert rate_lines(twenty().scenarios, 20)[0] == "all scenarios: 18 of 20 hold (90.0 %)"


def test_levels_with_the_same_words_are_not_mixed() -> None:
    found = run_of([{"e:var-thing": "e:cube"}, {"e:var-thing": "other:cube"}])
    for index, outcome in enumerate(("holds", "violated")):
        finish(found, index, outcome)
    assert [line.split(" (")[0] for line in rate_lines(found.scenarios, len(found.scenarios))[1:]] == [
        "  thing = cube: 1 of 1 hold",
        "  thing = cube: 0 of 1 hold",
    ]


def test_of_a_factor_with_many_levels_the_lowest_rates_are_listed() -> None:
    count = MAX_LEVELS + 3
    found = run_of([{"e:var-mass": index} for index in range(count)])
    for index in range(count):
        finish(found, index, "violated" if index == count - 1 else "holds")
    lines = rate_lines(found.scenarios, len(found.scenarios))
    assert lines[1].startswith(f"  mass = {count - 1}: 0 of 1 hold")
    assert len(lines) == MAX_LEVELS + 2
    assert lines[-1] == "  … and 3 more levels with rates that are not lower"


def test_a_brief_run_prints_failures_with_what_does_not_hold(capsys: pytest.CaptureFixture[str]) -> None:
    twenty(brief=True)
    lines = capsys.readouterr().out.splitlines()
    assert lines[:6] == [
        "2 of 20 scenarios: 2 hold",
        "e:v -- 1  thing = cube, goal = bin",
        "  │ said by 3",
        lines[3],
        "4 of 20 scenarios: 3 hold",
        "6 of 20 scenarios: 5 hold",
    ]
    assert "✗" in lines[3]
    assert sum("said by" in line for line in lines) == 2
    assert not any("✔" in line for line in lines)
    assert "  thing = cube: 8 of 10 hold (80.0 %; 95 % interval 49.0 % to 94.3 %)" in lines
    assert lines[-1].startswith("20 scenarios: 18 hold, 1 violated, 1 unknown")


def test_other_runs_print_every_clause_and_no_rates(capsys: pytest.CaptureFixture[str]) -> None:
    twenty(brief=False)
    written = capsys.readouterr().out
    assert written.count("✔") == 38
    assert "interval" not in written
    assert "of 20 scenarios" not in written
