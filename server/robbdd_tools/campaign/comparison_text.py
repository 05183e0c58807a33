"""A comparison in words: lines for a terminal, Markdown for a summary of continuous integration."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from robbdd_tools.campaign.exact_power import executions_to_show, pairs_to_show
from robbdd_tools.campaign.markdown_text import escaped, markdown_table
from robbdd_tools.campaign.run_comparison import Change, ClauseEffect, Decision, RunComparison
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.report import MINUS, SIGNS, margin

if TYPE_CHECKING:
    from robbdd_tools.campaign.effects import MarginEffect, Rate
    from robbdd_tools.workbench.comparison import ClauseChange, ExecutionChange

HEADER = ("clause", "before", "after", "change of pass rate", "change of margin", "result")
POWER = 0.8


def method_words(found: RunComparison) -> str:
    """Describe how the executions were compared."""
    matched = found.matched
    count = f"{matched.shared} shared execution{'s' * (matched.shared != 1)}"
    how = (
        "in pairs: all seeds are equal"
        if matched.paired
        else "as two independent samples: the seeds differ, so that small changes are hard to show"
    )
    return f"{count}, compared {how}"


def remarks(found: RunComparison) -> Iterator[str]:
    """Describe the executions and clauses that were not compared."""
    matched = found.matched
    for count, side in ((matched.before_only, "earlier"), (matched.after_only, "later")):
        if count:
            yield f"{count} execution{'s are' if count > 1 else ' is'} of the {side} run alone and not compared"
    for names, side in ((matched.removed, "earlier"), (matched.added, "later")):
        if names:
            yield f"not compared: only the {side} run judges {', '.join(names)}"


def cells(effect: ClauseEffect) -> tuple[str, ...]:
    """Return the row of a clause, in the order of ``HEADER``."""
    margins = effect.margins
    moved = "" if margins is None else _margins(margins)
    return (effect.name, _rate(effect.before), _rate(effect.after), _points(effect), moved, result_words(effect))


def result_words(effect: ClauseEffect) -> str:
    """Describe the result of a clause."""
    if effect.identical:
        return "identical"
    if effect.change is Change.WORSE and effect.accepted:
        return "worse, within the gate"
    return str(effect.change)


def table(found: RunComparison) -> list[str]:
    """Return the clauses as aligned lines, the header first."""
    rows = [HEADER, *map(cells, found.effects)]
    widths = [max(len(row[column]) for row in rows) for column in range(len(HEADER))]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]


def conclusion(found: RunComparison) -> str:
    """Return the decision in one sentence."""
    if found.decision is Decision.IDENTICAL:
        return "identical: every verdict and every margin is the same"
    if found.decision is Decision.ACCEPTED:
        return f"accepted: no clause is worse than the gate allows (confidence {found.level:.0%})"
    if found.decision is Decision.WORSE:
        worse = [one for one in found.effects if one.change is Change.WORSE and not one.accepted]
        # Name single clauses rather than the row of all clauses.
        worse = [one for one in worse if one.iri] or worse
        return f"worse: {', '.join(f'{one.name} ({_points(one)})' for one in worse)}"
    open_ = [one.name for one in found.effects if not one.accepted]
    missing = f"; no longer judged: {', '.join(found.matched.removed)}" if found.matched.removed else ""
    return (
        f"the executions do not show whether these are worse: {', '.join(open_)}{missing}"
        if open_
        else f"the executions do not tell{missing}"
    )


def advice(found: RunComparison, accepted: float | None) -> str:
    """Describe how many executions would show a drop by ``accepted`` (a share). Empty if the decision is made."""
    if found.decision is not Decision.UNCLEAR:
        return ""
    if accepted is None:
        return "state the change that you accept: --gate 'no clause worse than 2 points'"
    unclear = [one for one in found.effects if not one.accepted]
    if not unclear or accepted <= 0.0:
        return ""
    needed = max(_needed(one, accepted, found) for one in unclear)
    kind = "executions with the same seeds" if found.matched.paired else "executions of each run"
    return f"about {needed} {kind} show a drop of {_number(accepted * 100)} points with a probability of {POWER:.0%}"


def markdown(title: str, found: RunComparison, notes: Sequence[str]) -> str:
    """Return the comparison as a Markdown document."""
    rows = (list(map(escaped, cells(effect))) for effect in found.effects)
    listed = "".join(f"- {escaped(note)}\n" for note in notes)
    return (
        f"## {escaped(title)}\n\n**{escaped(conclusion(found))}**\n\n"
        f"{method_words(found)}; intervals of {found.level:.0%}.\n\n"
        f"{listed}\n{markdown_table(HEADER, rows)}\n"
    )


def deciding_clauses(change: ExecutionChange) -> Sequence[ClauseChange]:
    """Return the clauses that explain a flip: those that are violated now or, if there are none, all that changed."""
    return [clause for clause in change.clauses if clause.after is Outcome.VIOLATED] or change.clauses


def moved_words(clause: ClauseChange) -> str:
    """Return the verdicts and margins of a clause before and after."""
    old = f"{SIGNS[clause.before]} {margin(clause.margin_before, clause.unit)}" if clause.before else "—"
    new = f"{SIGNS[clause.after]} {margin(clause.margin_after, clause.unit)}" if clause.after else "—"
    return f"{old.strip()} → {new.strip()}"


def signed(value: float) -> str:
    """Return a number with its sign and one decimal."""
    rounded = f"{abs(value):.1f}"
    return rounded if float(rounded) == 0.0 else f"{MINUS if value < 0 else '+'}{rounded}"


def _needed(effect: ClauseEffect, accepted: float, found: RunComparison) -> int:
    if found.matched.paired:
        flipped = (effect.rates.gained + effect.rates.lost + 1) / (effect.before.total + 2)
        return pairs_to_show(min(1.0, max(flipped, accepted)), accepted, POWER, found.level)
    share = (effect.before.holding + 1) / (effect.before.total + 2)
    return executions_to_show(max(share, accepted), -accepted, POWER, found.level)


def _rate(counted: Rate) -> str:
    unknown = f", {counted.unknown} unknown" if counted.unknown else ""
    return f"{counted.holding}/{counted.total}{unknown}"


def _points(effect: ClauseEffect) -> str:
    """Return the change of the pass rate in points, with its interval."""
    low, high = (signed(value * 100) for value in (effect.rates.interval.low, effect.rates.interval.high))
    difference = effect.rates.difference
    moved = "unknown" if difference is None else f"{signed(difference * 100)} points"
    return f"{moved} [{low}, {high}]"


def _margins(effect: MarginEffect) -> str:
    values = (effect.difference, effect.interval.low, effect.interval.high)
    mean, low, high = (margin(value, effect.unit) for value in values)
    return f"{mean} [{low}, {high}]"


def _number(value: float) -> str:
    return f"{value:g}"
