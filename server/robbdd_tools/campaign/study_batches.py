"""Divide the executions of a study into batches, always in the same way."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.campaign.study_file import Cell, Study
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.run.prepare import RunRequest
    from robbdd_tools.workbench.plan import Plan


@dataclass(frozen=True, slots=True)
class Batch:
    """The executions that are executed as one run: repetitions ``first`` to ``last`` of all scenarios of a cell.

    - ``number``: the number of the batch in the study (from 1).
    - ``stage``: the number of the stage (from 1). All batches of a stage have the same repetitions. Only at the end of
      a stage is the study balanced, that is, each cell has the same repetitions.
    - ``size``: the number of its executions.
    """

    number: int
    stage: int
    cell: Cell
    first: int
    last: int
    size: int

    def plan(self) -> Plan:
        """Return the plan of the batch. Run it with the ``repeat`` of the study."""
        plan = self.cell.plan
        return replace(plan, requests=tuple(self._limited(request) for request in plan.requests))

    def _limited(self, request: RunRequest) -> RunRequest:
        former = request.is_wanted

        def wanted(spec: ScenarioSpec) -> bool:
            return self.first <= spec.repetition <= self.last and (former is None or former(spec))

        return replace(request, is_wanted=wanted)


def batches(study: Study) -> list[Batch]:
    """Return the batches of a study in the order of execution: all cells, then the next repetitions of all cells.

    A batch has about ``study.batch`` executions, but at least one of each scenario. Raises ``NothingSelected``.
    """
    counts = [Counter(spec.repetition for spec in cell.plan.specs(repeat=study.repeat)) for cell in study.cells]
    step = max(1, study.batch // max(max(count.values(), default=1) for count in counts))
    last = max((number for count in counts for number in count), default=0)
    return list(_batches(study, counts, step, last))


def _batches(study: Study, counts: list[Counter[int]], step: int, most: int) -> Iterator[Batch]:
    number = 0
    for stage, first in enumerate(range(1, most + 1, step), start=1):
        last = min(first + step - 1, most)
        for cell, count in zip(study.cells, counts, strict=True):
            size = sum(count[repetition] for repetition in range(first, last + 1))
            if size:
                number += 1
                yield Batch(number, stage, cell, first, last, size)
