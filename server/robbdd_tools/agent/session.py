"""The state of a run while behave executes it: the manifest, and the current scenario."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.agent.feature_wording import feature_wording
from robbdd_tools.agent.scenario_run import ScenarioRun
from robbdd_tools.agent.shared_executions import SharedExecutions
from robbdd_tools.agent.steps import register_named
from robbdd_tools.agent.violation_states import ViolationStates
from robbdd_tools.judging.scenario_clauses import named_predicates
from robbdd_tools.protocol.fault_places import sources_in
from robbdd_tools.protocol.messages import LogLine
from robbdd_tools.world.errors import SceneError

if TYPE_CHECKING:
    from robbdd_tools.agent.channel import Channel
    from robbdd_tools.monitor.verdict import Verdict
    from robbdd_tools.protocol.specs import Manifest

UNKNOWN_SCENARIO = "the manifest of this run has no such scenario; was the feature changed?"


class Session:
    """A run. It finds the scenario that behave is executing in the manifest.

    ``sources`` maps the absolute path of each copied file of users' steps to the path of the original.
    """

    def __init__(self, folder: Path, manifest: Manifest, channel: Channel) -> None:
        self._channel = channel
        # Repetitions share a feature's scenario; if behave is run by hand, it executes the first repetition.
        self._indices = {
            ((folder / spec.feature).resolve(), spec.line): index
            for index, spec in reversed(list(enumerate(manifest.scenarios)))
        }
        self.sources = sources_in(folder, manifest.sources)
        self._folder = folder
        self._manifest = manifest
        self._moments = ViolationStates(folder)
        self._courses = SharedExecutions()
        self._present: ScenarioRun | None = None

    def start(
        self, feature: Path, line: int, texts: Sequence[tuple[int, str, str]], handed_out: int | None = None
    ) -> None:
        """Begin the scenario at this line of a feature. If the manifest does not contain it, its steps fail.

        ``handed_out`` is the number of the scenario if the parent process has ordered it.
        """
        self._present = None
        index = self._indices.get((feature.resolve(), line))
        if index is None:
            self._channel.send(LogLine("error", f"{feature.name}:{line}: {UNKNOWN_SCENARIO}"))
            return
        index = index if handed_out is None else handed_out
        self._moments.clear(index)
        spec = self._manifest.scenarios[index]
        register_named(named_predicates(clause.statement for clause in spec.clauses))
        keep = self._folder if self._manifest.traces else None
        wording = feature_wording(feature)
        self._present = ScenarioRun(index, spec, texts, self._channel, self._moments, keep, self._courses, wording)

    @property
    def scenario(self) -> ScenarioRun:
        """The current scenario. Raises ``SceneError`` if it is not in the manifest."""
        if self._present is None:
            raise SceneError(UNKNOWN_SCENARIO)
        return self._present

    def step_started(self, line: int) -> None:
        """Report that the judgement of the clause at a feature line begins."""
        if self._present is not None:
            self._present.step_started(line)

    def set_step_verdict(self, line: int, verdict: Verdict) -> None:
        """Record the verdict of a user's step on the clause at a feature line."""
        if self._present is not None:
            self._present.set_step_verdict(line, verdict)

    def finish(self) -> None:
        """End the current scenario."""
        if self._present is not None:
            self._present.finish()
            self._present = None
