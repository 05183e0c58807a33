"""The work of an agent process as plain data: scenarios with their scenes, events, clauses and executions."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from robbdd_tools.catalog.coordination import TreeSpec
from robbdd_tools.catalog.executable import Implementation, SceneInstance, Substitution
from robbdd_tools.monitor.policy import Policy
from robbdd_tools.protocol.clauses import Statement


@dataclass(frozen=True, slots=True)
class ConfigSpec:
    """A configuration that a Given clause sets: the element's CURIE, the name, the value as text."""

    target: str
    name: str
    value: str


@dataclass(frozen=True, slots=True)
class SceneSpec:
    """Content of a scenario's world; all names are CURIEs as in the feature text.

    ``workspaces`` maps a workspace to the objects that carry it; ``contains`` to the workspaces inside it (a bin's
    workspace within the table's); ``places`` maps an object to the workspace where the Given clauses put it. ``config``
    are the configurations that the Given clauses set. ``unused`` are the objects and agents that no clause mentions;
    ``sets`` maps elements to the local names of their sets, where models are chosen by name.
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
    """How scenarios are executed, as specified in a ``.bddx``: ``name`` is the execution's CURIE.

    ``implementation`` executes the behaviours in ``scene`` (elements by CURIE); ``policies`` judge the clauses that
    they name (by IRI; their observations are CURIEs). ``repeat`` is the number of executions, ``timeout`` is in seconds
    of simulated time.
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
    """One clause of one scenario: the feature line of its step, the IRI of the judged clause, its role.

    ``statement`` is its content; in a run stored by an earlier version it is missing, and ``sentence`` is parsed.
    ``parts`` are the IRIs of the fluents and texts of a group, in the order of the sentence. ``iterations`` are the
    first and the last behaviour of the clause's scope, counted from 1 within the scenario; empty if the scenario
    executes a single one.
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

    ``events`` maps an event's CURIE to its emitter: ``scenario-start``, ``scenario-end`` or the name of an event of the
    behaviour (``pick-start`` …); ``seed`` determines all its randomness. ``execution`` is the one of a ``.bddx``,
    ``None`` for a scenario that is run without. Repetitions, counted from 1, share the feature's scenario and differ in
    their seeds. ``model`` is the file's name in reports. ``tree`` is the execution of a behaviour tree from which all
    scenarios with the same one are judged, ``node`` the IRI of the tree's node linked to this scenario; scene and seed
    are then those of that execution.
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

    @property
    def substitution(self) -> Substitution | None:
        """The catalog behaviour that is executed in place of the model's implementation, if there is one."""
        return None if self.execution is None else self.execution.implementation.substitution


@dataclass(frozen=True, slots=True)
class Manifest:
    """Everything that the agent needs besides the feature files; with ``traces`` it writes each ``trace_file``.

    ``sources`` maps files of users' steps, by their path in the run folder, to the files that they are copies of.
    """

    model: str
    seed: int
    scenarios: tuple[ScenarioSpec, ...]
    traces: bool = False
    sources: Mapping[str, str] = field(default_factory=dict[str, str])


def plain_name(curie: str) -> str:
    """Return the name of a variable in users' code: the end of its CURIE, without ``var-``."""
    return curie.replace("/", ":").rpartition(":")[2].removeprefix("var-")


def scenario_key(spec: ScenarioSpec) -> str:
    """Return the key that finds a scenario in another run, even of an edited model."""
    execution = None if spec.execution is None else spec.execution.iri
    return json.dumps([spec.variant, spec.values, execution, spec.repetition], sort_keys=True)
