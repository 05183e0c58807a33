"""Judge the traces of a stored run against the clauses of an edited model, without simulating."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.writing import replace_file
from robbdd_tools.protocol.manifest_file import STORED_RESULTS
from robbdd_tools.protocol.messages import LogLine, ScenarioStarted, UserCodeFailed
from robbdd_tools.protocol.specs import scenario_key
from robbdd_tools.run.launch import Agent, stop
from robbdd_tools.run.message_check import misfit
from robbdd_tools.run.results import RunResults, finished_in
from robbdd_tools.run.scheduler import CANCELLED
from robbdd_tools.run.user_code import refuse_user_code
from robbdd_tools.workbench.execution_rows import ExecutionResult, execution_results, rows_of
from robbdd_tools.workbench.plan import NothingSelected, Plan, Selection
from robbdd_tools.workbench.scene_choice import instances_of
from robbdd_tools.workbench.substitution import substitutions_of

if TYPE_CHECKING:
    from robbdd_tools.protocol.messages import RunMessage
    from robbdd_tools.protocol.specs import Manifest
    from robbdd_tools.run.store import StoredRun
    from robbdd_tools.workbench.model import Model
    from robbdd_tools.workbench.run import Run
    from robbdd_tools.workbench.stored import PastRun

JUDGE = "robbdd_tools.agent.rejudge"


class NothingToJudge(RobbddError):
    """A stored run has no execution that the model can judge."""


@dataclass(frozen=True, slots=True)
class Judged:
    """The verdicts of a model's clauses on the executions of a stored run.

    ``results`` are in the order of the model's plan and are not stored. Each result has the ``index`` of its execution
    in the run, so ``run.trace(result)`` is its trace. ``ending`` is the reason why clauses were left open, which makes
    them unknown; it is empty if all clauses were judged.
    """

    results: tuple[ExecutionResult, ...]
    ending: str

    def rows(self) -> list[dict[str, Any]]:
        """Return one flat dictionary for each clause of each execution, for ``pandas.DataFrame(judged.rows())``."""
        return rows_of(self.results)


def judge(run: Run | PastRun, model: Model) -> Judged:
    """Judge the executions of a stored run by the model's current clauses, without simulating.

    An execution of the run is judged by the scenario of the model that has the same variant, values, execution and
    repetition. Executions without such a scenario are left out. A clause is unknown if its trace is missing, or if its
    scene or behaviour differs from the run's. The call blocks until everything is judged. In an asyncio program, use
    ``asyncio.to_thread``.

    Raises ``ModelErrors``, ``NothingToRun`` and ``UserCodeRefused``. Raises ``NothingToJudge`` if no finished execution
    belongs to the model, and ``NoSuchRun`` if the run is damaged or was not kept.
    """
    with tempfile.TemporaryDirectory(prefix="robbdd-") as folder:
        judgement = Judgement(run.place, model, Path(folder))
        for _ in judgement.messages():
            pass
    indices = {scenario_key(spec): index for index, spec in enumerate(run.place.manifest().scenarios)}
    results = zip(execution_results(judgement.progress.as_json()), judgement.progress.manifest.scenarios, strict=True)
    return Judged(
        tuple(replace(result, index=indices[scenario_key(spec)]) for result, spec in results), judgement.ending
    )


class Judgement:
    """Judges a stored run by a model. Consume ``messages`` once, then read ``progress``.

    Executions and scenarios are matched by variant, values, execution and repetition.
    """

    def __init__(self, place: StoredRun, model: Model, folder: Path) -> None:
        """Prepare the judgement in an empty ``folder``.

        Raises ``NoSuchRun``, ``NothingToJudge``, ``UserCodeRefused``, and the errors of ``Model.scenarios``.
        """
        self._place = place
        self._folder = folder
        self._manifest = _prepared(place, model, folder)
        self._agent: Agent | None = None
        self._reason = ""
        self.progress = RunResults(self._manifest)
        self.ending = ""
        """Why clauses were left open; empty when all were judged."""

    def cancel(self, reason: str = CANCELLED) -> None:
        """End the judgement. This may be called from any thread."""
        self._reason = reason
        if self._agent is not None:
            self._agent.terminate()

    def messages(self) -> Iterator[RunMessage]:
        """Yield the messages of the judging process. Each one is yielded after ``progress`` has applied it."""
        self._agent = agent = Agent(self._folder, module=JUDGE, arguments=[str(self._place.folder.absolute())])
        complaint, present = "", None
        try:
            for message in _possible(agent.messages(), self._manifest):
                self.progress.apply(message)
                complaint = message.text if isinstance(message, LogLine) else complaint
                present = message.index if isinstance(message, ScenarioStarted) else present
                yield message
        finally:
            stop([agent])
        if not self.progress.complete:
            spec = None if present is None else self._manifest.scenarios[present]
            fault = None if self._reason else agent.crash.fault(f"the process ended with {agent.exit()}", spec, {})
            if fault is not None:
                failed = UserCodeFailed(None, fault)
                self.progress.apply(failed)
                yield failed
                complaint = fault.words
            self.ending = self._reason or complaint or agent.ending()
            self.progress.close(self.ending)


def selection_of(place: StoredRun, manifest: Manifest, keys: Collection[str]) -> Selection:
    """Return the selection of the scenarios with some keys, with the seed and the choices of their stored run.

    Raises ``NoSuchRun``.
    """
    return Selection(
        is_wanted=lambda spec: scenario_key(spec) in keys,
        seed=place.record().user_seed,
        default_seed=manifest.seed,
        default_substitutions=substitutions_of(manifest.scenarios),
        world=next((spec.world for spec in manifest.scenarios), ""),
        default_instances=instances_of(manifest.scenarios),
    )


def _possible(messages: Iterable[RunMessage], manifest: Manifest) -> Iterator[RunMessage]:
    """Yield messages. A message that the judging process cannot have sent is replaced by a log message."""
    present = None
    for message in messages:
        present = message.index if isinstance(message, ScenarioStarted) else present
        problem = misfit(message, manifest.scenarios, present)
        yield LogLine("warning", problem) if problem else message


def _prepared(place: StoredRun, model: Model, folder: Path) -> Manifest:
    manifest, results = place.manifest(), place.results()
    finished = finished_in(results)
    if not finished:
        raise NothingToJudge(f"run {place.number or place.folder} has finished no execution yet")
    known = {scenario_key(manifest.scenarios[index]) for index in finished}
    repeat = max(spec.repetition for spec in manifest.scenarios)
    plan = Plan.of(model, selection_of(place, manifest, known))
    try:
        prepared = plan.prepare(folder, repeat=repeat if repeat > 1 else None)
    except NothingSelected:
        name = f"run {place.number or place.folder}"
        raise NothingToJudge(f"no scenario of {model.path} has the same values as one in {name}") from None
    refuse_user_code(prepared, folder, simulates=False)
    replace_file(folder / STORED_RESULTS, json.dumps(results))
    return prepared
