"""A stored trace is evidence for an edited scenario only if nothing but clauses has changed, compared as data."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from robbdd_tools.catalog.coordination import NodeSpec, TreeSpec
from robbdd_tools.catalog.executable import Implementation, Link, Origin, SceneInstance
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.policy import Policy, Rule
from robbdd_tools.monitor.time import After
from robbdd_tools.protocol.clauses import BehaviourCall, Fluent
from robbdd_tools.protocol.spec_changes import (
    change_of,
    content_change,
    edited_clauses,
    seed_change,
    without_repetition,
)
from robbdd_tools.protocol.specs import ClauseSpec, ConfigSpec, ExecutionSpec, ScenarioSpec, SceneSpec

CATALOG = load_catalog()
HERE, THERE = Origin("/m.bddx", 3, 1), Origin("/m.bddx", 9, 5)


def goal(horizon: float | None = None, line: int = 9) -> ClauseSpec:
    arguments = {"object": "e:cube", "workspace": "e:bin"}
    fluent = Fluent(CATALOG.predicates["located-at"], arguments, After("c:end", horizon), "urn:goal")
    return ClauseSpec(line, "urn:goal", "goal", "then", f"for {horizon}", fluent)


def act(thing: str = "e:cube") -> ClauseSpec:
    call = BehaviourCall(CATALOG.behaviours["pick"], {"agent": "e:panda", "object": thing})
    return ClauseSpec(8, "urn:act", "act", "when", f"pick {thing}", call)


PLACED = SceneInstance("urn:scene", links=(Link("f", "", "pose", (0.0, 0.0, 1.0), origin=HERE),), origin=HERE)
EXECUTION = ExecutionSpec(
    "urn:x", "c:x", Implementation("urn:i", "catalog", "pick", HERE), PLACED,
    (Policy("urn:p", "urn:goal", Rule("distance", form="less-than", bounds=(0.25,)), origin="/m.bddx:3:1"),),
)  # fmt: skip
MOVED = replace(PLACED.links[0], position=(0.0, 0.0, 2.0))
OWN_CODE = Implementation("urn:i", "python", "m:f")
TREE = TreeSpec("t 1", "urn:t", (NodeSpec("urn:n", "n", "leaf"),), 0.5, 0.0)
STORED = ScenarioSpec(
    "f.feature", 5, "s", "urn:story", "urn:v", 1, {"v:thing": "e:cube"}, 7,
    SceneSpec(("e:cube", "e:bin"), ("e:panda",), places={"e:cube": "e:table"}),
    {"c:end": "pick-end"}, (act(), goal()), EXECUTION, tree=TREE, node="urn:n",
)  # fmt: skip


def with_execution(**changed: Any) -> ScenarioSpec:
    return replace(STORED, execution=replace(EXECUTION, **changed))


@pytest.mark.parametrize(
    ("spec", "what"),
    [
        (replace(STORED, scene=replace(STORED.scene, places={"e:cube": "e:bin"})), "the scene"),
        (replace(STORED, scene=replace(STORED.scene, config=(ConfigSpec("e:bin", "height_scale", "2"),))), "the scene"),
        (with_execution(scene=replace(PLACED, links=(MOVED,))), "the scene instance"),
        (replace(STORED, tree=replace(TREE, nodes=(NodeSpec("urn:m", "m", "leaf"),))), "the behaviour tree"),
        (replace(STORED, clauses=(act("e:bin"), goal())), "the behaviour"),
        (replace(STORED, clauses=(act(), act(), goal())), "the behaviour"),
        (with_execution(implementation=OWN_CODE), "the implementation of the behaviour"),
        (with_execution(timeout=5.0), "the time limit"),
        (replace(STORED, seed=8), "the seed"),
    ],
)  # fmt: skip
def test_a_change_beyond_clauses_is_named(spec: ScenarioSpec, what: str) -> None:
    assert change_of(spec, STORED) == f"{what} changed since the run: execute a new run"


@pytest.mark.parametrize(
    "spec",
    [
        STORED,
        with_execution(
            implementation=replace(EXECUTION.implementation, origin=THERE),
            scene=replace(PLACED, origin=THERE, links=(replace(PLACED.links[0], origin=THERE),)),
        ),
        replace(STORED, tree=replace(TREE, name="t 4", lead=2.0, tail=3.0)),
        replace(STORED, clauses=(act(), goal(2.0))),
        replace(STORED, variation=2, seed=8),
        with_execution(policies=()),
    ],
)
def test_clauses_positions_and_numbers_leave_the_trace_as_evidence(spec: ScenarioSpec) -> None:
    assert change_of(spec, STORED) == ""


def test_repetitions_are_equal_without_their_number_and_seed() -> None:
    other = replace(STORED, feature="g.feature", line=7, name="s 2", seed=8, repetition=2)
    assert without_repetition(other) == without_repetition(STORED)
    assert content_change(other, STORED) == ""
    assert seed_change(other, STORED) == change_of(other, STORED) != ""


@pytest.mark.parametrize(
    "spec",
    [
        replace(STORED, scene=replace(STORED.scene, places={"e:cube": "e:bin"})),
        with_execution(timeout=5.0),
        replace(STORED, clauses=(act(), goal(2.0))),
        replace(STORED, clauses=(act("e:bin"), goal())),
        replace(STORED, tree=None),
        replace(STORED, variation=2),
    ],
)
def test_repetitions_of_another_scenario_are_not_equal(spec: ScenarioSpec) -> None:
    assert without_repetition(spec) != without_repetition(STORED)


def test_a_run_of_an_earlier_version_is_compared_by_sentences() -> None:
    older = replace(STORED, clauses=tuple(replace(clause, statement=None) for clause in STORED.clauses))
    assert change_of(STORED, older) == ""
    assert change_of(replace(STORED, clauses=(act("e:bin"), goal())), older) != ""


def edited(spec: ScenarioSpec) -> list[str]:
    return [clause.iri for clause in edited_clauses(spec, STORED)]


def test_clauses_are_compared_by_content_and_not_by_line() -> None:
    assert edited(replace(STORED, clauses=(act(), goal(line=20)))) == []
    assert edited(replace(STORED, clauses=(act(), goal(2.0)))) == ["urn:goal"]
    new = replace(goal(), iri="urn:new")
    assert edited(replace(STORED, clauses=(act(), goal(), new))) == ["urn:new"]


def test_an_edited_policy_edits_its_clause() -> None:
    (policy,) = EXECUTION.policies
    moved = replace(policy, origin="/m.bddx:9:1")
    assert edited(with_execution(policies=(moved,))) == []
    looser = replace(policy, rule=replace(policy.rule, bounds=(0.3,)))
    assert edited(with_execution(policies=(looser,))) == ["urn:goal"]
    assert edited(with_execution(policies=())) == ["urn:goal"]


def test_of_a_clause_that_is_repeated_all_instances_are_edited_together() -> None:
    twice = replace(STORED, clauses=(act(), goal(), goal(2.0)))
    assert edited(twice) == ["urn:goal", "urn:goal"]
