"""Find the clauses that notice a fault of the robot, by comparing the same executions with and without the fault."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

from robbdd_tools.campaign.fault_probes import PROBES, separating
from robbdd_tools.monitor.verdict import Cause, Outcome
from robbdd_tools.protocol.specs import PROBE, scenario_key
from robbdd_tools.run.readable import clause_title
from robbdd_tools.run.results import unjudged

if TYPE_CHECKING:
    from robbdd_tools.campaign.fault_probes import Probe
    from robbdd_tools.catalog.robot_faults import RobotFault
    from robbdd_tools.protocol.messages import ClauseJudged
    from robbdd_tools.protocol.specs import ClauseSpec
    from robbdd_tools.run.results import ScenarioResult


class FaultStatus(StrEnum):
    """Whether the clauses notice a fault."""

    NOTICED = "noticed"
    """In every execution, a clause is violated."""
    SOMETIMES = "sometimes noticed"
    """In some executions, a clause is violated."""
    SURVIVES = "not noticed"
    """All clauses hold in all executions, although margins differ."""
    UNCLEAR = "unclear"
    """No clause is violated, but some verdict is unknown."""
    UNSEEN = "no margin changes"
    """All clauses hold, and no margin differs."""
    ABSENT = "not possible"
    """The fault cannot occur in these scenes."""


_SURVIVING = (FaultStatus.SURVIVES, FaultStatus.UNSEEN, FaultStatus.SOMETIMES)


@dataclass(frozen=True, slots=True)
class NoticingClause:
    """A clause of a template: a column of the matrix."""

    iri: str
    name: str
    role: str


@dataclass(frozen=True, slots=True)
class FaultCell:
    """A clause under a fault.

    - ``violated``, ``unknown`` and ``total``: numbers of executions.
    - ``before`` and ``after``: the smallest margin without and with the fault, in ``unit``; ``None`` if not measured.
    """

    violated: int
    unknown: int
    total: int
    before: float | None
    after: float | None
    unit: str


@dataclass(frozen=True, slots=True)
class FaultRow:
    """A fault with one cell for each clause.

    - ``executions``: the number of executions in which the fault occurs.
    - ``noticed``: how many of these executions violate a clause.
    - ``reason``: why the fault does not occur in other executions; empty if it occurs in all.
    - ``proposals``: the probes that separate the executions with the fault from those without, and how they do so.
    """

    fault: RobotFault
    executions: int
    noticed: int
    cells: tuple[FaultCell, ...]
    status: FaultStatus
    reason: str = ""
    proposals: tuple[tuple[Probe, str], ...] = ()


@dataclass(frozen=True, slots=True)
class FaultMatrix:
    """All faults and clauses of the scenarios of one template."""

    template: str
    clauses: tuple[NoticingClause, ...]
    rows: tuple[FaultRow, ...]

    @property
    def survivors(self) -> tuple[FaultRow, ...]:
        """The faults that remain unnoticed in some execution."""
        return tuple(row for row in self.rows if row.status in _SURVIVING)


def is_sound(scenario: ScenarioResult) -> bool:
    """Return whether all clauses of an execution hold."""
    return all(judged.verdict == Outcome.HOLDS for _, judged in _own(scenario))


def fault_matrices(
    without: Iterable[ScenarioResult], with_faults: Iterable[ScenarioResult], templates: Mapping[str, str]
) -> list[FaultMatrix]:
    """Return a matrix for each template, in the order of the scenarios.

    ``without`` are sound executions, ``with_faults`` are the same executions with faults, and ``templates`` maps
    variants (IRIs) to their templates.
    """
    known = {scenario_key(one.spec): one for one in without}
    groups: dict[str, list[ScenarioResult]] = {}
    for one in with_faults:
        groups.setdefault(templates[one.spec.variant], []).append(one)
    return [_matrix(template, executed, known) for template, executed in groups.items()]


def _matrix(template: str, executed: Sequence[ScenarioResult], known: Mapping[str, ScenarioResult]) -> FaultMatrix:
    clauses = {clause.iri: clause for one in executed for clause, _ in _own(one)}
    columns = tuple(NoticingClause(clause.iri, clause_title(clause), clause.role) for clause in clauses.values())
    faults: dict[RobotFault, list[ScenarioResult]] = {}
    for one in executed:
        if one.spec.fault is not None:
            faults.setdefault(one.spec.fault, []).append(one)
    rows = tuple(_row(fault, columns, found, known) for fault, found in faults.items())
    return FaultMatrix(template, columns, rows)


def _row(
    fault: RobotFault,
    columns: Sequence[NoticingClause],
    executed: Sequence[ScenarioResult],
    known: Mapping[str, ScenarioResult],
) -> FaultRow:
    absent = [reason for reason in map(_obstacle, executed) if reason]
    occurring = [one for one in executed if not _obstacle(one)]
    noticed = sum(any(judged.verdict == Outcome.VIOLATED for _, judged in _own(one)) for one in occurring)
    pairs = [(known[scenario_key(one.spec)], one) for one in occurring]
    cells = tuple(_cell(column, pairs) for column in columns)
    status, reason = _status(pairs, noticed), absent[0] if absent else ""
    return FaultRow(fault, len(occurring), noticed, cells, status, reason, tuple(_proposals(pairs)))


def _proposals(pairs: Sequence[tuple[ScenarioResult, ScenarioResult]]) -> Iterator[tuple[Probe, str]]:
    for probe in PROBES:
        before, after = ([one for pair in pairs for one in _judged(probe.iri, pair[side])] for side in (0, 1))
        words = separating(probe, before, after)
        if words is not None:
            yield probe, words


def _status(pairs: Sequence[tuple[ScenarioResult, ScenarioResult]], noticed: int) -> FaultStatus:
    if not pairs:
        return FaultStatus.ABSENT
    if noticed:
        return FaultStatus.NOTICED if noticed == len(pairs) else FaultStatus.SOMETIMES
    if not all(is_sound(after) for _, after in pairs):
        return FaultStatus.UNCLEAR
    same = all(_margins(before) == _margins(after) for before, after in pairs)
    return FaultStatus.UNSEEN if same else FaultStatus.SURVIVES


def _cell(column: NoticingClause, pairs: Iterable[tuple[ScenarioResult, ScenarioResult]]) -> FaultCell:
    before: list[ClauseJudged] = []
    after: list[ClauseJudged] = []
    for one, other in pairs:
        before += _judged(column.iri, one)
        after += _judged(column.iri, other)
    verdicts = [judged.verdict for judged in after]
    violated, unknown = verdicts.count(Outcome.VIOLATED), verdicts.count(Outcome.UNKNOWN)
    unit = next((judged.unit for judged in (*before, *after) if judged.unit), "")
    return FaultCell(violated, unknown, len(after), _least(before), _least(after), unit)


def _judged(iri: str, scenario: ScenarioResult) -> list[ClauseJudged]:
    return [_verdict(scenario, clause) for clause in scenario.spec.clauses if clause.iri == iri]


def _own(scenario: ScenarioResult) -> Iterator[tuple[ClauseSpec, ClauseJudged]]:
    """Yield the clauses of the model with their verdicts, but not the probes."""
    return ((clause, _verdict(scenario, clause)) for clause in scenario.spec.clauses if clause.role != PROBE)


def _verdict(scenario: ScenarioResult, clause: ClauseSpec) -> ClauseJudged:
    return scenario.judged.get(clause.line) or unjudged(clause)


def _least(judged: Iterable[ClauseJudged]) -> float | None:
    return min((one.robustness for one in judged if one.robustness is not None), default=None)


def _margins(scenario: ScenarioResult) -> list[float | None]:
    return [judged.robustness for _, judged in _own(scenario)]


def _obstacle(scenario: ScenarioResult) -> str:
    """Return the reason why the fault of an execution cannot occur; empty if it can. The scene without it is sound."""
    judged = [judged for _, judged in _own(scenario)]
    is_obstacle = bool(judged) and all(one.cause == Cause.SCENE for one in judged)
    return judged[0].reason if is_obstacle else ""
