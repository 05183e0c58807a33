"""The work of an agent process as plain data: scenarios with their scenes, events, clauses and executions."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from robbdd_tools.catalog.coordination import TreeSpec
from robbdd_tools.catalog.executable import ChosenScene, Implementation, SceneInstance, Substitution
from robbdd_tools.catalog.robot_faults import RobotFault
from robbdd_tools.monitor.policy import Policy
from robbdd_tools.monitor.without_physics import KINEMATIC
from robbdd_tools.protocol.clauses import DefinedEvent, Statement


@dataclass(frozen=True, slots=True)
class ConfigSpec:
    """A configuration that a Given clause sets: the CURIE of the element, the name, and the value as text."""

    target: str
    name: str
    value: str


@dataclass(frozen=True, slots=True)
class SceneSpec:
    """The contents of a scenario's world. All names are CURIEs, as in the text of the feature.

    - ``workspaces``: maps a workspace to the objects that carry it.
    - ``contains``: maps a workspace to the workspaces inside it, for example a table's to the workspace of a bin.
    - ``places``: maps an object to the workspace where the Given clauses put it.
    - ``config``: the configurations that the Given clauses set.
    - ``unused``: the objects and agents that no clause mentions.
    - ``correct_places``: maps an object to the workspaces that the model states to be correct for it.
    - ``sets``: maps elements to the local names of their sets, where models are chosen by name.
    - ``stated``: the configurations that properties of objects state. They hold for models of the catalog only, and
      ``config`` replaces them.
    """

    objects: tuple[str, ...] = ()
    agents: tuple[str, ...] = ()
    workspaces: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    contains: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    places: Mapping[str, str] = field(default_factory=dict[str, str])
    config: tuple[ConfigSpec, ...] = ()
    unused: tuple[str, ...] = ()
    sets: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    correct_places: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    stated: tuple[ConfigSpec, ...] = ()


@dataclass(frozen=True, slots=True)
class ExecutionSpec:
    """The way in which scenarios are executed, as specified in a ``.bddx``.

    - ``name``: the CURIE of the execution.
    - ``implementation``: executes the behaviours in ``scene``, whose elements are CURIEs.
    - ``policies``: judge the clauses that they name by IRI. Their observations are CURIEs.
    - ``repeat``: the number of executions.
    - ``timeout``: the limit in s of simulated time.
    - ``seed``: the seed that it states, unless the run's options replace it.
    """

    iri: str
    name: str
    implementation: Implementation
    scene: SceneInstance | None = None
    policies: tuple[Policy, ...] = ()
    repeat: int = 1
    timeout: float | None = None
    seed: int | None = None


NO_PHYSICS = "kinematic world: no physics"
"""How results say that a scenario was executed in the kinematic world."""
PROBE = "probe"
"""Role of a clause that is not in the model. It is measured at the end of an execution, and decides no verdict."""


@dataclass(frozen=True, slots=True)
class ClauseSpec:
    """One clause of one scenario: the feature line of its step, the IRI of the judged clause, and its role.

    A clause of the role ``PROBE`` has a negative number instead of a line.

    - ``statement``: the content of the clause. It is missing in a run that an earlier version stored; then ``sentence``
      is parsed.
    - ``parts``: the IRIs of the fluents and texts of a group, in the order of the sentence.
    - ``iterations``: the first and the last behaviour of the clause's scope, counted from 1 within the scenario; empty
      if the scenario executes a single behaviour.
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
    """One execution of a scenario, with its values and its clauses in order.

    - ``events``: maps the CURIE of an event to its emitter: ``scenario-start``, ``scenario-end`` or the name of an
      event of the behaviour (``pick-start`` …).
    - ``defined``: the events that the template defines by conditions. In ``events``, their emitter is ``defined``.
    - ``seed``: determines all randomness of the execution.
    - ``execution``: the execution of a ``.bddx``; ``None`` if the scenario is run without one.
    - ``repetition``: its number (from 1). Repetitions have the same scenario in the feature but different seeds.
    - ``model``: the name of the file in reports.
    - ``tree``: the execution of a behaviour tree. All scenarios with the same tree execution are judged from it, and
      have its scene and seed.
    - ``node``: the IRI of the tree's node that is linked to this scenario.
    - ``world``: the simulator, ``KINEMATIC``, or empty for physics.
    - ``chosen_instance``: the scene instance that the user chose, for a scenario whose execution has none.
    - ``fault``: a fault that the robots have in this execution.
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
    chosen_instance: SceneInstance | None = None
    world: str = ""
    fault: RobotFault | None = None
    defined: tuple[DefinedEvent, ...] = ()

    @property
    def instance(self) -> SceneInstance | None:
        """The scene instance in which the scenario runs: the execution's, else the chosen one."""
        own = None if self.execution is None else self.execution.scene
        return own or self.chosen_instance

    @property
    def chosen_scene(self) -> ChosenScene | None:
        """The chosen scene instance, ``None`` if the scenario runs without one or in that of its execution."""
        chosen = self.chosen_instance
        if chosen is None or chosen is not self.instance:
            return None
        return ChosenScene(chosen.iri, "" if chosen.origin is None else chosen.origin.file)

    @property
    def choices(self) -> tuple[str, ...]:
        """The user's choices that the model does not state, in words: a behaviour, a scene instance, a world."""
        choices = (self.substitution, self.chosen_scene, NO_PHYSICS if self.world == KINEMATIC else None)
        return tuple(str(one) for one in choices if one is not None)

    @property
    def substitution(self) -> Substitution | None:
        """The catalog behaviour that is executed instead of the model's implementation, if there is one."""
        return None if self.execution is None else self.execution.implementation.substitution


@dataclass(frozen=True, slots=True)
class Manifest:
    """Everything that the agent needs, apart from the feature files.

    If ``traces`` is true, the agent writes a ``trace_file`` for each scenario. ``sources`` maps the path of each file
    of users' steps in the run folder to the file that was copied.
    """

    model: str
    seed: int
    scenarios: tuple[ScenarioSpec, ...]
    traces: bool = False
    sources: Mapping[str, str] = field(default_factory=dict[str, str])


def plain_name(curie: str) -> str:
    """Return the name of a variable in users' code, which is the end of its CURIE without ``var-``."""
    return curie.replace("/", ":").rpartition(":")[2].removeprefix("var-")


def scenario_key(spec: ScenarioSpec) -> str:
    """Return the key by which a scenario is found in another run, even if the model was edited."""
    execution = None if spec.execution is None else spec.execution.iri
    return json.dumps([spec.variant, spec.values, execution, spec.repetition], sort_keys=True)
