"""A pass rate states how many of the executions that there should be have no result."""

from __future__ import annotations

import pytest

from features.judged_clauses import HOLDS, TWO, VIOLATED, judged
from kit import MODEL, fixture
from robbdd_tools.features.hover import hover
from robbdd_tools.features.pass_rates import PassRate, counted, missing_executions, pass_rate
from robbdd_tools.features.run_verdicts import JudgedScenario, Judgement
from robbdd_tools.features.scenarios import number_of_scenarios
from robbdd_tools.names.variant_places import variants_of


def scenario(
    variation: int, *, execution: str = "", repetition: int = 1, repetitions: int = 1, finished: bool = True
) -> JudgedScenario:
    return JudgedScenario(
        "m",
        "v",
        variation,
        "",
        "",
        "",
        execution=execution,
        repetition=repetition,
        repetitions=repetitions,
        finished=finished,
    )


@pytest.mark.parametrize(
    ("text", "verdicts", "label", "outcome"),
    [
        (TWO, (HOLDS, HOLDS), "✔ 2/2 passed", "holds"),
        (TWO, (HOLDS, VIOLATED), "✗ 1/2 passed", "violated"),
        (MODEL, (HOLDS, HOLDS), "? 2 of 4 executed, 2 passed", "unknown"),
        (MODEL, (HOLDS, VIOLATED), "✗ 2 of 4 executed, 1 passed", "violated"),
        (
            TWO.replace("obj set <parts>", "obj set <gone>"),
            (HOLDS,),
            "? 1 executed, others unknown, 1 passed",
            "unknown",
        ),
    ],
)
def test_a_run_of_some_scenarios_has_not_passed(
    text: str, verdicts: tuple[Judgement, ...], label: str, outcome: str
) -> None:
    case = fixture(text)
    (variant,) = variants_of(case.snapshot, case.uri)
    found = pass_rate(case.snapshot, variant, judged(case, *verdicts), number_of_scenarios(variant))
    assert found is not None
    assert (found.label, found.outcome) == (label, outcome)


def test_hover_does_not_call_a_run_of_some_scenarios_passed() -> None:
    case = fixture(MODEL.replace("Scenario bench-to", "Scenario ben$0ch-to"))
    found = hover(case.snapshot, case.uri, case.cursor, judged(case, HOLDS, HOLDS))
    assert found is not None
    assert "`bench-to-tray`: ? 2 of 4 executed, 2 passed" in found.markdown


def test_a_cancelled_run_lacks_the_scenarios_that_it_did_not_finish() -> None:
    assert missing_executions([scenario(1), scenario(2, finished=False)], 4) == 3
    assert missing_executions([scenario(1), scenario(2)], 2) == 0


def test_a_cancelled_run_lacks_repetitions() -> None:
    # Two of three repetitions of the first scenario, none of the second.
    begun = [scenario(1, repetition=number, repetitions=3) for number in (1, 2)]
    assert missing_executions(begun, 2) == 4
    # The failed repetition was executed again, by a run that had only this one.
    whole = [scenario(1, repetitions=3), scenario(1, repetition=2), scenario(1, repetition=3, repetitions=3)]
    assert missing_executions(whole, 1) == 0


def test_each_execution_with_results_should_execute_all_scenarios() -> None:
    assert missing_executions([scenario(1, execution="a"), scenario(2, execution="a")], 2) == 0
    assert missing_executions([scenario(1, execution="a"), scenario(2, execution="b")], 2) == 2
    # An older result without an execution counts until the execution replaces it.
    assert missing_executions([scenario(1, execution="a"), scenario(2)], 2) == 0


def test_without_a_number_of_scenarios_nothing_is_complete() -> None:
    assert missing_executions([scenario(1)], None) is None
    assert PassRate(1, 1, "holds", stale=False, missing=None).outcome == "unknown"


def test_counts_are_words() -> None:
    assert counted(1999, 2000, 3000, "held") == "2,000 of 5,000 executed, 1,999 held"
    assert counted(2, 2, 0, "held") == "2/2 held"
