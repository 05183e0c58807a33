"""What the parent and the agent process say to each other: a manifest, and one JSON object per line both ways.

The agent reads orders (``Execute``) on its standard input, ends at its end, and writes ``RunMessage``s. Besides
``run.manifest``, the manifest's file, the only module that both sides share. Every message is a frozen dataclass;
``encode`` and ``decode`` are inverse.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from robbdd_tools.base.plain import finite, from_plain
from robbdd_tools.catalog.coordination import TreeSpec
from robbdd_tools.catalog.executable import Implementation, SceneInstance
from robbdd_tools.monitor.fault import Fault
from robbdd_tools.monitor.policy import Policy
from robbdd_tools.monitor.verdict import Outcome, Verdict

VIEWER = "ROBBDD_VIEWER"
"""Environment variable of the agent: when it is set, a window shows each scenario in real time."""
OWN_STEPS = "model_*steps.py"
"""Pattern of the files in a run's folder of steps that are copies of users' own."""
NO_STEP = "no step definition"
"""How the reason begins why a clause is unknown that nothing can judge."""


@dataclass(frozen=True, slots=True)
class ConfigSpec:
    """A configuration that a Given clause wants: the element's CURIE, the name, the value as text."""

    target: str
    name: str
    value: str


@dataclass(frozen=True, slots=True)
class SceneSpec:
    """What a scenario's world holds; all names are CURIEs as in the feature text.

    ``workspaces`` maps a workspace to the objects that carry it; ``contains`` to the workspaces that lie within
    (a bin's workspace within the table's); ``places`` an object to the workspace where the Given clauses want it.
    ``config`` is how the Given clauses want it set up. ``unused`` are the objects and agents that no clause speaks of;
    ``sets`` maps elements to the local names of the sets that hold them, where models are chosen by name.
    """

    objects: tuple[str, ...] = ()
    agents: tuple[str, ...] = ()
    workspaces: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    contains: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    places: Mapping[str, str] = field(default_factory=dict[str, str])
    config: tuple[ConfigSpec, ...] = ()
    unused: tuple[str, ...] = ()
    sets: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])


@dataclass(frozen=True, slots=True)
class ExecutionSpec:
    """How scenarios are executed, as a ``.bddx`` says: ``name`` is the execution's CURIE.

    ``implementation`` executes the behaviours in ``scene`` (elements by CURIE); ``policies`` judge the clauses that
    they name (by IRI; what they observe are CURIEs). ``repeat`` is how often, ``timeout`` is in seconds of simulated
    time.
    """

    iri: str
    name: str
    implementation: Implementation
    scene: SceneInstance | None = None
    policies: tuple[Policy, ...] = ()
    repeat: int = 1
    timeout: float | None = None


@dataclass(frozen=True, slots=True)
class ClauseSpec:
    """One clause of one scenario: the feature line of its step, the IRI it judges, its place in the scenario.

    ``parts`` are the IRIs of the fluents of a group, in the order of the sentence. ``arguments`` are, for a clause that
    users' code judges, what fills the slots and quantified variables of each of these fluents, by name. ``iterations``
    are the first and the last behaviour of the clause's scope, counted from 1 within the scenario; nothing where the
    scenario executes a single one.
    """

    line: int
    iri: str
    name: str
    role: str
    sentence: str
    parts: tuple[str, ...] = ()
    arguments: tuple[Mapping[str, Any], ...] = ()
    iterations: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class ScenarioSpec:
    """One execution: a scenario of a feature, with its values and clauses in order.

    ``events`` maps an event's CURIE to what emits it: ``scenario-start``, ``scenario-end`` or the name of an
    event of the behaviour (``pick-start`` …); ``seed`` decides everything random in it. ``execution`` is how a
    ``.bddx`` wants it executed, ``None`` for a scenario that is run as it is. Repetitions, counted from 1, share the
    feature's scenario and differ in their seeds. ``model`` is the file's name in reports. ``tree`` is the execution
    of a behaviour tree that scenarios with the same one are judged from together, ``node`` the IRI of the tree's node
    that this one is linked to; scene and seed are those of that execution then.
    """

    feature: str
    line: int
    name: str
    story: str
    variant: str
    variation: int
    values: Mapping[str, Any]
    seed: int
    scene: SceneSpec
    events: Mapping[str, str]
    clauses: tuple[ClauseSpec, ...]
    execution: ExecutionSpec | None = None
    repetition: int = 1
    model: str = ""
    tree: TreeSpec | None = None
    node: str = ""


@dataclass(frozen=True, slots=True)
class Manifest:
    """Everything the agent needs beside the feature files; ``traces`` tells it to write ``trace_file``s.

    ``sources`` maps files of the users' steps, by their path in the run folder, to the files that they are copies of.
    """

    model: str
    seed: int
    scenarios: tuple[ScenarioSpec, ...]
    traces: bool = False
    sources: Mapping[str, str] = field(default_factory=dict[str, str])


@dataclass(frozen=True, slots=True)
class Execute:
    """The parent's order to execute scenario number ``index`` of the manifest."""

    index: int


@dataclass(frozen=True, slots=True)
class RunStarted:
    """The agent is up; the manifest has ``total`` scenarios."""

    total: int
    simulator: str


@dataclass(frozen=True, slots=True)
class ScenarioStarted:
    """Scenario number ``index`` (from 0, in manifest order) begins."""

    index: int


@dataclass(frozen=True, slots=True)
class ClauseStarted:
    """The clause on feature line ``line`` is waiting for its window to close."""

    index: int
    line: int


@dataclass(frozen=True, slots=True)
class ClauseJudged:
    """A clause has its verdict (``holds``, ``violated``, ``unknown``); see ``monitor.verdict.Verdict``.

    ``fault`` is the ``id`` of the error in users' code that it is unknown for, as a ``UserCodeFailed`` has it.
    """

    index: int
    line: int
    verdict: str
    robustness: float | None
    unit: str
    at: float | None
    reason: str
    worst_at: float | None = None
    vacuous: str = ""
    fault: str = ""


@dataclass(frozen=True, slots=True)
class MarginRanges:
    """How far the margin of each fluent of the clause on ``line`` varied over the whole execution: least, largest.

    ``held_before`` tells of a Then clause whether it holds and its predicates held before the behaviour began as well,
    ``None`` where that is not known.
    """

    index: int
    line: int
    ranges: tuple[tuple[float, float], ...]
    held_before: bool | None = None


@dataclass(frozen=True, slots=True)
class ScenarioFinished:
    """All clauses of scenario ``index`` are judged; times in seconds (simulated, wall, wall inside mj_step).

    ``resampled`` counts the random places that were drawn again because they overlapped or were out of reach.
    """

    index: int
    simulated: float
    wall: float
    stepping: float
    resampled: int = 0


@dataclass(frozen=True, slots=True)
class UserCodeFailed:
    """Code of the user failed in scenario ``index``, or before any scenario when ``None``; once for each scenario.

    It comes before the verdicts that name ``fault``.
    """

    index: int | None
    fault: Fault


@dataclass(frozen=True, slots=True)
class Output:
    """Lines that users' code printed while scenario ``index`` was executed, or before any scenario when ``None``."""

    index: int | None
    text: str


@dataclass(frozen=True, slots=True)
class LogLine:
    """A line for the log: ``level`` is ``info``, ``warning`` or ``error``."""

    level: str
    text: str


@dataclass(frozen=True, slots=True)
class RunFinished:
    """The agent ends by itself, not ``ok`` when it cannot work; anything else at the end of the stream is a crash."""

    ok: bool


RunMessage = (
    RunStarted
    | ScenarioStarted
    | ClauseStarted
    | ClauseJudged
    | MarginRanges
    | ScenarioFinished
    | UserCodeFailed
    | Output
    | LogLine
    | RunFinished
)
_TYPES: dict[str, type[RunMessage]] = {
    kind.__name__: kind
    for kind in (
        RunStarted,
        ScenarioStarted,
        ClauseStarted,
        ClauseJudged,
        MarginRanges,
        ScenarioFinished,
        UserCodeFailed,
        Output,
        LogLine,
        RunFinished,
    )
}


def judged(index: int, line: int, verdict: Verdict) -> ClauseJudged:
    """Return the message that a clause has a verdict."""
    return ClauseJudged(
        index,
        line,
        str(verdict.outcome),
        verdict.robustness,
        verdict.unit,
        verdict.at,
        verdict.reason,
        verdict.worst_at,
        verdict.vacuous,
        "" if verdict.fault is None else verdict.fault.id,
    )


def encode(message: RunMessage | Execute) -> str:
    """Return a message as one line of JSON in ASCII, without the line end."""
    return json.dumps({"type": type(message).__name__, **asdict(message)})


def decode(line: str) -> RunMessage:
    """Return the message of a line; raises ``ValueError`` for anything that is not one, field by field."""
    try:
        fields = json.loads(line, parse_float=finite, parse_constant=finite)
        message = from_plain(_TYPES[fields.pop("type")], fields)
        if isinstance(message, ClauseJudged):
            Outcome(message.verdict)
        if isinstance(message, LogLine) and message.level not in ("info", "warning", "error"):
            raise ValueError(message.level)
        return message
    except (KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
        raise ValueError(f"not a run message: {line[:200]!r}") from error


def decode_order(line: str) -> Execute:
    """Return the order of a line; raises ``ValueError`` for anything that is not one."""
    match json.loads(line):
        case {"type": "Execute", "index": int(index)}:
            return Execute(index)
        case _:
            raise ValueError(f"not an order: {line[:200]!r}")


def plain_name(curie: str) -> str:
    """Return what users' code calls a variable: the end of its CURIE, without ``var-``."""
    return curie.replace("/", ":").rpartition(":")[2].removeprefix("var-")


def scenario_key(spec: ScenarioSpec) -> str:
    """Return what a scenario is found by in another run, of a model that may have been edited since."""
    execution = None if spec.execution is None else spec.execution.iri
    return json.dumps([spec.variant, spec.values, execution, spec.repetition], sort_keys=True)


def trace_file(folder: Path, index: int) -> Path:
    """Return where the trace of a scenario of a run is."""
    return folder / "traces" / f"{index:06}.mcap"


def curves_file(folder: Path, index: int) -> Path:
    """Return where the margins over time of a scenario of a run are."""
    return folder / "margins" / f"{index:06}.json"


def thumbnail_file(folder: Path, index: int, line: int) -> Path:
    """Return where the small picture of a violation is: scenario, feature line of the clause."""
    return folder / f"{index:06}-{line}.png"
