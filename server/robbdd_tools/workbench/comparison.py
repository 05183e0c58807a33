"""Compare two stored runs: which executions flipped, how margins moved, and what differs in the input."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import zip_longest
from typing import TYPE_CHECKING

from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.protocol.specs import scenario_key
from robbdd_tools.run.report import values_words
from robbdd_tools.run.results import finished_in
from robbdd_tools.workbench.execution_rows import ExecutionResult, execution_result

if TYPE_CHECKING:
    from robbdd_tools.run.store import RunRecord, StoredRun
    from robbdd_tools.workbench.execution_rows import ClauseResult


@dataclass(frozen=True, slots=True)
class Side:
    """An execution in one of the runs. ``index`` is its number in the run; ``trace`` is true if its trace is stored."""

    index: int
    verdict: Outcome
    seed: int
    trace: bool


@dataclass(frozen=True, slots=True)
class ClauseChange:
    """A clause of an execution whose verdict differs, with the margins in ``unit`` and the reason of the later run.

    ``before`` or ``after`` is ``None`` if only the other run judged the clause.
    """

    iri: str
    name: str
    before: Outcome | None
    after: Outcome | None
    margin_before: float | None
    margin_after: float | None
    unit: str
    reason: str


@dataclass(frozen=True, slots=True)
class ExecutionChange:
    """An execution whose verdicts differ, or that only one of the runs has; the other side is ``None``."""

    name: str
    values: str
    variant: str
    repetition: int
    before: Side | None
    after: Side | None
    clauses: tuple[ClauseChange, ...]

    @property
    def flipped(self) -> bool:
        """Whether both runs have the execution, with different verdicts on a clause or on the whole scenario."""
        return self.before is not None and self.after is not None


@dataclass(frozen=True, slots=True)
class ClauseTotals:
    """All verdicts of one run on a clause: how many of ``total`` hold, and the smallest margin in ``unit``."""

    holding: int = 0
    total: int = 0
    margin: float | None = None
    unit: str = ""


@dataclass(frozen=True, slots=True)
class ComparedClause:
    """A clause in both runs."""

    iri: str
    name: str
    role: str
    before: ClauseTotals
    after: ClauseTotals


@dataclass(frozen=True, slots=True)
class Comparison:
    """The differences between two runs.

    - ``inputs``: what differs in the input of the runs, in words.
    - ``clauses``: all clauses, in the order of the executions.
    - ``same``: the number of executions with equal verdicts on all clauses.
    - ``changes``: the other executions. Those that flipped come first.
    """

    inputs: tuple[str, ...]
    clauses: tuple[ComparedClause, ...]
    same: int
    changes: tuple[ExecutionChange, ...]

    @property
    def flipped(self) -> int:
        """The number of executions that flipped."""
        return sum(change.flipped for change in self.changes)


@dataclass(frozen=True, slots=True)
class Executed:
    """A result to compare, its values in words, and whether its trace is stored."""

    values: str
    result: ExecutionResult
    trace: bool

    @property
    def side(self) -> Side:
        """The execution without its clauses."""
        return Side(self.result.index, self.result.verdict, self.result.seed, self.trace)


def compare(before: StoredRun, after: StoredRun) -> Comparison:
    """Compare two stored runs. Raises ``NoSuchRun``.

    An execution is identified by its variant, values, ``.bddx`` execution and repetition, even if the model was edited.
    """
    one, other = _executions(before), _executions(after)
    changes, same = changes_between(one, other)
    return Comparison(tuple(_inputs(before.record(), after.record())), tuple(_clauses(one, other)), same, changes)


def changes_between(
    before: Mapping[str, Executed], after: Mapping[str, Executed]
) -> tuple[tuple[ExecutionChange, ...], int]:
    """Return the executions that differ, flipped ones first, and the number of executions that do not differ.

    Executions with the same key are compared.
    """
    found = [_change(before.get(key), after.get(key)) for key in {**before, **after}]
    changes = [change for change in found if change is not None]
    changes.sort(key=lambda change: not change.flipped)
    return tuple(changes), len(found) - len(changes)


def _executions(run: StoredRun) -> dict[str, Executed]:
    """Return the executions of a run by their keys."""
    document = run.results()
    finished = finished_in(document)
    found: dict[str, Executed] = {}
    for index, (spec, entry) in enumerate(zip(run.manifest().scenarios, document["scenarios"], strict=False)):
        trace = index in finished and trace_file(run.folder, index).is_file()
        found[scenario_key(spec)] = Executed(values_words(spec), execution_result(index, entry), trace)
    return found


def _change(before: Executed | None, after: Executed | None) -> ExecutionChange | None:
    shown = after or before
    assert shown is not None
    if before is None or after is None:
        clauses: tuple[ClauseChange, ...] = ()
    else:
        clauses = tuple(_clause_changes(before.result, after.result))
        if not clauses and before.result.verdict is after.result.verdict:
            return None
    return ExecutionChange(
        shown.result.name,
        shown.values,
        shown.result.variant,
        shown.result.repetition,
        None if before is None else before.side,
        None if after is None else after.side,
        clauses,
    )


def _clause_changes(before: ExecutionResult, after: ExecutionResult) -> Iterator[ClauseChange]:
    # A clause that is repeated within the execution is paired with the same repetition.
    one, other = _by_iri(before), _by_iri(after)
    for iri in {**one, **other}:
        for old, new in zip_longest(one.get(iri, ()), other.get(iri, ())):
            shown = new or old
            verdicts = (old and old.verdict, new and new.verdict)
            if shown is not None and verdicts[0] != verdicts[1]:
                margins = (old and old.margin, new and new.margin)
                # An unknown verdict has no unit.
                unit = shown.unit or (old.unit if old else "")
                yield ClauseChange(iri, shown.name, *verdicts, *margins, unit, new.reason if new else "")


def _by_iri(result: ExecutionResult) -> dict[str, list[ClauseResult]]:
    found: dict[str, list[ClauseResult]] = {}
    for clause in result.clauses:
        found.setdefault(clause.iri, []).append(clause)
    return found


def _clauses(before: Mapping[str, Executed], after: Mapping[str, Executed]) -> Iterator[ComparedClause]:
    every = {clause.iri: clause for one in (*before.values(), *after.values()) for clause in one.result.clauses}
    one, other = _totals(before), _totals(after)
    for iri, clause in every.items():
        yield ComparedClause(
            iri, clause.name, clause.role, one.get(iri, ClauseTotals()), other.get(iri, ClauseTotals())
        )


def _totals(executions: Mapping[str, Executed]) -> dict[str, ClauseTotals]:
    judged: dict[str, list[ClauseResult]] = {}
    for one in executions.values():
        for clause in one.result.clauses:
            judged.setdefault(clause.iri, []).append(clause)
    found: dict[str, ClauseTotals] = {}
    for iri, clauses in judged.items():
        holding = sum(clause.verdict is Outcome.HOLDS for clause in clauses)
        margins = [clause.margin for clause in clauses if clause.margin is not None]
        found[iri] = ClauseTotals(holding, len(clauses), min(margins, default=None), clauses[0].unit)
    return found


def _inputs(before: RunRecord, after: RunRecord) -> Iterator[str]:
    if before.path != after.path:
        yield f"{before.path} became {after.path}"
    if before.digest != after.digest:
        yield "the model has changed"
    if before.seed != after.seed:
        yield f"seed {before.seed} became {after.seed}"
    changed = [path for path in {**before.files, **after.files} if before.files.get(path) != after.files.get(path)]
    if changed:
        names = ", ".join(sorted({path.rsplit("/", 1)[-1] for path in changed}))
        yield f"{len(changed)} used file{'s' * (len(changed) > 1)} changed: {names}"
    for what, old, new in (
        ("RobBDD", before.version, after.version),
        ("the simulator", before.simulator, after.simulator),
    ):
        if old != new:
            yield f"{what} {old or 'of unknown version'} became {new or 'of unknown version'}"
    if before.log and after.log and before.log != after.log:
        yield "they judge different logs"
    elif bool(before.log) != bool(after.log):
        yield "one of them judges the log of a real robot, the other one is simulated"
