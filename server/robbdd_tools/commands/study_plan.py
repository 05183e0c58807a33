"""``robbdd study plan``: print how many executions a study needs for a given precision or difference."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from robbdd_tools.campaign.exact_power import executions_to_show, pairs_to_show
from robbdd_tools.campaign.rates import StatisticsNotInstalled, executions_for_width
from robbdd_tools.commands import OK
from robbdd_tools.commands.output import fail, print_line


@dataclass(frozen=True, slots=True)
class PlanOptions:
    """The options of ``robbdd study plan``; all numbers are shares (0 to 1).

    - ``rate``: the expected pass rate.
    - ``width``: the wanted width of its interval.
    - ``difference``: the change of the pass rate that a comparison has to show.
    - ``discordance``: the share of pairs whose verdict differs; by default, the size of the difference.
    """

    rate: float
    width: float | None = None
    difference: float | None = None
    discordance: float | None = None
    power: float = 0.8
    level: float = 0.95


def print_plan(options: PlanOptions) -> int:
    """Print the number of executions; return the exit code."""
    if options.width is None and options.difference is None:
        return fail("give --width, the wanted width of the interval, or --difference, the change to show")
    try:
        lines = list(_lines(options))
    except (ValueError, StatisticsNotInstalled) as error:
        return fail(str(error))
    for line in lines:
        print_line(line)
    return OK


def _lines(options: PlanOptions) -> Iterator[str]:
    level = f"{100 * options.level:g} % interval"
    if options.width is not None:
        number = executions_for_width(options.rate, options.width, options.level)
        points = f"{100 * options.width:g} points"
        yield f"{number:,} executions: {level} of {points} at a pass rate of {_percent(options.rate)}"
    if options.difference is None:
        return
    change = abs(options.difference)
    shown = f"a change of {100 * options.difference:+g} points from {_percent(options.rate)}"
    shown += f", power {_percent(options.power)}"
    number = executions_to_show(options.rate, options.difference, options.power, options.level)
    yield f"{number:,} executions before and {number:,} after, independent: {shown}"
    flipped = change if options.discordance is None else options.discordance
    number = pairs_to_show(flipped, options.difference, options.power, options.level)
    assumed = " (no flips back)" if options.discordance is None else ""
    yield f"{number:,} pairs with equal seeds, of which {_percent(flipped)} flip{assumed}: {shown}"


def _percent(share: float) -> str:
    return f"{100 * share:g} %"
