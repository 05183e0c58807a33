"""Execute the scenarios of a study at points of its ranges, always with the same seeds."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.campaign.designs import value_at
from robbdd_tools.campaign.failure_search import Evaluation, Point
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.messages import ScenarioFinished
from robbdd_tools.protocol.specs import plain_name
from robbdd_tools.run.readable import clause_title
from robbdd_tools.run.store import begin_in
from robbdd_tools.workbench.plan import Plan
from robbdd_tools.workbench.points import Points, common_seeds
from robbdd_tools.workbench.run import Run

if TYPE_CHECKING:
    from robbdd_tools.campaign.study_file import Study
    from robbdd_tools.run.results import ScenarioResult
    from robbdd_tools.run.run_policy import Policy

NO_MARGIN = 1.0
"""Robustness of an execution without a deciding margin: it counts as being as far from failing as nominal."""


class SearchEnded(RobbddError):
    """A search was interrupted, or its executions could not be made; the message gives the reason."""


@dataclass(slots=True)
class PointRuns:
    """Executes points, each with the same ``repeat`` seeds, which follow from ``seed``.

    The robustness of an execution is the smallest margin of its clauses, each divided by its margin at the first
    evaluated point, so that margins of different units can be compared. An unknown verdict is no failure; ``reason`` is
    why the first such execution is unknown.
    """

    study: Study
    policy: Policy
    repeat: int
    seed: int = 1
    executions: int = 0
    unknown: int = 0
    reason: str = ""
    on_progress: Callable[[int], None] = lambda _: None
    _scales: dict[str, float] = field(default_factory=dict[str, float])
    _run: Run | None = None
    _ending: str = ""

    def cancel(self, reason: str) -> None:
        """End the executions. It may be called from any thread or signal handler."""
        self._ending = self._ending or reason
        if self._run is not None:
            self._run.cancel(reason)

    def values(self, point: Point) -> tuple[float, ...]:
        """Return the values of the variables at a point of the unit box."""
        return tuple(map(value_at, self.study.content.ranges, point))

    def written(self, point: Point, group: Sequence[ScenarioResult]) -> list[str]:
        """Return the values at a point as the model writes them: with a unit if its values are quantities.

        ``group`` are some executions of the study.
        """
        quantities = {
            plain_name(name) for one in group for name, value in one.spec.values.items() if isinstance(value, str)
        }
        return [
            f"{value!r} {one.unit}" if one.unit and _plain(one.variable.text) in quantities else repr(value)
            for one, value in zip(self.study.content.ranges, self.values(point), strict=True)
        ]

    def evaluate(self, points: Sequence[Point]) -> list[Evaluation]:
        """Execute all scenarios at some points. Raises ``SearchEnded`` and the errors of ``Run.begin``."""
        groups = self._executed([self.values(point) for point in points], self.seed)
        return [self._evaluation(point, group) for point, group in zip(points, groups, strict=True)]

    def failing(self, point: Point, seed: int) -> tuple[int, list[ScenarioResult]]:
        """Return how many executions at a point fail with seeds that follow from ``seed``, and the executions."""
        (group,) = self._executed([self.values(point)], seed)
        return sum(map(fails, group)), group

    def _executed(self, rows: Sequence[tuple[float, ...]], seed: int) -> list[list[ScenarioResult]]:
        assert self.study.model is not None
        ranges = self.study.content.ranges
        texts, names = [one.variable.text for one in ranges], [_plain(one.variable.text) for one in ranges]
        units = tuple(one.unit for one in ranges)
        found: dict[tuple[float, ...], list[ScenarioResult]] = {row: [] for row in rows}
        for cell in self.study.cells:
            chosen = replace(cell.plan.selection, points=Points(tuple(texts), tuple(found), units=units))
            plan = Plan.of(self.study.model, chosen)
            seeded = tuple(replace(one, completed=common_seeds(names, seed)) for one in plan.requests)
            for one in self._results(replace(plan, requests=seeded)):
                own = {plain_name(name): value for name, value in one.spec.values.items()}
                for row, group in found.items():
                    wanted = zip(names, row, units, strict=True)
                    if all(own.get(name, value) in (value, f"{value!r} {unit}") for name, value, unit in wanted):
                        group.append(one)
        return [found[row] for row in rows]

    def _results(self, plan: Plan) -> list[ScenarioResult]:
        folder = tempfile.mkdtemp(prefix="robbdd-")

        def remove() -> None:
            shutil.rmtree(folder, ignore_errors=True)

        place = begin_in(Path(folder), kept=False)
        with Run.begin(plan, place, self.policy, repeat=self.repeat, on_close=remove) as run:
            self._run = run
            if self._ending:
                run.cancel(self._ending)
            for message in run.messages():
                if isinstance(message, ScenarioFinished):
                    self.executions += 1
                    self.on_progress(self.executions)
            ending = run.problem or self._ending or run.ending
            if ending:
                raise SearchEnded(ending)
            return run.progress.scenarios

    def _evaluation(self, point: Point, group: Sequence[ScenarioResult]) -> Evaluation:
        unknown = [one for one in group if one.verdict is Outcome.UNKNOWN]
        self.unknown += len(unknown)
        self.reason = self.reason or next((_why_unknown(one) for one in unknown), "")
        robustness = min((self._robustness(one) for one in group), default=NO_MARGIN)
        return Evaluation(point, robustness, any(map(fails, group)))

    def _robustness(self, scenario: ScenarioResult) -> float:
        found = -NO_MARGIN if fails(scenario) else NO_MARGIN
        for clause in scenario.spec.clauses:
            judged = scenario.judged.get(clause.line)
            if judged is None or judged.robustness is None or not judged.unit or not isfinite(judged.robustness):
                continue
            scale = self._scales.setdefault(clause.iri, abs(judged.robustness) or 1.0)
            # A margin of the other sign belongs to a clause that did not decide.
            found = min(found, judged.robustness / scale)
        return found


def fails(scenario: ScenarioResult) -> bool:
    """Return whether a clause of an execution is violated."""
    return scenario.verdict is Outcome.VIOLATED


def _why_unknown(scenario: ScenarioResult) -> str:
    """Return the clause that is the first to be unknown, and the reason."""
    for clause in scenario.spec.clauses:
        judged = scenario.judged.get(clause.line)
        if judged is not None and judged.verdict == Outcome.UNKNOWN:
            return f"{clause_title(clause)}: {judged.reason}"
    return ""


def _plain(variable: str) -> str:
    """Return the name of a variable without its template or prefix."""
    return plain_name(variable.rpartition(".")[2])
