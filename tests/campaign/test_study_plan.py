"""``robbdd study plan``: numbers of executions, checked by the intervals and tests that they are for."""

from __future__ import annotations

import pytest

from robbdd_tools.campaign.rates import executions_for_width, executions_needed, pairs_needed, rate_interval
from robbdd_tools.cli import main


@pytest.mark.parametrize(("rate", "width"), [(0.5, 0.1), (0.9, 0.05), (0.8, 0.2), (1.0, 0.05), (0.0, 0.3)])
def test_the_number_is_the_smallest_with_that_width(rate: float, width: float) -> None:
    number = executions_for_width(rate, width)
    # Only whole executions hold: with a multiple of the number, the rate is exact.
    found = rate_interval(round(rate * number), number)
    assert found.high - found.low == pytest.approx(width, rel=0.02)
    fewer = rate_interval(round(rate * number * 0.9), round(number * 0.9))
    assert fewer.high - fewer.low > width


def test_both_kinds_of_comparison_are_planned(capsys: pytest.CaptureFixture[str]) -> None:
    assert (
        main(["study", "plan", "--rate", "0.9", "--width", "0.05", "--difference", "-0.05", "--discordance", "0.1"])
        == 0
    )
    width, independent, paired = capsys.readouterr().out.splitlines()
    assert width == f"{executions_for_width(0.9, 0.05)} executions: 95 % interval of 5 points at a pass rate of 90 %"
    number = executions_needed(0.9, -0.05)
    assert independent.startswith(
        f"{number} executions before and {number} after, independent: a change of -5 points from 90 %"
    )
    assert paired.startswith(f"{pairs_needed(0.1, -0.05)} pairs with equal seeds, of which 10 % flip: ")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "give --width, the wanted width of the interval, or --difference, the change to show"),
        (["--width", "2"], "the width between 0 and 1"),
        (["--difference", "0.2"], "both pass rates have to be from 0 to 1, and to differ"),
        (["--difference", "-0.2", "--discordance", "0.1"], "the difference has to be above 0"),
    ],
)
def test_numbers_that_make_no_plan_are_refused(
    capsys: pytest.CaptureFixture[str], arguments: list[str], message: str
) -> None:
    assert main(["study", "plan", *arguments]) == 2
    printed = capsys.readouterr()
    assert message in printed.err
    assert printed.out == ""
