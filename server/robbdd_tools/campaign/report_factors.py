"""The part of a report about factors: effects of their levels, confounded factors, and flaky scenarios."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.printable import printable
from robbdd_tools.campaign.comparison_text import signed
from robbdd_tools.campaign.factor_effects import confounded, level_effects
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.readable import title
from robbdd_tools.run.report import value_words

if TYPE_CHECKING:
    from robbdd_tools.campaign.factor_effects import Confounding, LevelEffect
    from robbdd_tools.campaign.report_data import Factor
    from robbdd_tools.workbench.execution_rows import ExecutionResult

MOST_LEVELS = 30
"""Factors with more levels have no table of effects."""
LETTERS = {Outcome.HOLDS: "h", Outcome.VIOLATED: "v", Outcome.UNKNOWN: "u"}
NOT_JUDGED = "-"


@dataclass(frozen=True, slots=True)
class EffectRow:
    """The effect of one level of a factor, in words."""

    factor: str
    level: str
    holding: int
    total: int
    rate: str
    against: str


def effect_rows(factors: Sequence[Factor], results: Sequence[ExecutionResult]) -> list[EffectRow]:
    """Compare each level of a factor with its other levels. Raises ``StatisticsNotInstalled``."""
    holds = [result.verdict is Outcome.HOLDS for result in results]
    shown = [one for one in factors if len(one.levels) <= MOST_LEVELS]
    return [_words(found) for one in shown for found in level_effects(one.name, one.levels, one.of, holds)]


def confounding_words(factors: Sequence[Factor]) -> list[str]:
    """Describe the factors that are confounded, fully or in part."""
    shown = [one for one in factors if len(one.levels) <= MOST_LEVELS]
    found = list(confounded([one.name for one in shown], [one.of for one in shown]))
    return [*_inseparable(found), *_unbalanced(found)]


def flaky_scenarios(results: Sequence[ExecutionResult]) -> list[str]:
    """Return the scenarios that hold in some of their executions and are violated in others, in words."""
    verdicts: dict[str, list[Outcome]] = {}
    varied = _varied(results)
    for result in results:
        verdicts.setdefault(_scenario(result, varied), []).append(result.verdict)
    return [
        f"{name}: {found.count(Outcome.HOLDS)} of {len(found)} hold"
        for name, found in verdicts.items()
        if {Outcome.HOLDS, Outcome.VIOLATED} <= set(found)
    ]


def repeated(results: Sequence[ExecutionResult]) -> bool:
    """Return whether a scenario was executed more than once."""
    varied = _varied(results)
    return len({_scenario(result, varied) for result in results}) < len(results)


def matrix_data(results: Sequence[ExecutionResult]) -> Mapping[str, Any]:
    """Return scenarios × clauses for the page: their names and, per execution, its scenario and a letter per clause."""
    scenarios: dict[str, int] = {}
    clauses: dict[str, tuple[int, str]] = {}
    varied = _varied(results)
    names = [_scenario(result, varied) for result in results]
    for name, result in zip(names, results, strict=True):
        scenarios.setdefault(name, len(scenarios))
        for clause in result.clauses:
            clauses.setdefault(clause.iri, (len(clauses), title(clause.name, clause.sentence)))
    judged: list[str] = []
    for result in results:
        letters = [NOT_JUDGED] * len(clauses)
        for clause in result.clauses:
            place = clauses[clause.iri][0]
            # A clause that is repeated in an execution counts with its worst verdict.
            letters[place] = max(letters[place], LETTERS[clause.verdict], key="-huv".index)
        judged.append("".join(letters))
    return {
        "scenarios": [printable(name) for name in scenarios],
        "clauses": [printable(name) for _, name in clauses.values()],
        "of": [scenarios[name] for name in names],
        "judged": judged,
    }


def _varied(results: Sequence[ExecutionResult]) -> Set[str]:
    """Return the variables that have several values."""
    values: dict[str, set[str]] = {}
    for result in results:
        for name, value in result.values.items():
            values.setdefault(name, set()).add(json.dumps(value, sort_keys=True))
    return {name for name, found in values.items() if len(found) > 1}


def _scenario(result: ExecutionResult, varied: Set[str]) -> str:
    """Return the name of a scenario with those of its values that vary. All its repetitions have the same name."""
    shown = [value_words(name, value) for name, value in result.values.items() if name in varied]
    if result.execution:
        shown.insert(0, value_words("execution", result.execution))
    name = result.name.partition(" (repetition ")[0]
    return f"{name} ({', '.join(shown)})" if shown else name


def _words(found: LevelEffect) -> EffectRow:
    low, high = 100 * found.interval.low, 100 * found.interval.high
    rate = f"{100 * found.holding / found.total:.1f} % [{low:.1f} %, {high:.1f} %]" if found.total else "no executions"
    ends = ", ".join(signed(100 * end) for end in (found.change.low, found.change.high))
    against = f"{signed(100 * found.difference)} points [{ends}]"
    return EffectRow(found.factor, found.level, found.holding, found.total, rate, against)


def _inseparable(found: Sequence[Confounding]) -> Iterator[str]:
    """Yield the groups of factors whose levels always occur together."""
    groups: list[set[str]] = []
    for one in found:
        if one.inseparable:
            joined = [group for group in groups if group & set(one.factors)]
            groups = [group for group in groups if group not in joined] + [set(one.factors).union(*joined)]
    for group in groups:
        yield f"{' and '.join(sorted(group))} have the same effect here: each level of one occurs with one of the other"


def _unbalanced(found: Sequence[Confounding]) -> Iterator[str]:
    for one in found:
        first, second = one.factors
        if one.inseparable:
            continue
        if one.nested:
            yield f"each level of {first} occurs with one level of {second} only, so {second} has no effect of its own"
            continue
        yield (
            f"{first} and {second} are not balanced (Cramér's V {one.strength:.2f}): a part of the effect of one "
            "may be that of the other"
        )


def script_json(data: object) -> str:
    """Return data as JSON for a script element, without any end tag."""
    return json.dumps(data).replace("<", "\\u003c")
