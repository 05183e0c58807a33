"""Execute single executions of a study again, with traces: the same values and seeds, and so the same verdicts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.campaign.study_file import load_study
from robbdd_tools.run.store import begin_in
from robbdd_tools.workbench.model import ModelErrors
from robbdd_tools.workbench.run import Run
from robbdd_tools.workbench.stored import PastRun

if TYPE_CHECKING:
    from robbdd_tools.campaign.study_file import Cell, Study
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.run.prepare import RunRequest
    from robbdd_tools.run.run_policy import Policy
    from robbdd_tools.workbench.execution_rows import ExecutionResult


class NotAgain(RobbddError):
    """Executions of a study cannot be executed again, or gave other verdicts."""


@dataclass(frozen=True, slots=True)
class Again:
    """A run of some executions of a study. ``indices`` maps their index in the study to that in the run."""

    run: PastRun
    indices: Mapping[int, int]


def execute_again(
    path: Path, digest: str | None, chosen: Sequence[ExecutionResult], folder: Path, policy: Policy
) -> list[Again]:
    """Execute ``chosen`` results of the study at ``path`` again in run folders within ``folder``.

    ``digest`` is the one that the study had when it was executed. Raises ``NotAgain`` if the study was changed, if an
    execution is missing in it, or if a verdict differs; ``ModelErrors`` and ``OSError``.
    """
    study = load_study(path)
    if study.findings:
        raise ModelErrors(study.findings)
    if digest != study.digest:
        raise NotAgain(f"{path}: the study or one of its models was changed since it was executed")
    found: list[Again] = []
    for number, cell in enumerate(study.cells):
        inside = [one for one in chosen if cell.levels.items() <= one.values.items()]
        if inside:
            found.append(_in_cell(study, cell, inside, folder / str(number), policy))
    return found


def _in_cell(study: Study, cell: Cell, chosen: Sequence[ExecutionResult], folder: Path, policy: Policy) -> Again:
    wanted = {(one.variant, one.variation, one.execution, one.repetition) for one in chosen}
    plan = replace(cell.plan, requests=tuple(_limited(request, wanted) for request in cell.plan.requests))
    with Run.begin(plan, begin_in(folder), replace(policy, timeout=study.timeout), repeat=study.repeat) as run:
        for _ in run.messages():
            pass
        ending = run.problem or run.ending
    if ending:
        raise NotAgain(ending)
    again = PastRun(run.place)
    known = {
        (spec.variant, spec.variation, _name(spec), spec.repetition): index
        for index, spec in enumerate(run.place.manifest().scenarios)
    }
    indices: dict[int, int] = {}
    for one in chosen:
        index = known.get((one.variant, one.variation, one.execution, one.repetition))
        if index is None:
            raise NotAgain(f"the study has no execution {one.name}, repetition {one.repetition}")
        result = again.results[index]
        if (result.seed, result.verdict) != (one.seed, one.verdict):
            raise NotAgain(f"{one.name} (seed {one.seed}) was {one.verdict}, and is {result.verdict} now: find out why")
        indices[one.index] = index
    return Again(again, indices)


def _limited(request: RunRequest, wanted: set[tuple[str, int, str, int]]) -> RunRequest:
    former = request.is_wanted

    def is_wanted(spec: ScenarioSpec) -> bool:
        key = (spec.variant, spec.variation, _name(spec), spec.repetition)
        return key in wanted and (former is None or former(spec))

    return replace(request, is_wanted=is_wanted)


def _name(spec: ScenarioSpec) -> str:
    return "" if spec.execution is None else spec.execution.name
