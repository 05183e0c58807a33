"""Effects of the levels of factors, and factors that are confounded."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import product

import pytest

from campaign.executed import executions
from robbdd_tools.campaign.factor_effects import confounded, level_effects
from robbdd_tools.campaign.report_data import factors
from robbdd_tools.campaign.report_factors import confounding_words, effect_rows, flaky_scenarios, matrix_data, repeated
from robbdd_tools.workbench.execution_rows import ExecutionResult


def run(values: Sequence[Mapping[str, object]], margins: list[float]) -> list[ExecutionResult]:
    """Executions of scenarios with these values; each value combination is one scenario."""
    made = executions({"c": margins})
    return [replace(one, values=value, name="e:v -- 1") for one, value in zip(made, values, strict=True)]


def test_a_level_is_compared_with_all_others() -> None:
    holds = [True] * 9 + [False] + [True] * 5 + [False] * 5
    low, high = level_effects("speed", ["low", "high"], [0] * 10 + [1] * 10, holds)
    assert (low.holding, low.total, round(low.difference, 3)) == (9, 10, 0.4)
    # Newcombe's method 10 by hand, from Wilson's intervals: 9/10 [0.5958, 0.9821], 5/10 [0.2366, 0.7634].
    assert (round(low.change.low, 3), round(low.change.high, 3)) == (-0.002, 0.676)
    assert high.difference == -low.difference


def test_a_level_without_an_effect_is_found_as_often_as_stated() -> None:
    drawn = random.Random(1)
    missed = 0
    for _ in range(400):
        holds = [drawn.random() < 0.8 for _ in range(60)]
        first, _ = level_effects("x", ["a", "b"], [0] * 30 + [1] * 30, holds)
        missed += not first.change.low <= 0.0 <= first.change.high
    assert missed <= 30  # 5 % of 400 are 20; more than 30 have a probability below 2 %


def test_balanced_factors_are_not_confounded() -> None:
    table = list(product(range(3), range(2), range(4)))
    assert list(confounded(["a", "b", "c"], list(zip(*table, strict=True)))) == []


def test_factors_that_change_together_have_one_effect() -> None:
    (found,) = confounded(["arm", "distance"], [[0, 0, 1, 1], [1, 1, 0, 0]])
    assert (found.strength, found.inseparable) == (1.0, True)


def test_a_nested_factor_comes_first() -> None:
    (found,) = confounded(["arm", "part"], [[0, 0, 1, 1], [0, 1, 2, 3]])
    assert (found.factors, found.nested, found.inseparable) == (("part", "arm"), True, False)


def test_a_weak_association_by_chance_is_not_reported_and_a_strong_one_is() -> None:
    assert list(confounded(["a", "b"], [[0] * 50 + [1] * 50, [0] * 26 + [1] * 24 + [0] * 24 + [1] * 26])) == []
    (found,) = confounded(["a", "b"], [[0] * 50 + [1] * 50, [0] * 40 + [1] * 10 + [0] * 10 + [1] * 40])
    # For two times two levels, V is the absolute value of phi: (40² − 10²) / 50².
    assert found.strength == pytest.approx(0.6)


def test_the_words_name_groups_of_inseparable_factors_once() -> None:
    rows: list[dict[str, object]] = [
        {"e:var-arm": arm, "e:var-cup": f"cup {arm}", "e:var-bin": bin} for arm in "ab" for bin in (1, 2)
    ]
    results = run(rows, [1.0, 1.0, -1.0, -1.0])
    assert confounding_words(factors(results)) == [
        "arm and cup have the same effect here: each level of one occurs with one of the other"
    ]
    rows_of_arm = [row for row in effect_rows(factors(results), results) if row.factor == "arm"]
    assert [(row.level, row.holding, row.against[:13]) for row in rows_of_arm] == [
        ("a", 2, "+100.0 points"),
        ("b", 0, "−100.0 points"),
    ]


def test_a_scenario_that_holds_with_some_seeds_only_is_flaky() -> None:
    results = run([{"e:var-x": 1}] * 3 + [{"e:var-x": 2}] * 2, [0.1, -0.1, 0.1, 0.1, 0.1])
    assert repeated(results)
    assert flaky_scenarios(results) == ["e:v -- 1 (x = 1): 2 of 3 hold"]


def test_an_unknown_verdict_makes_no_scenario_flaky() -> None:
    assert flaky_scenarios(run([{"e:var-x": 1}] * 2, [0.1, float("nan")])) == []


def test_many_numbers_are_grouped_as_in_the_tables_of_a_study() -> None:
    results = run([{"e:var-x": number / 10} for number in range(12)], [0.1] * 12)
    (factor,) = factors(results)
    assert len(factor.levels) == 4
    assert factor.levels[0].startswith("0 to 0.275")


def test_a_clause_that_one_execution_lacks_is_not_judged_there() -> None:
    first, second = run([{"e:var-x": 1}, {"e:var-x": 2}], [0.1, -0.1])
    data = matrix_data([first, replace(second, clauses=(replace(second.clauses[0], iri="https://x/d", name="d"),))])
    assert (data["clauses"], data["judged"]) == (["c", "d"], ["h-", "-v"])
