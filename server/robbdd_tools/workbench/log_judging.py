"""Judge a log of a real robot by the clauses of a model. The result is a stored run."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, cast

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.writing import replace_file
from robbdd_tools.logs.log_contents import UnreadableLog
from robbdd_tools.protocol.log_request import LOG_REQUEST, LogRequest
from robbdd_tools.protocol.messages import LogLine
from robbdd_tools.protocol.specs import plain_name
from robbdd_tools.run.launch import Agent, stop
from robbdd_tools.run.message_check import misfit
from robbdd_tools.run.recording import failure_reason
from robbdd_tools.run.results import RunResults
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.run.scheduler import CANCELLED
from robbdd_tools.workbench.execution_rows import ExecutionResult, execution_results
from robbdd_tools.workbench.folder import Keeping, new_folder
from robbdd_tools.workbench.log_uncertainty import read_uncertainty
from robbdd_tools.workbench.run import begin_recording

if TYPE_CHECKING:
    from robbdd_tools.protocol.messages import RunMessage
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.workbench.plan import Plan

JUDGE_LOG = "robbdd_tools.agent.judge_log"
MAX_LISTED = 5


class NotOneScenario(RobbddError):
    """A log is of one execution, but a selection has several scenarios; the message lists some."""


@dataclass(frozen=True, slots=True)
class LogNames:
    """Settings for the names and times of a log; see ``LogRequest``."""

    frames: Mapping[str, str] = field(default_factory=dict[str, str])
    world: str = ""
    max_gap: float = 0.5
    rate: float = 200.0
    annotations: Path | None = None
    uncertainty: Mapping[str, float] = field(default_factory=dict[str, float])
    bases: Mapping[str, str] = field(default_factory=dict[str, str])
    joint_topics: Mapping[str, str] = field(default_factory=dict[str, str])
    joints: Mapping[str, str] = field(default_factory=dict[str, str])
    columns: Mapping[str, str] = field(default_factory=dict[str, str])
    grips: tuple[str, ...] = ()
    clocks: Mapping[str, float] = field(default_factory=dict[str, float])
    signals: tuple[str, ...] = ()
    begin: float | None = None
    end: float | None = None
    quiet: float | None = None


@dataclass(frozen=True, slots=True)
class JudgedLog:
    """The verdicts of a scenario's clauses on a log.

    ``result`` is stored like that of an execution, as run ``number`` (0 if it is not kept in a store). ``remarks`` are
    sentences on how the log was read, and on what it does not contain.
    """

    result: ExecutionResult
    number: int
    remarks: tuple[str, ...]


def judge_log(
    log: str | os.PathLike[str],
    plan: Plan,
    *,
    frames: Mapping[str, str] | None = None,
    world: str = "",
    max_gap: float = 0.5,
    rate: float = 200.0,
    events: str | os.PathLike[str] | None = None,
    uncertainty: Sequence[str] = (),
    bases: Mapping[str, str] | None = None,
    joint_topics: Mapping[str, str] | None = None,
    joints: Mapping[str, str] | None = None,
    columns: Mapping[str, str] | None = None,
    grips: Sequence[str] = (),
    clocks: Mapping[str, float] | None = None,
    signals: Sequence[str] = (),
    begin: float | None = None,
    end: float | None = None,
    quiet: float | None = None,
    keeping: Keeping | None = None,
) -> JudgedLog:
    """Judge the log of a real robot by the scenario that it executed (docs/logs.md). The call blocks.

    - ``log``: a ROS bag, an MCAP file or a CSV table.
    - ``plan``: a plan of this scenario alone: ``model.scenarios(where="thing=cube0 and goal=left_ws")``.
    - ``frames``: maps an element (local name or CURIE) to its frame in the log; the others are found by name.
    - ``world``: the frame of the world; by default, the root of the frames.
    - ``max_gap``: the largest time between two observations that are interpolated, s.
    - ``rate``: the largest number of samples per second.
    - ``events``: a CSV table of events that the log does not contain, with the columns ``time`` (s since the begin of
      the log) and ``event``.
    - ``uncertainty``: the largest errors of the measurements: ``("3 mm", "cube0=5 mm", "2 deg", "0.05 m/s")``. Where
      they could change a verdict, it is *unknown*.
    - ``bases``: maps an agent to the frame of the base of its model, from which its joints give the tool's poses.
    - ``joint_topics``: maps an agent to the topic of its joint states.
    - ``joints``: maps a joint of a model, or ``agent/joint``, to its name in the log.
    - ``columns``: maps the name of a column of a table (``time``, ``frame``, ``x`` …) to its title in the file.
    - ``grips``: signals that say when an agent holds something: ``("ur10=/vacuum", "ur10=joint finger above 5 mm")``.
    - ``clocks``: maps a topic of a ROS bag to the time (s) by which the clock of its headers is ahead.
    - ``signals``: messages that report events: ``("evt-pick-end=/gripper/closed becomes true",)``.
    - ``begin``, ``end``: the period of the log that is judged, s since its begin.
    - ``quiet``: the log is still recorded; it ends when nothing was written for this time (s).
    - ``keeping``: where the result is stored; by default, in the store of the model's project.

    Raises ``UnreadableLog``, ``ValueError`` for an uncertainty that is not a quantity, ``NotOneScenario``,
    ``UserCodeRefused`` and ``OSError``.
    """
    errors = dict(read_uncertainty(one) for one in uncertainty)
    names = LogNames(
        dict(frames or {}),
        world,
        max_gap,
        rate,
        None if events is None else Path(events),
        errors,
        dict(bases or {}),
        dict(joint_topics or {}),
        dict(joints or {}),
        dict(columns or {}),
        tuple(grips),
        dict(clocks or {}),
        tuple(signals),
        begin,
        end,
        quiet,
    )
    with LogJudgement(plan, Path(log), names, keeping) as judgement:
        for _ in judgement.messages():
            pass
        if judgement.problem:
            raise UnreadableLog(judgement.problem)
        (result,) = execution_results(judgement.progress.as_json())
        return JudgedLog(result, judgement.place.number, tuple(judgement.remarks))


class LogJudgement:
    """Judges one scenario by a log. Use it as a context manager: consume ``messages`` once, then read ``progress``."""

    def __init__(self, plan: Plan, log: Path, names: LogNames | None = None, keeping: Keeping | None = None) -> None:
        """Prepare the judgement in a new run folder.

        Raises ``NotOneScenario``, ``UserCodeRefused``, ``OSError``, and the errors of a plan.
        """
        scenarios = [spec for spec in plan.scenarios if spec.repetition == 1]
        if len(scenarios) != 1:
            raise NotOneScenario(_several(log, scenarios))
        names = names or LogNames()
        folder = new_folder(plan.path or Path(), keeping or Keeping())
        self.place = folder.place
        self._remove = folder.remove
        try:
            self._recording = begin_recording(plan, self.place, Policy.of(jobs=1), repeat=1, log=log.absolute())
        except BaseException:
            if self.place.number:
                self.place.discard()
            self._remove()
            raise
        annotations = "" if names.annotations is None else str(names.annotations.absolute())
        request = LogRequest(
            str(log.absolute()),
            dict(names.frames),
            names.world,
            names.max_gap,
            names.rate,
            annotations,
            dict(names.uncertainty),
            dict(names.bases),
            dict(names.joint_topics),
            dict(names.joints),
            dict(names.columns),
            names.grips,
            dict(names.clocks),
            names.signals,
            names.begin,
            names.end,
            names.quiet,
        )
        replace_file(self.place.folder / LOG_REQUEST, json.dumps(asdict(request)))
        self.progress = RunResults(self._recording.manifest)
        self.remarks: list[str] = []
        """Sentences on how the log was read, and on what it does not contain."""
        self.ending = ""
        """Why clauses were left open; empty if all were judged."""
        self.problem = ""
        """Why the log could not be judged; else empty."""
        self._agent: Agent | None = None
        self._reason = ""

    def cancel(self, reason: str = CANCELLED) -> None:
        """End the judgement. This may be called from any thread."""
        self._reason = reason
        if self._agent is not None:
            self._agent.terminate()

    def messages(self) -> Iterator[RunMessage]:
        """Yield the messages of the judging process. Each one is yielded after ``progress`` has applied it."""
        self._agent = agent = Agent(self.place.folder, module=JUDGE_LOG)
        complaint = ""
        try:
            for message in self._possible(agent.messages()):
                if isinstance(message, LogLine):
                    complaint = message.text if message.level == "error" else complaint
                    self.remarks += [message.text] if message.level == "info" else []
                self._recording.take(message)
                self.progress.apply(message)
                if not isinstance(message, LogLine):
                    yield message
        except OSError as error:
            self._reason = failure_reason(error)
        finally:
            stop([agent])
            if not self.progress.complete:
                self.problem = complaint
                self.ending = self._reason or complaint or agent.ending()
            self.progress = self._recording.end(self.ending, interrupted=self._reason == CANCELLED)

    def _possible(self, messages: Iterator[RunMessage]) -> Iterator[RunMessage]:
        """Yield messages. One that the judging process cannot have sent is replaced by a log message."""
        for message in messages:
            problem = misfit(message, self._recording.manifest.scenarios, 0)
            yield LogLine("warning", problem) if problem else message

    def close(self) -> None:
        """Release the store."""
        self._recording.close()
        self._remove()

    def __enter__(self) -> LogJudgement:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _several(log: Path, scenarios: list[ScenarioSpec]) -> str:
    if not scenarios:
        return "no scenario fits the selection"
    listed = "; ".join(f"{spec.name}{_execution(spec)} ({_values(spec)})" for spec in scenarios[:MAX_LISTED])
    listed += f"; and {len(scenarios) - MAX_LISTED} more" if len(scenarios) > MAX_LISTED else ""
    return (
        f"{log.name} is the log of one execution, but {len(scenarios)} scenarios fit: {listed}. "
        "Select the scenario that the robot executed with --where 'variable=value and …' or --scenario NAME"
    )


def _execution(spec: ScenarioSpec) -> str:
    return "" if spec.execution is None else f" in {plain_name(spec.execution.name)}"


def _values(spec: ScenarioSpec) -> str:
    return ", ".join(f"{plain_name(name)} = {_shown(value)}" for name, value in spec.values.items())


def _shown(value: object) -> str:
    if isinstance(value, list | tuple):
        return "{" + ", ".join(map(_shown, cast("list[object]", value))) + "}"
    return str(value).rpartition(":")[2]
