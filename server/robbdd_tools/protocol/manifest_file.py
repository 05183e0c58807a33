"""The file in a run folder that lists the scenarios for the agent to execute.

A scenario refers to its execution and its chosen scene instance by their IRIs, and to its behaviour tree by its name.
Each of these is written once.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, fields, replace
from functools import cache
from pathlib import Path
from typing import Any

from robbdd_tools.base.files import load_text
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.base.plain import from_plain
from robbdd_tools.base.writing import replacing
from robbdd_tools.catalog.coordination import TreeSpec
from robbdd_tools.catalog.executable import SceneInstance
from robbdd_tools.catalog.robot_faults import RobotFault
from robbdd_tools.protocol.clauses import DefinedEvent, Fluent, Statement, to_plain
from robbdd_tools.protocol.clauses import from_plain as statement_from_plain
from robbdd_tools.protocol.specs import ClauseSpec, ConfigSpec, ExecutionSpec, Manifest, ScenarioSpec, SceneSpec

MANIFEST = "manifest.json"
STORED_RESULTS = "stored-results.json"
"""Name of the file, next to a manifest, with the results of the stored run that is judged again."""


def written_manifest(folder: Path, head: Manifest, scenarios: Iterable[ScenarioSpec]) -> Iterator[ScenarioSpec]:
    """Write a manifest into a run folder, and yield each scenario after it is written. Raises ``OSError``.

    ``head`` is the manifest to write, without its scenarios.
    """
    executions: dict[str, ExecutionSpec] = {}
    trees: dict[str, TreeSpec] = {}
    instances: dict[str, SceneInstance] = {}
    with replacing(folder / MANIFEST) as file:
        begin = {"model": head.model, "seed": head.seed, "traces": head.traces, "sources": dict(head.sources)}
        file.write(_json(begin)[:-1] + ', "scenarios": [')
        separator = "\n"
        for spec in scenarios:
            file.write(separator + _json(spec))
            separator = ",\n"
            if spec.execution is not None:
                executions.setdefault(spec.execution.iri, spec.execution)
            if spec.tree is not None:
                trees[spec.tree.name] = spec.tree
            if spec.chosen_instance is not None:
                instances.setdefault(spec.chosen_instance.iri, spec.chosen_instance)
            yield spec
        for name, beside in (("executions", executions), ("trees", trees), ("instances", instances)):
            file.write(f'\n], "{name}": [' + ",\n".join(_json(asdict(one)) for one in beside.values()))
        file.write("]}\n")


def read_manifest(folder: Path) -> Manifest:
    """Return the manifest of a run folder. Raises ``OSError``, ``ValueError``, ``KeyError`` or ``TypeError``."""
    data = json.loads(load_text(folder / MANIFEST, RESULT_SIZE))
    executions = {entry["iri"]: from_plain(ExecutionSpec, entry) for entry in data.get("executions", ())}
    trees = {entry["name"]: from_plain(TreeSpec, entry) for entry in data.get("trees", ())}
    instances = {entry["iri"]: from_plain(SceneInstance, entry) for entry in data.get("instances", ())}
    scenarios = tuple(read_scenario(entry, executions, trees, instances) for entry in data["scenarios"])
    return Manifest(data["model"], data["seed"], scenarios, data.get("traces", False), data.get("sources", {}))


def scenario_text(spec: ScenarioSpec) -> str:
    """Return a scenario as JSON, as in a manifest: with the names of its execution, scene instance and tree."""
    return _json(spec)


def read_scenario(
    entry: dict[str, Any],
    executions: Mapping[str, ExecutionSpec],
    trees: Mapping[str, TreeSpec],
    instances: Mapping[str, SceneInstance],
) -> ScenarioSpec:
    """Return the scenario from JSON data of a manifest, in which IRIs and names stand for parts of the scenario.

    Raises ``ValueError``, ``KeyError`` or ``TypeError``.
    """
    scene = entry.pop("scene")
    clauses = entry.pop("clauses")
    execution, tree = entry.pop("execution", None), entry.pop("tree", None)
    instance, fault = entry.pop("chosen_instance", None), entry.pop("fault", None)
    defined = tuple(_defined(one) for one in entry.pop("defined", ()))
    return ScenarioSpec(
        scene=SceneSpec(
            tuple(scene["objects"]),
            tuple(scene["agents"]),
            {name: tuple(objects) for name, objects in scene["workspaces"].items()},
            {name: tuple(inner) for name, inner in scene["contains"].items()},
            dict(scene["places"]),
            tuple(ConfigSpec(**config) for config in scene["config"]),
            tuple(scene.get("unused", ())),
            {name: tuple(sets) for name, sets in scene.get("sets", {}).items()},
            {name: tuple(places) for name, places in scene.get("correct_places", {}).items()},
            tuple(ConfigSpec(**config) for config in scene.get("stated", ())),
        ),
        clauses=tuple(map(_clause, clauses)),
        execution=None if execution is None else executions[execution],
        tree=None if tree is None else trees[tree],
        chosen_instance=None if instance is None else instances[instance],
        fault=None if fault is None else from_plain(RobotFault, fault),
        defined=defined,
        **entry,
    )


def _clause(entry: dict[str, Any]) -> ClauseSpec:
    # Earlier versions wrote the values for users' code next to the sentence.
    entry.pop("arguments", None)
    statement = entry.pop("statement", None)
    found = from_plain(ClauseSpec, entry)
    return found if statement is None else replace(found, statement=statement_from_plain(statement))


def _defined(entry: dict[str, Any]) -> DefinedEvent:
    conditions = tuple(map(statement_from_plain, entry["conditions"]))
    fluents = tuple(one for one in conditions if isinstance(one, Fluent))
    if not fluents or len(fluents) < len(conditions):
        raise ValueError(f"{entry!r} is not the definition of an event")
    return DefinedEvent(entry["name"], fluents, entry["seconds"])


def _json(value: object) -> str:
    return json.dumps(value, default=_plain, ensure_ascii=False)


def _plain(value: Any) -> object:
    """Return the fields of a dataclass without copying them, unlike ``asdict``.

    Names replace executions, scene instances and trees.
    """
    if isinstance(value, ExecutionSpec | SceneInstance):
        return value.iri
    if isinstance(value, TreeSpec):
        return value.name
    if isinstance(value, Statement):
        return to_plain(value)
    return {name: getattr(value, name) for name in _names(value.__class__)}


@cache
def _names(kind: type[Any]) -> tuple[str, ...]:
    return tuple(entry.name for entry in fields(kind))
