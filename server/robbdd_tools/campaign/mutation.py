"""Execute scenarios without and with faults of the robots. Only executions that hold without a fault get faults."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Generator, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.campaign.fault_matrix import fault_matrices, is_sound
from robbdd_tools.campaign.fault_probes import probed_templates, with_probes
from robbdd_tools.protocol.messages import ScenarioFinished
from robbdd_tools.protocol.specs import scenario_key
from robbdd_tools.run.store import begin_in
from robbdd_tools.workbench.run import Run

if TYPE_CHECKING:
    from robbdd_tools.campaign.fault_matrix import FaultMatrix
    from robbdd_tools.campaign.fault_probes import ProbedTemplate
    from robbdd_tools.catalog.robot_faults import RobotFault
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.run.results import ScenarioResult
    from robbdd_tools.run.run_policy import Policy
    from robbdd_tools.workbench.plan import Plan


@dataclass(slots=True)
class Mutation:
    """The executions of a plan with and without faults. They are complete after one iteration over ``progress``.

    - ``unsound``: executions with a clause that does not hold without any fault. They are not repeated with faults.
    - ``ending``: the reason why executions are missing; empty if none is missing.
    """

    plan: Plan
    faults: Sequence[RobotFault]
    policy: Policy
    seed: int | None = None
    repeat: int | None = None
    sound: list[ScenarioResult] = field(default_factory=list["ScenarioResult"])
    unsound: list[ScenarioResult] = field(default_factory=list["ScenarioResult"])
    ending: str = ""
    _with_faults: list[ScenarioResult] = field(default_factory=list["ScenarioResult"])
    _run: Run | None = None
    _reason: str = ""

    def cancel(self, reason: str) -> None:
        """End the executions. It may be called from any thread or signal handler."""
        self._reason = self._reason or reason
        if self._run is not None:
            self._run.cancel(reason)

    def progress(self) -> Iterator[tuple[int, int]]:
        """Execute everything. Yield the numbers of finished and of planned executions after each execution.

        Raises ``OSError``, ``NothingSelected`` and ``UserCodeRefused``.
        """
        probed = tuple(replace(one, completed=with_probes) for one in self.plan.requests)
        before = yield from self._executed(replace(self.plan, requests=probed), 0)
        self.sound = [one for one in before if is_sound(one)]
        self.unsound = [one for one in before if not is_sound(one)]
        if self.ending or not self.sound:
            return
        self._with_faults = yield from self._executed(self._faulty_plan(), len(before))

    def matrices(self) -> tuple[list[FaultMatrix], dict[str, ProbedTemplate]]:
        """Return a matrix for each template, and the templates by IRI."""
        of_variant, templates = probed_templates(self.plan)
        return fault_matrices(self.sound, self._with_faults, of_variant), templates

    def _faulty_plan(self) -> Plan:
        keys = {scenario_key(one.spec) for one in self.sound}

        def is_wanted(spec: ScenarioSpec) -> bool:
            return scenario_key(spec) in keys

        requests = (
            replace(one, faults=tuple(self.faults), is_wanted=is_wanted, completed=with_probes)
            for one in self.plan.requests
        )
        return replace(self.plan, requests=tuple(requests))

    def _executed(self, plan: Plan, before: int) -> Generator[tuple[int, int], None, list[ScenarioResult]]:
        folder = tempfile.mkdtemp(prefix="robbdd-")

        def remove() -> None:
            shutil.rmtree(folder, ignore_errors=True)

        place = begin_in(Path(folder), kept=False)
        begun = Run.begin(plan, place, self.policy, seed=self.seed, repeat=self.repeat, on_close=remove)
        with begun as run:
            self._run = run
            if self._reason:
                run.cancel(self._reason)
            total, finished = len(run.manifest.scenarios), 0
            for message in run.messages():
                if isinstance(message, ScenarioFinished):
                    finished += 1
                    yield before + finished, before + total
            self.ending = run.problem or self._reason or run.ending
            return run.progress.scenarios
