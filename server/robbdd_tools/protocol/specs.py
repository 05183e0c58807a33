"""What an agent process is to execute, as plain data: scenarios with their scenes, events, clauses and executions."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from robbdd_tools.catalog.coordination import TreeSpec
from robbdd_tools.catalog.executable import Implementation, SceneInstance
from robbdd_tools.monitor.policy import Policy
from robbdd_tools.protocol.clauses import Statement


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

    ``statement`` is what it states; a run that an earlier version has stored has none, and its ``sentence`` is read.
    ``parts`` are the IRIs of the fluents and texts of a group, in the order of the sentence. ``iterations``
    are the first and the last behaviour of the clause's scope, counted from 1 within the scenario; nothing where the
    scenario executes a single one.
    """

    line: int
    iri: str
    name: str
    role: str
    sentence: str
    statement: Statement | None = None
    parts: tuple[str, ...] = ()
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


def plain_name(curie: str) -> str:
    """Return what users' code calls a variable: the end of its CURIE, without ``var-``."""
    return curie.replace("/", ":").rpartition(":")[2].removeprefix("var-")


def scenario_key(spec: ScenarioSpec) -> str:
    """Return what a scenario is found by in another run, of a model that may have been edited since."""
    execution = None if spec.execution is None else spec.execution.iri
    return json.dumps([spec.variant, spec.values, execution, spec.repetition], sort_keys=True)
