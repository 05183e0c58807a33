"""Count the executions of a study by the first violated clause, and collect the margins of a clause."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.campaign.study_clauses import clause_named, clause_words
from robbdd_tools.campaign.value_bins import bins_of, in_order
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.report import value_word, variable_word

if TYPE_CHECKING:
    from robbdd_tools.campaign.value_bins import Bins

HOLDS, UNKNOWN = "holds", "unknown"
_LEVEL = "level."
_EXECUTION = ("scenario", "execution", "repetition", "seed")

Row = Mapping[str, Any]
"""A clause of an execution, as exported."""


class NoSuchFactor(RobbddError):
    """A study has no factor, variable or clause of a name."""


@dataclass(frozen=True, slots=True)
class OutcomeTable:
    """The number of executions with each outcome.

    - ``factors``: the names of the factors.
    - ``rows``: for each row of ``counts``, a combination of levels, as words.
    - ``outcomes``: for each column of ``counts``, ``holds``, the name of the first violated clause, or ``unknown``.
    - ``counts``: executions, rows × columns.
    """

    factors: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    outcomes: tuple[str, ...]
    counts: tuple[tuple[int, ...], ...]


@dataclass(frozen=True, slots=True)
class Margins:
    """The margins of a clause, in ``unit``, in executions that hold, grouped by the levels of a factor (as words)."""

    clause: str
    factor: str
    unit: str
    levels: Mapping[str, Sequence[float]]


def outcome_table(rows: Iterable[Row], by: Sequence[str] = ()) -> OutcomeTable:
    """Count executions by the levels of some factors or variables, and by outcome.

    The outcome of a violated execution is its first violated clause in the order of the scenario, where behave would
    stop. Without names, all factors with several levels are used. Raises ``NoSuchFactor``.
    """
    found_levels = list(_executions(rows))
    bins = bins_of(levels for levels, _ in found_levels)
    executions = [(_words(levels, bins), outcome) for levels, outcome in found_levels]
    factors = tuple(by) or _varied(levels for levels, _ in executions)
    for name in factors:
        _refuse_unknown(name, (levels for levels, _ in executions))
    counts: dict[tuple[str, ...], dict[str, int]] = {}
    found: dict[str, None] = {}
    for levels, outcome in executions:
        cell = counts.setdefault(tuple(levels.get(name, "") for name in factors), {})
        cell[outcome] = cell.get(outcome, 0) + 1
        found[outcome] = None
    for place in reversed([place for place, name in enumerate(factors) if _bins(name, bins)]):
        order = in_order({cell[place] for cell in counts}, _bins(factors[place], bins))
        counts = dict(sorted(counts.items(), key=lambda one, place=place, order=order: order.index(one[0][place])))
    violated = [outcome for outcome in found if outcome not in (HOLDS, UNKNOWN)]
    outcomes = (HOLDS, *violated, *(one for one in (UNKNOWN,) if one in found))
    table = tuple(tuple(cell.get(outcome, 0) for outcome in outcomes) for cell in counts.values())
    return OutcomeTable(factors, tuple(counts), outcomes, table)


def margins(rows: Iterable[Row], clause: str, factor: str) -> Margins:
    """Return the margins of a clause in executions whose clauses all hold; raises ``NoSuchFactor``."""
    found: dict[str, list[float]] = {}
    unit, known = "", dict[str, None]()
    judged: list[tuple[Mapping[str, Any], float | None]] = []
    for row in rows:
        known[row["clause"]] = None
        if clause in (row["clause"], clause_words(row["clause"])):
            margin = row["margin"] if row["scenario_verdict"] == HOLDS else None
            unit = unit if margin is None else row["unit"]
            judged.append((_levels(row), None if margin is None else float(margin)))
    bins = bins_of(levels for levels, _ in judged)
    every = [_words(levels, bins) for levels, _ in judged]
    for levels, (_, margin) in zip(every, judged, strict=True):
        if margin is not None:
            found.setdefault(levels.get(factor, ""), []).append(margin)
    if clause_named(clause, known) is None:
        raise NoSuchFactor(f"the study has no clause '{clause}'; it has {', '.join(map(clause_words, known))}")
    _refuse_unknown(factor, every)
    return Margins(clause, factor, unit, {level: found[level] for level in in_order(found, _bins(factor, bins))})


def _executions(rows: Iterable[Row]) -> Iterator[tuple[Mapping[str, Any], str]]:
    """Yield the levels of each execution, and its outcome."""
    for _, group in groupby(rows, key=lambda row: tuple(row[name] for name in _EXECUTION)):
        clauses = list(group)
        first = next((row for row in clauses if row["verdict"] == Outcome.VIOLATED), None)
        verdict = clauses[0]["scenario_verdict"]
        yield _levels(clauses[0]), verdict if first is None else clause_words(str(first["clause"]))


def _levels(row: Row) -> Mapping[str, Any]:
    return {name.removeprefix(_LEVEL): value for name, value in row.items() if name.startswith(_LEVEL)}


def _words(levels: Mapping[str, Any], bins: Mapping[str, Bins]) -> Mapping[str, str]:
    return {
        variable_word(name): bins[name].word(value) if name in bins else value_word(value)
        for name, value in levels.items()
    }


def _bins(factor: str, bins: Mapping[str, Bins]) -> Bins | None:
    return next((found for name, found in bins.items() if variable_word(name) == factor), None)


def _varied(executions: Iterable[Mapping[str, str]]) -> tuple[str, ...]:
    levels: dict[str, set[str]] = {}
    for execution in executions:
        for name, value in execution.items():
            levels.setdefault(name, set()).add(value)
    return tuple(name for name, values in levels.items() if len(values) > 1)


def _refuse_unknown(name: str, executions: Iterable[Mapping[str, str]]) -> None:
    known = dict.fromkeys(factor for levels in executions for factor in levels)
    if name not in known:
        raise NoSuchFactor(f"the study has no factor or variable '{name}'; it has {', '.join(known)}")
