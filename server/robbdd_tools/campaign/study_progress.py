"""The progress of a study: its verdicts so far, its speed, and the work of its workers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.workbench.time_estimate import TimeEstimate

if TYPE_CHECKING:
    from robbdd_tools.run.results import ScenarioResult
    from robbdd_tools.run.study_reader import StudyReader


@dataclass(slots=True)
class Tally:
    """The finished executions by their verdicts, and the verdicts on each clause by its name."""

    executions: Counter[Outcome] = field(default_factory=Counter[Outcome])
    clauses: dict[str, Counter[Outcome]] = field(default_factory=dict[str, Counter[Outcome]])

    @classmethod
    def of(cls, store: StudyReader) -> Tally:
        """Return the counts of the stored batches. Raises ``DatabaseProblem``."""
        found = cls(Counter(store.verdicts()))
        for one in store.clauses():
            counts = (one.holds, one.violated, one.unknown)
            found.clauses[one.name] = Counter(dict(zip(Outcome, counts, strict=True)))
        return found

    @property
    def finished(self) -> int:
        """The number of finished executions."""
        return self.executions.total()

    @property
    def holding(self) -> int:
        """The number of executions in which all clauses hold."""
        return self.executions[Outcome.HOLDS]

    def add(self, scenario: ScenarioResult) -> None:
        """Count a finished execution."""
        self.executions[scenario.verdict] += 1
        for clause in scenario.spec.clauses:
            judged = scenario.judged.get(clause.line)
            outcome = Outcome.UNKNOWN if judged is None else Outcome(judged.verdict)
            self.clauses.setdefault(clause.name, Counter())[outcome] += 1

    def add_finished(self, scenarios: Iterable[ScenarioResult]) -> None:
        """Count those executions of a batch that are finished."""
        for scenario in scenarios:
            if scenario.finished is not None:
                self.add(scenario)

    def worst(self) -> tuple[str, Counter[Outcome]] | None:
        """Return the clause with the largest share of verdicts other than *holds*, and its verdicts.

        ``None`` if all clauses hold so far.
        """
        failing = {name: 1 - counts[Outcome.HOLDS] / counts.total() for name, counts in self.clauses.items()}
        name = max(failing, key=lambda one: failing[one], default=None)
        return None if name is None or not failing[name] else (name, self.clauses[name])


@dataclass(frozen=True, slots=True)
class StudyProgress:
    """The progress of a study.

    - ``total``: the number of executions of the whole study.
    - ``tally``: the verdicts so far. It changes while the study is executed.
    - ``rate``: executions per s of wall time since the study was begun or resumed; 0 if unknown.
    - ``made``: the number of executions since then.
    """

    total: int
    tally: Tally
    rate: float = 0.0
    made: int = 0

    @property
    def finished(self) -> int:
        """The number of finished executions."""
        return self.tally.finished

    @property
    def left(self) -> float | None:
        """The estimated wall time of the open executions in s; ``None`` if unknown."""
        return (self.total - self.finished) / self.rate if self.rate else None

    @property
    def expected(self) -> TimeEstimate:
        """The number of open executions, with their time measured on the finished ones."""
        return TimeEstimate(self.total - self.finished, self.left, self.made)

    @property
    def words(self) -> str:
        """The number of finished executions, the rate, and the remaining time, in words."""
        counted = f"{self.finished:,} of {self.total:,} executions"
        if self.left is None:
            return counted
        return f"{counted}, {self.rate:.1f} per second, about {self.expected.duration} left"


class WorkerState(NamedTuple):
    """The state of a worker: its name, its work in words, and how long it has done this work (s), if known."""

    name: str
    work: str
    seconds: float | None
