"""Describe the last results of clauses and variants in Markdown."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from robbdd_tools.features.clause_results import substitutions
from robbdd_tools.features.markdown import code, literal
from robbdd_tools.features.pass_rates import pass_rate
from robbdd_tools.features.rejudged_results import MARK
from robbdd_tools.features.scenarios import number_of_scenarios

if TYPE_CHECKING:
    from robbdd_tools.features.clause_results import ResultHint
    from robbdd_tools.features.pass_rates import PassRate
    from robbdd_tools.features.run_verdicts import Findings, JudgedScenario
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.names.variant_places import PlacedVariant

MAX_LISTED = 8
"""Maximum number of listed members, results or places."""


def result_words(hint: ResultHint) -> str:
    """Return the last results of a clause as a list in Markdown."""
    age = "Last results, before the text was edited" if hint.stale else "Last results"
    if hint.rejudged is not None and hint.rejudged.usable:
        age = f"{hint.rejudged.counts} {MARK}"
    lines = [f"- {literal(line)}" for line in hint.lines[:MAX_LISTED]]
    vacuous = [f"- it proves little: {literal(hint.vacuous)}"] if hint.vacuous else []
    substituted = [f"- {literal(words)}" for words in hint.substitutions]
    return f"{age}:\n\n" + "\n".join((*lines, *vacuous, *substituted))


def rate_words(snapshot: Snapshot, variant: PlacedVariant, findings: Findings) -> Iterator[str]:
    """Yield lines about a variant: its pass rate, and the scenarios that did not pass."""
    rate = pass_rate(snapshot, variant, findings, number_of_scenarios(variant))
    if rate is not None:
        yield from rate_lines(variant.definition.symbol.name, rate, findings.variants[variant.iri])


def rate_lines(name: str, rate: PassRate, scenarios: Sequence[JudgedScenario]) -> Iterator[str]:
    """Yield lines about the last executions of a variant or of an execution in a ``.bddx``."""
    yield f"- {code(name)}: {rate.label}"
    yield from (f"  - {literal(words)}" for words in substitutions(scenarios))
    failed = [scenario for scenario in scenarios if scenario.outcome != "holds"]
    for scenario in failed[:MAX_LISTED]:
        judged = sorted(scenario.clauses.values(), key=lambda judgement: judgement.rank)
        words = ", ".join(f"{one.name} {one.said}" for one in judged if one.outcome != "holds")
        yield f"  - {literal(f'{scenario.values}: {words}')}"
    if len(failed) > MAX_LISTED:
        yield f"  - … and {len(failed) - MAX_LISTED} more"
