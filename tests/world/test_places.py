"""Sets of workspaces as places: the behaviour chooses one with room, by the seed of the scenario."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from robbdd_tools.agent.behaviour_calls import Call
from robbdd_tools.agent.execution import Execution
from robbdd_tools.agent.shared_executions import call_of
from robbdd_tools.catalog.executable import Implementation, Origin
from robbdd_tools.judging.parsed_sentences import read_step
from robbdd_tools.protocol.clauses import BehaviourCall
from robbdd_tools.protocol.specs import ExecutionSpec
from robbdd_tools.world.errors import SceneError
from world.worlds import BALL, BIN_WS, CUBE, OTHER_WS, PANDA, SCENE, execution, scenario

BINS = (BIN_WS, OTHER_WS)
ANY_BIN = f"any of ['{BIN_WS}', '{OTHER_WS}']"


def placing(thing: str = CUBE, places: tuple[str, ...] = BINS) -> Call:
    return Call("pick-place", {"agent": PANDA, "object": thing, "workspace": places})


def chosen(seed: int) -> str:
    run = execution([placing()], seed=seed)
    assert run.run_behaviour(0), run.failure(0)
    return run.chosen(0)


@pytest.mark.physics
def test_the_choice_follows_from_the_seed() -> None:
    found = [chosen(seed) for seed in range(1, 7)]
    assert set(found) == set(BINS)
    assert chosen(1) == found[0]


@pytest.mark.physics
def test_a_place_without_room_is_not_chosen() -> None:
    # Six balls leave no room in a bin.
    things = tuple(f"env:ball{number}" for number in range(2, 8))
    full = replace(SCENE, objects=(*SCENE.objects, *things), places=dict.fromkeys(things, BIN_WS))
    for seed in (1, 2, 3, 4):
        run = execution([placing()], full, seed)
        assert run.run_behaviour(0), run.failure(0)
        assert run.chosen(0) == OTHER_WS


@pytest.mark.physics
def test_what_cannot_be_placed_anywhere_names_the_places() -> None:
    with pytest.raises(SceneError, match="cannot place at any of env:nowhere_ws, env:elsewhere_ws"):
        execution([placing(places=("env:nowhere_ws", "env:elsewhere_ws"))])


def test_sentences_with_sets_are_read() -> None:
    for text in (ANY_BIN, f"['{BIN_WS}', '{OTHER_WS}']"):
        call = read_step("when", f'"{PANDA}" picks "{CUBE}" and places it at "{text}"')
        assert isinstance(call, BehaviourCall)
        assert call_of(call) == placing()


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (f'"{PANDA}" picks "[\'{CUBE}\', \'{BALL}\']" and places it at "{BIN_WS}"', "needs one object, not a set"),
        (f'"{PANDA}" picks "{CUBE}" and places it at "any of []"', "the set is empty"),
    ],
)
def test_only_places_may_be_sets(text: str, reason: str) -> None:
    call = read_step("when", text)
    assert isinstance(call, BehaviourCall)
    with pytest.raises(SceneError, match=reason):
        call_of(call)


@pytest.mark.physics
def test_a_users_behaviour_gets_the_set(tmp_path: Path) -> None:
    (tmp_path / "gets_the_set.py").write_text(
        "class Look:\n"
        "    def reset(self, world, behaviour, arguments):\n"
        "        self.left = 1\n"
        f"        assert arguments['workspace'] == {BINS!r}, arguments\n"
        "    def step(self):\n"
        "        self.left -= 1\n"
        "        return self.left < 0\n"
    )
    own = Implementation("x:own", "python", "gets_the_set:Look", Origin(str(tmp_path / "run.bddx"), 1, 1))
    run = Execution(replace(scenario(), execution=ExecutionSpec("x:run", "x:run", own)), [placing()])
    assert run.run_behaviour(0), run.failure(0)
    assert run.chosen(0) == ""
