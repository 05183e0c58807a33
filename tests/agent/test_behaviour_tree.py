"""Execution of behaviour trees: order of attempts, recorded events, reasons for unreached nodes."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import replace
from pathlib import Path

import pytest

from robbdd_tools.agent.behaviour_calls import Timing
from robbdd_tools.agent.behaviour_run import BehaviourRun
from robbdd_tools.agent.execution import Execution
from robbdd_tools.agent.shared_executions import calls_of
from robbdd_tools.agent.tree_execution import TreeRun
from robbdd_tools.catalog.coordination import NodeSpec, TreeSpec
from robbdd_tools.catalog.executable import Implementation, Origin
from robbdd_tools.protocol.specs import ConfigSpec, ScenarioSpec
from robbdd_tools.world.errors import SceneError
from world.worlds import BALL, BIN_WS, CUBE, EVENTS, PANDA, SCENE, scenario

pytestmark = pytest.mark.physics
HEAVY = replace(SCENE, config=(ConfigSpec(BALL, "mass", "10"),))


def pick(name: str, thing: str = CUBE) -> NodeSpec:
    return NodeSpec(f"t:{name}", name, "leaf", (), "pick", {"agent": PANDA, "object": thing})


PLACE = NodeSpec("t:place", "place", "leaf", (), "place", {"agent": PANDA, "object": CUBE, "workspace": BIN_WS})


def whole(kind: str, *children: NodeSpec, name: str = "whole") -> NodeSpec:
    return NodeSpec(f"t:{name}", name, kind, children)


def of(node: str, root: NodeSpec, scene: object = SCENE) -> ScenarioSpec:
    tree = TreeSpec("t:tree 1", "t:tree", (root,), 0.5, 0.0)
    events = {f"t:{name}-{end}": f"t:{name} {end}" for name in ("first", "second", "place") for end in ("start", "end")}
    return replace(scenario(HEAVY if scene is HEAVY else SCENE, events=events), tree=tree, node=node)


def executed(spec: ScenarioSpec, course: BehaviourRun | None = None) -> Execution:
    return Execution(spec, calls_of(spec), Timing(), course)


def test_a_tree_of_pick_and_place_is_pick_and_place_to_the_bit() -> None:
    root = whole("sequence", pick("first"), PLACE)
    tree = executed(replace(of("t:whole", root), events=EVENTS)).advance_until(lambda _: False)
    call = replace(calls_of(of("t:whole", root))[0], behaviour="pick-place", arguments=PLACE.arguments)
    alone = Execution(scenario(), [call], Timing()).advance_until(lambda _: False)
    assert (tree.positions == alone.positions).all()


def test_a_selector_goes_on_where_its_first_part_fails() -> None:
    root = whole("sequence", whole("selector", pick("first", BALL), pick("second"), name="grasp"), PLACE)
    run = executed(of("t:whole", root, HEAVY))
    assert run.run_behaviour(0), run.failure(0)
    trace = run.advance_until(lambda _: False)
    times = {stamp.name: stamp.time for stamp in trace.events}
    assert list(times) == ["t:first-start", "t:second-start", "t:second-end", "t:place-start", "t:place-end"]
    assert times["t:second-end"] == times["t:place-start"]
    course = run.course
    first = executed(of("t:first", root, HEAVY), course)
    assert not first.run_behaviour(0)
    assert first.failure(0).startswith(f"gripper lost {BALL} at ")
    assert first.trace.unreached == ""


def test_what_a_selector_did_not_need_was_not_reached() -> None:
    root = whole("selector", pick("first"), pick("second"))
    run = executed(of("t:second", root))
    assert not run.run_behaviour(0)
    assert run.trace.unreached == "not reached: first had already succeeded"


def test_what_follows_a_failure_was_not_reached() -> None:
    root = whole("sequence", whole("sequence", pick("first", BALL), name="grasp"), whole("sequence", PLACE, name="put"))
    run = executed(of("t:place", root, HEAVY))
    assert not run.run_behaviour(0)
    assert run.trace.unreached.startswith(f"precondition not reached: first failed: gripper lost {BALL} at ")


def test_a_leaf_that_nothing_is_known_of_lets_nothing_be_concluded() -> None:
    open_leaf = NodeSpec("t:place", "place", "leaf", problem="nothing says what place does")
    run = executed(of("t:whole", whole("sequence", pick("first"), open_leaf)))
    assert not run.run_behaviour(0)
    assert run.broken == "nothing says what place does"


def made(folder: Path, code: str, *nodes: NodeSpec) -> ScenarioSpec:
    (folder / f"{folder.name}.py").write_text(code, encoding="utf-8")
    origin = Origin(str(folder / "m.bdd"), 3, 5)
    source = Implementation("t:tree", "python", f"{folder.name}:create", origin)
    tree = TreeSpec("t:tree 1", "t:tree", nodes, 0.5, 0.0, source)
    return replace(scenario(HEAVY), tree=tree, node=nodes[-1].iri)


def test_python_code_puts_a_tree_together(tmp_path: Path) -> None:
    code = """import py_trees

def create(leaf):
    again = py_trees.decorators.FailureIsSuccess("whatever", leaf("first"))
    return py_trees.composites.Sequence("whole", True, [again, leaf("second")])
"""
    whole_node = NodeSpec("t:whole", "whole", "leaf", problem="it is made")
    run = executed(made(tmp_path, code, pick("first", BALL), pick("second"), whole_node))
    assert run.run_behaviour(0), run.failure(0)
    assert run.broken == ""


def test_what_is_tried_again_may_succeed(tmp_path: Path) -> None:
    code = """import py_trees

class Once(py_trees.behaviour.Behaviour):
    count = 0
    def update(self):
        self.count += 1
        return py_trees.common.Status.FAILURE if self.count == 1 else py_trees.common.Status.SUCCESS

def create(leaf):
    both = py_trees.composites.Sequence("whole", False, [Once("look"), leaf("first")])
    return py_trees.decorators.Retry("twice", both, 2)
"""
    run = executed(made(tmp_path, code, pick("first"), NodeSpec("t:whole", "whole", "leaf", problem="it is made")))
    assert run.run_behaviour(0), run.failure(0)


@pytest.mark.parametrize(
    ("code", "words"),
    [
        ("def create(leaf): return 3", "create' returned a int, not a behaviour of py_trees"),
        ("def create(leaf): return leaf('third')", "the model declares no node 'third' of this tree; it has first"),
        ("def create(leaf): return leaf('first')", "has 0 nodes called 'second', not one"),
        ("def make(leaf): return None", "has no function 'create'"),
    ],
)
def test_code_that_makes_no_tree_is_reported(code: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(SceneError) as failure:
        executed(made(tmp_path, code, pick("first"), pick("second")))
    assert str(failure.value).startswith("m.bdd:3:5: ")
    assert words in str(failure.value)


AGAIN = """import py_trees

def create(leaf):
    both = py_trees.composites.Sequence("whole", True, [leaf("first"), leaf("place")])
    return py_trees.decorators.{}("again", both, {})
"""


def stamps(folder: Path, decorator: str, count: int, *outcomes: str) -> tuple[TreeRun, list[tuple[str, int]]]:
    """Tick a tree of leaves that take one tick and end with these outcomes; return it with its recorded events."""
    nodes = (pick("first"), PLACE, NodeSpec("t:whole", "whole", "leaf", problem="it is made"))
    tree = made(folder, AGAIN.format(decorator, count), *nodes).tree
    assert tree is not None
    left, found = list(outcomes), list[tuple[str, int]]()

    def attempt(_: NodeSpec) -> Generator[None, None, str]:
        yield
        return left.pop(0)

    run = TreeRun(tree, attempt, lambda name, number: found.append((name, number)))
    for _ in run.steps():
        assert run.pending >= {"t:whole end", "t:first pick-end", "t:whole place-end"}
        assert not run.is_over("t:first")
    return run, found


def test_each_execution_of_a_repeated_node_is_counted(tmp_path: Path) -> None:
    run, found = stamps(tmp_path, "Repeat", 2, "", "", "", "")
    once = ["t:first start", "t:whole start", "t:first end", "t:place start", "t:place end", "t:whole end"]
    assert sorted(found) == sorted((name, number) for name in once for number in (1, 2))
    assert [run.executions[name] for name in ("t:whole end", "t:whole pick-start", "t:place place-end")] == [2, 2, 2]
    assert run.pending == frozenset()
    assert run.has_succeeded("t:whole")


def test_the_last_execution_of_a_node_decides(tmp_path: Path) -> None:
    run, found = stamps(tmp_path, "Repeat", 2, "", "", "lost")
    assert ("t:place end", 1) in found
    assert [run.has_succeeded(node) for node in ("t:whole", "t:first", "t:place")] == [False, False, True]
    assert run.failure("t:whole") == "lost"


def test_a_failure_that_is_tried_again_leaves_no_end(tmp_path: Path) -> None:
    run, found = stamps(tmp_path, "Retry", 3, "lost", "", "")
    assert found.count(("t:first start", 2)) == found.count(("t:first end", 2)) == 1
    assert ("t:first end", 1) not in found
    assert run.executions["t:place place-end"] == 1
    assert run.has_succeeded("t:whole")


def test_a_declared_tree_executes_nothing_again() -> None:
    tree = of("t:whole", whole("sequence", pick("first"), PLACE)).tree
    assert tree is not None

    def attempt(_: NodeSpec) -> Generator[None, None, str]:
        yield
        return ""

    run = TreeRun(tree, attempt, lambda _name, _number: None)
    seen = [(run.pending, run.is_over("t:first")) for _ in run.steps()]
    assert seen == [(frozenset(), False), (frozenset(), True)]
