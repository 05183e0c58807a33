"""The failures of a run by their causes, for the end of its report."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from itertools import chain
from typing import TYPE_CHECKING

from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.consequences import consequences
from robbdd_tools.run.readable import clause_title, readable
from robbdd_tools.run.report import SIGNS, failure_words

if TYPE_CHECKING:
    from robbdd_tools.protocol.messages import ClauseJudged
    from robbdd_tools.protocol.specs import ClauseSpec
    from robbdd_tools.run.results import ScenarioResult

MAX_CAUSES = 5
"""Maximum number of causes that are listed."""
_MEASURED = re.compile(r"\d+\.\d+")


def failure_summary(
    scenarios: Iterable[ScenarioResult], errors: Mapping[str, int] | None = None
) -> list[tuple[Outcome, str]]:
    """Return a line for each cause of failures, most frequent first: its clause, its reason and its scenarios' number.

    A loop may have several clauses of one title in a scenario. Clauses that are unknown only because of another one do
    not count. The line shows the worst margin of all its scenarios. Reasons that differ only in measured numbers ("it
    took 8.14 s") are one cause. ``errors`` maps the printed faults in users' code to their numbers, which replace
    reasons.
    """
    groups: dict[tuple[Outcome, str, str], dict[int, list[tuple[ClauseSpec, ClauseJudged]]]] = {}
    for index, scenario in enumerate(scenarios):
        for clause, judged in _causes(scenario):
            number = (errors or {}).get(judged.fault)
            if number is not None:
                judged = replace(judged, reason=f"no evidence, because of error {number}")
            reason = _MEASURED.sub("", judged.reason)
            cause = Outcome(judged.verdict), clause_title(clause), reason
            groups.setdefault(cause, {}).setdefault(index, []).append((clause, judged))
    found = sorted(groups.items(), key=lambda group: (-len(group[1]), group[0][0] is not Outcome.VIOLATED))
    lines = [(outcome, _line(outcome, name, failures)) for (outcome, name, _), failures in found[:MAX_CAUSES]]
    if len(found) > MAX_CAUSES:
        more = len(found) - MAX_CAUSES
        lines.append((Outcome.UNKNOWN, f"… and {more} more cause{'s' if more > 1 else ''}"))
    return lines


def _causes(scenario: ScenarioResult) -> Iterator[tuple[ClauseSpec, ClauseJudged]]:
    clauses = [(one, scenario.judged[one.line]) for one in scenario.spec.clauses if one.line in scenario.judged]
    named = [(clause_title(clause), judged) for clause, judged in clauses]
    for (clause, judged), because in zip(clauses, consequences(named), strict=True):
        if judged.verdict != Outcome.HOLDS and because is None:
            yield clause, readable(judged, scenario.spec)


def _line(outcome: Outcome, name: str, failures: Mapping[int, list[tuple[ClauseSpec, ClauseJudged]]]) -> str:
    every = chain.from_iterable(failures.values())
    clause, worst = min(every, key=lambda failure: failure[1].robustness or 0.0)
    if len(failures) == 1:
        return f"{SIGNS[outcome]} {name}: {failure_words(worst, clause)}"
    count = f"in {len(failures)} scenarios{'' if worst.robustness is None else ', worst'}"
    return f"{SIGNS[outcome]} {name} {count}: {failure_words(worst, clause)}"
