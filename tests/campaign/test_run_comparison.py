"""Decisions about each clause, and executions that show nothing."""

from __future__ import annotations

import random
from collections.abc import Sequence

import pytest

from campaign.executed import UNKNOWN, executions
from robbdd_tools.campaign.gate import parse_gate
from robbdd_tools.campaign.matched_executions import NothingShared
from robbdd_tools.campaign.run_comparison import Change, ComparisonOptions, Decision, RunComparison, compare_results

FEW = 6
GATE = parse_gate(["no clause worse than 2 points"])


def margins(holding: int, total: int = 200) -> list[float]:
    return [0.1] * holding + [-0.1] * (total - holding)


def compared(
    before: Sequence[float], after: Sequence[float], options: ComparisonOptions | None = None, seed: int = 0
) -> RunComparison:
    return compare_results(executions({"at_goal": before}), executions({"at_goal": after}, seed=seed), options)


def shown(found: RunComparison) -> tuple[Change, Decision]:
    return found.effects[-1].change, found.decision


def test_equal_runs_are_identical_however_few_executions_they_have() -> None:
    found = compared(margins(4, FEW), margins(4, FEW))
    assert shown(found) == (Change.NONE, Decision.IDENTICAL)
    assert [one.name for one in found.effects] == ["every clause", "at_goal"]


def test_runs_without_a_verdict_are_not_identical() -> None:
    assert shown(compared([UNKNOWN] * FEW, [UNKNOWN] * FEW)) == (Change.UNCLEAR, Decision.UNCLEAR)


def test_a_margin_that_moved_is_not_identical() -> None:
    found = compared([0.1] * FEW, [0.1] * (FEW - 1) + [0.2])
    assert shown(found) == (Change.UNCLEAR, Decision.UNCLEAR)


@pytest.mark.parametrize(("after", "change"), [(160, Change.WORSE), (195, Change.UNCLEAR)])
def test_a_drop_is_worse_if_chance_does_not_explain_it(after: int, change: Change) -> None:
    found = compared(margins(200), margins(after))
    assert found.effects[-1].change is change
    assert found.decision is (Decision.WORSE if change is Change.WORSE else Decision.UNCLEAR)


def test_a_rise_is_better_and_accepted_only_by_a_gate() -> None:
    assert shown(compared(margins(150), margins(200))) == (Change.BETTER, Decision.UNCLEAR)
    assert shown(compared(margins(150), margins(200), ComparisonOptions(GATE))) == (Change.BETTER, Decision.ACCEPTED)


def test_a_gate_is_kept_only_if_enough_executions_show_it() -> None:
    options = ComparisonOptions(GATE)
    many, few = [0.1] * 1000, [0.1] * 20
    assert shown(compared(many, [0.2] * 1000, options)) == (Change.NONE, Decision.ACCEPTED)
    assert shown(compared(few, [0.2] * 20, options)) == (Change.UNCLEAR, Decision.UNCLEAR)


def test_a_small_certain_drop_within_the_gate_is_accepted() -> None:
    found = compared(margins(2000, 2000), margins(1990, 2000), ComparisonOptions(GATE))
    assert shown(found) == (Change.WORSE, Decision.ACCEPTED)


def test_pairs_show_what_independent_samples_do_not() -> None:
    before, after = margins(180), margins(172)
    assert compared(before, after).effects[-1].change is Change.WORSE
    unpaired = compared(before, after, seed=1000)
    assert not unpaired.matched.paired
    assert shown(unpaired) == (Change.UNCLEAR, Decision.UNCLEAR)


def test_an_unknown_verdict_speaks_for_nothing() -> None:
    after = [UNKNOWN] * 30 + [0.1] * 170
    found = compared([0.1] * 200, after, ComparisonOptions(GATE))
    effect = found.effects[-1]
    assert shown(found) == (Change.UNCLEAR, Decision.UNCLEAR)
    assert (effect.rates.difference, effect.after.unknown) == (0.0, 30)
    assert effect.rates.interval.low < -0.15 < 0.0 < effect.rates.interval.high


def test_unknown_verdicts_hide_no_drop_that_the_others_show() -> None:
    after = [UNKNOWN] * 5 + [-0.1] * 60 + [0.1] * 135
    assert compared([0.1] * 200, after).decision is Decision.WORSE


def test_margins_decide_if_they_are_asked_for() -> None:
    chance = random.Random(1)
    before = [0.1 + chance.gauss(0, 0.01) for _ in range(100)]
    after = [margin - 0.005 + chance.gauss(0, 0.005) for margin in before]
    by_rate, by_margin = compared(before, after), compared(before, after, ComparisonOptions(by_margin=True))
    assert (by_rate.effects[-1].change, by_margin.effects[-1].change) == (Change.UNCLEAR, Change.WORSE)
    effect = by_margin.effects[-1].margins
    assert effect is not None
    assert (effect.executions, effect.unit) == (100, "m")
    assert effect.interval.low < -0.005 < effect.interval.high < 0.0


@pytest.mark.parametrize(("seed", "few", "enough"), [(0, 5, 6), (1000, 3, 4)])
def test_margins_that_all_move_alike_show_nothing_until_chance_would_not_align_them(
    seed: int, few: int, enough: int
) -> None:
    """The sign test of pairs needs 6 executions to reject at 5 %, the permutation test of two samples 4 of each."""
    options = ComparisonOptions(
        parse_gate(["at_goal not worse than 30 mm", "no clause worse than 99 points"]), 0.95, True
    )
    found = compared([0.5] * few, [0.484] * few, options, seed)
    assert (shown(found), found.effects[-1].margins) == ((Change.UNCLEAR, Decision.UNCLEAR), None)
    found = compared([0.5] * enough, [0.484] * enough, options, seed)
    assert found.effects[-1].change is Change.WORSE
    assert found.effects[-1].margins is not None
    assert found.effects[-1].margins.interval.high == pytest.approx(-0.016)


@pytest.mark.parametrize("paired", [True, False])
@pytest.mark.parametrize("count", [1, 2, 3, 5])
def test_few_executions_with_margins_of_two_values_raise_no_more_false_alarms_than_stated(
    count: int, paired: bool
) -> None:
    """Times are multiples of a tick, so margins of equal controllers often tie."""
    chance, alarms, repeats = random.Random(count), 0, 200
    for _ in range(repeats):
        before, after = ([0.5 + 0.016 * chance.randrange(2) for _ in range(count)] for _ in range(2))
        found = compared(before, after, ComparisonOptions(by_margin=True), seed=1000 * (not paired))
        alarms += any(one.change in (Change.WORSE, Change.BETTER) for one in found.effects)
    assert alarms / repeats <= 0.05 + 3 * (0.05 * 0.95 / repeats) ** 0.5


@pytest.mark.parametrize("count", [0, 1, 2, 40])
@pytest.mark.parametrize(("before", "after"), [(0.1, 0.1), (-0.1, -0.1), (0.1, -0.1), (-0.1, 0.1)])
@pytest.mark.parametrize("paired", [True, False])
def test_runs_in_which_everything_passes_or_fails_are_compared(
    count: int, before: float, after: float, paired: bool
) -> None:
    one, other = executions({"c": [before] * count}), executions({"c": [after] * count}, seed=1000 * (not paired))
    if count == 0:
        with pytest.raises(NothingShared):
            compare_results(one, other)
        return
    change, decision = shown(compare_results(one, other))
    if before == after:
        assert decision is (Decision.IDENTICAL if paired else Decision.UNCLEAR)
        assert change is (Change.NONE if paired else Change.UNCLEAR)
    elif count < 40:
        assert (change, decision) == (Change.UNCLEAR, Decision.UNCLEAR)
    else:
        assert change is (Change.WORSE if before > after else Change.BETTER)
        assert decision is (Decision.WORSE if before > after else Decision.UNCLEAR)


def test_a_gate_in_a_unit_limits_the_mean_margin() -> None:
    before = [0.1, 0.11] * 50
    after = [margin - 0.002 for margin in before]
    for limit, decision in (("3 mm", Decision.ACCEPTED), ("1 mm", Decision.WORSE)):
        gate = parse_gate([f"at_goal not worse than {limit}", "no clause worse than 10 points"])
        assert compared(before, after, ComparisonOptions(gate, by_margin=True)).decision is decision


def test_a_margin_that_one_side_lacks_keeps_no_gate() -> None:
    gate = parse_gate(["at_goal not worse than 3 mm", "no clause worse than 10 points"])
    found = compared([0.1] * 200, [0.1] * 199 + [UNKNOWN], ComparisonOptions(gate))
    assert found.decision is Decision.UNCLEAR


def test_a_clause_that_is_no_longer_judged_may_be_worse() -> None:
    before, after = executions({"at_goal": [0.1] * FEW, "held": [0.1] * FEW}), executions({"at_goal": [0.1] * FEW})
    found = compare_results(before, after)
    assert (found.matched.removed, found.decision) == (("held",), Decision.UNCLEAR)
    assert compare_results(after, before).matched.added == ("held",)


def test_executions_of_one_run_alone_are_counted() -> None:
    matched = compared([0.1] * 5, [0.1] * 3).matched
    assert (matched.shared, matched.before_only, matched.after_only) == (3, 2, 0)


def test_runs_of_other_scenarios_share_nothing() -> None:
    with pytest.raises(NothingShared, match="no execution"):
        compare_results(executions({"at_goal": [0.1]}), [])
    with pytest.raises(NothingShared, match="no clause"):
        compare_results(executions({"at_goal": [0.1]}), executions({"held": [0.1]}))


def test_margins_of_another_unit_are_not_compared() -> None:
    found = compare_results(executions({"at_goal": [0.1] * 3}), executions({"at_goal": [0.2] * 3}, unit="m/s"))
    assert found.effects[-1].margins is None


@pytest.mark.parametrize("paired", [True, False])
@pytest.mark.parametrize("count", [300, pytest.param(10_000, marks=pytest.mark.nightly)])
def test_equal_controllers_are_called_different_no_more_often_than_stated(count: int, paired: bool) -> None:
    """Compare runs of the same controller: three clauses, 60 executions each."""
    chance, alarms = random.Random(count + paired), 0
    for _ in range(count):
        before, after = (
            executions(_drawn(chance, (0.9, 0.7, 0.97), 60), seed=number * 1000 * (not paired)) for number in range(2)
        )
        found = compare_results(before, after, ComparisonOptions(by_margin=True))
        alarms += any(one.change in (Change.WORSE, Change.BETTER) for one in found.effects)
    print(f"{alarms} false alarms in {count} comparisons")
    # Three standard deviations above the stated 5 %.
    assert alarms / count <= 0.05 + 3 * (0.05 * 0.95 / count) ** 0.5


def _drawn(chance: random.Random, rates: Sequence[float], count: int) -> dict[str, list[float]]:
    """Draw margins that are positive with a probability."""
    return {f"c{number}": [chance.random() - (1 - rate) for _ in range(count)] for number, rate in enumerate(rates)}
