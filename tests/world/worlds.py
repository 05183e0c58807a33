"""Scenarios for tests of the agent: a bench with two bins, a cube, a ball and a Panda."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from kit import write_manifest
from robbdd_tools.agent.behaviour_calls import Call, Timing
from robbdd_tools.agent.execution import Execution
from robbdd_tools.protocol.specs import ClauseSpec, Manifest, ScenarioSpec, SceneSpec

PANDA, CUBE, BALL, BIN, OTHER_BIN = "env:panda", "env:cube1", "env:ball1", "env:bin1", "env:bin2"
BENCH_WS, BIN_WS, OTHER_WS = "env:bench_ws", "env:bin1_ws", "env:bin2_ws"
EVENTS = {
    "t:start": "scenario-start",
    "t:end": "scenario-end",
    "t:pick-start": "pick-start",
    "t:pick-end": "pick-end",
    "t:place-start": "place-start",
    "t:place-end": "place-end",
}
SCENE = SceneSpec(
    objects=(CUBE, BALL, BIN, OTHER_BIN, "env:bench"),
    agents=(PANDA,),
    workspaces={BENCH_WS: ("env:bench",), BIN_WS: (BIN,), OTHER_WS: (OTHER_BIN,)},
    contains={BENCH_WS: (BIN_WS, OTHER_WS)},
)
SCENE_TABLES = f"""\
    Given a set of objects
      | name |
      | {CUBE} |
    Given a set of workspaces
      | name |
      | {BIN_WS} |
    Given a set of agents
      | name |
      | {PANDA} |
    Given variable scene elements
      | name |
      | {CUBE} |
    Given the scene is set up
"""


def scenario(
    scene: SceneSpec = SCENE,
    seed: int = 1,
    clauses: tuple[ClauseSpec, ...] = (),
    line: int = 0,
    events: Mapping[str, str] = EVENTS,
) -> ScenarioSpec:
    """Return a scenario of the feature ``fetching``."""
    feature = "features/fetching.feature"
    name = f"t:fetch -- {seed}"
    return ScenarioSpec(feature, line, name, "t:story", "t:fetch", seed, {}, seed, scene, events, clauses)


def pick_place(thing: str = CUBE, workspace: str = BIN_WS, agent: str = PANDA) -> Call:
    """Return the behaviour that moves an object to a workspace."""
    return Call("pick-place", {"agent": agent, "object": thing, "workspace": workspace})


def execution(
    calls: Sequence[Call] = (), scene: SceneSpec = SCENE, seed: int = 1, timing: Timing | None = None
) -> Execution:
    """Set up an execution of behaviours in a scene."""
    return Execution(scenario(scene, seed), calls, timing)


@dataclass(frozen=True)
class Steps:
    """The steps of one scenario, each as (role, text), and the scene and seed to execute them in."""

    steps: tuple[tuple[str, str], ...]
    scene: SceneSpec = SCENE
    seed: int = 1


def write_run(folder: Path, scenarios: Sequence[Steps]) -> tuple[ScenarioSpec, ...]:
    """Write a run folder with one feature as the parent process would; returns its scenarios."""
    (folder / "features" / "steps").mkdir(parents=True)
    hooks = "after_all, after_scenario, after_step, before_all, before_scenario, before_step"
    (folder / "features" / "environment.py").write_text(f"from robbdd_tools.agent.hooks import {hooks}\n")
    (folder / "features" / "steps" / "all.py").write_text(
        "from robbdd_tools.agent.steps import register\n\nregister()\n"
    )
    text = "Feature: t:fetching\n\n"
    specs: list[ScenarioSpec] = []
    for number, entry in enumerate(scenarios, start=1):
        heading = text.count("\n") + 1
        text += f"  Scenario: t:fetch -- {number}\n{SCENE_TABLES}"
        clauses: list[ClauseSpec] = []
        for role, sentence in entry.steps:
            line = text.count("\n") + 1
            clauses.append(ClauseSpec(line, f"https://example.org/{line}", f"c{line}", role, sentence))
            text += f"    {role.capitalize()} {sentence}\n"
        text += "\n"
        specs.append(scenario(entry.scene, entry.seed, tuple(clauses), heading))
    (folder / "features" / "fetching.feature").write_text(text, encoding="utf-8")
    write_manifest(folder, Manifest("t", 1, tuple(specs)))
    return tuple(specs)
