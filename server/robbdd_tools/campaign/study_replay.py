"""Execute chosen executions of a study again, with traces, and compare their verdicts with the stored ones."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.campaign.replayed_executions import write_numbers
from robbdd_tools.campaign.study_changes import changed_files, changed_study, resolved_files, used_files
from robbdd_tools.campaign.study_clauses import clause_named, clause_words
from robbdd_tools.campaign.study_place import BATCHES, RUNS, StudyProblem
from robbdd_tools.run.results import unjudged
from robbdd_tools.run.store import RunStore
from robbdd_tools.run.store_maintenance import remove_runs
from robbdd_tools.workbench.run import Run

if TYPE_CHECKING:
    from robbdd_tools.campaign.study_file import Cell, Study
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.run.prepare import RunRequest
    from robbdd_tools.run.results import ScenarioResult
    from robbdd_tools.run.run_policy import Policy
    from robbdd_tools.run.study_reader import StoredExecution, StudyReader


class NothingChosen(RobbddError):
    """No execution of a study was chosen; the message gives the reason."""


@dataclass(frozen=True, slots=True)
class Chosen:
    """A choice of executions of a study.

    - ``numbers``: their numbers in the study; empty for all.
    - ``failures``: only those that do not hold.
    - ``clause``: only those in which the clause of this name, or of these words, does not hold.
    - ``first``: at most this many, in the order of the study.
    """

    numbers: Sequence[int] = ()
    failures: bool = False
    clause: str = ""
    first: int | None = None

    def executions(self, store: StudyReader) -> list[StoredExecution]:
        """Return the executions in the order of the study. Raises ``NothingChosen`` and ``DatabaseProblem``."""
        if not (self.numbers or self.failures or self.clause):
            raise NothingChosen("name executions by their numbers in the export, or write --failures or --clause NAME")
        clause = _known_clause(self.clause, store) if self.clause else ""
        found = list(store.executions(failures=self.failures, clause=clause))
        numbers = {one.number for one in found}
        missing = [one for one in self.numbers if one not in numbers]
        if missing:
            what = "a stored execution" if not (self.failures or self.clause) else "one of the failures"
            raise NothingChosen(f"{missing[0]} is not the number of {what}")
        if self.numbers:
            found = [one for one in found if one.number in self.numbers]
        if not found:
            raise NothingChosen(
                "no execution failed" if not self.clause else f"'{self.clause}' holds in all executions"
            )
        return found[: self.first]


def _known_clause(text: str, store: StudyReader) -> str:
    names = [one.name for one in store.clauses()]
    name = clause_named(text, names)
    if name is None:
        raise NothingChosen(f"there is no clause '{text}'; the study has {', '.join(map(clause_words, names))}")
    return name


class StudyReplay:
    """Executes executions of a study again, as runs in the folder of the study.

    If ``force`` is true, the current models and files are used, even if they have changed since the study.
    """

    def __init__(self, study: Study, store: StudyReader, folder: Path, *, force: bool) -> None:
        reason = "" if force else changed_study(study, store)
        if reason:
            raise StudyProblem(f"{reason}, or execute the changed files with --force")
        self._study = study
        self._store = store
        self._force = force
        self._runs = RunStore(folder / RUNS)

    def runs(
        self, executions: Sequence[StoredExecution], policy: Policy
    ) -> Iterator[tuple[Run, Sequence[StoredExecution]]]:
        """Yield a run for each combination of levels, with its executions. Use each run as a context manager.

        Raises ``StudyProblem``, ``UserCodeRefused`` and ``OSError``.
        """
        cells = {cell.words: cell for cell in self._study.cells}
        for words, group in groupby(sorted(executions, key=lambda one: (one.cell, one.number)), lambda one: one.cell):
            if words not in cells:
                raise StudyProblem(f"the study no longer has the combination {words}")
            own = list(group)
            yield self._begun(cells[words], own, replace(policy, timeout=self._study.timeout)), own

    def _begun(self, cell: Cell, executions: Sequence[StoredExecution], policy: Policy) -> Run:
        keys = {one.key for one in executions}

        def limited(request: RunRequest) -> RunRequest:
            former = request.is_wanted

            def wanted(spec: ScenarioSpec) -> bool:
                return _key(spec) in keys and (former is None or former(spec))

            return replace(request, is_wanted=wanted)

        plan = replace(cell.plan, requests=tuple(map(limited, cell.plan.requests)))
        run = Run.begin(plan, self._runs.begin(), policy, repeat=self._study.repeat)
        known = self._store.fact(f"files {cell.words}")
        reason = "" if self._force or known is None else self._changed(json.loads(known), run)
        if reason:
            run.close()
            run.place.discard()
            remove_runs(run.place.database, (run.place.number,))
            raise StudyProblem(f"{reason}, or execute the changed files with --force")
        if not self._force:
            # Other files would not show what the study executed.
            numbers = {one.key: one.number for one in executions}
            write_numbers(run.folder, [numbers[_key(spec)] for spec in run.manifest.scenarios])
        return run

    def _changed(self, known: Mapping[str, str], run: Run) -> str:
        """Return which files differ from those of the study. The run may be in a folder of any place."""
        before = resolved_files(known, self._store.path.parent / BATCHES / "1")
        return changed_files(before, resolved_files(used_files(run.place), run.folder))

    def differences(self, run: Run, executions: Sequence[StoredExecution]) -> Mapping[int, str]:
        """Return how executions differ from the study, in words, by their numbers. Equal executions are missing."""
        numbers = {one.key: one.number for one in executions}
        found: dict[int, str] = {}
        for scenario in run.progress.scenarios:
            number = numbers[_key(scenario.spec)]
            words = self._difference(number, scenario)
            if words:
                found[number] = words
        return found

    def _difference(self, number: int, scenario: ScenarioResult) -> str:
        stored = self._store.judged(number)
        for clause, (verdict, robustness, at) in zip(scenario.spec.clauses, stored, strict=False):
            now = scenario.judged.get(clause.line) or unjudged(clause)
            if now.verdict != verdict:
                return f"{clause.name} was {verdict}, and is {now.verdict}"
            if (now.robustness, now.at) != (robustness, at):
                return f"the margin of {clause.name} was {robustness}, and is {now.robustness} {now.unit}".rstrip()
        return "" if len(stored) == len(scenario.spec.clauses) else "it has other clauses"


def _key(spec: ScenarioSpec) -> tuple[str, int, str, int]:
    execution = "" if spec.execution is None else spec.execution.name
    return spec.variant, spec.variation, execution, spec.repetition
