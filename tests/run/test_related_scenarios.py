"""Which scenarios are judged from one execution of a behaviour tree."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from gherkin_kit import model_of
from kit import EVENTS
from robbdd_tools.catalog.executable import Implementation, SceneInstance
from robbdd_tools.gherkin.feature_files import whole_plan
from robbdd_tools.graph.acceptance_model import BehaviourTree, Execution, Iri, TreeNode
from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.run.prepare import RunRequest, lay_out, prepare
from robbdd_tools.run.related_scenarios import Relations, roots_of

TREE = "Behaviour Tree (ns=t) handling { sequence whole { node pick node place } }\n"


def template(name: str, action: str, node: str, *variables: str) -> str:
    declared = "\n    ".join(f"var {variable}" for variable in variables)
    return f"""Scenario Template (ns=t) {name} {{
    duration: from <start> until <end>
    task: <task>
    {declared}
    When: Behaviour (ns=t) do-{name} {{
        duration: from <{name}-start> until <{name}-end>
        {action}
        node: <handling.{node}>
    }}
    Then: {name}-rests: holds(<part> is held by <robot>, 2 seconds after <{name}-end>)
}}
Event (ns=t) {name}-start
Event (ns=t) {name}-end
"""


def story(name: str, **sets: str) -> str:
    lines = "\n".join(f"                var <{name}.{variable}>: {{ {values} }}" for variable, values in sets.items())
    return f"""User Story (ns=t) story-{name} {{
    As A "o" I Want "p" So That "w"
    Scenarios:
        Scenario {name}s {{
            template: <{name}>
            scene: <bench_scene>
            variation:
{lines}
        }}
}}
"""


TAKE = template("take", "<robot> picks <part>", "pick", "robot", "part")
PUT = template("put", "<robot> places <part> at <goal>", "place", "robot", "part", "goal")
BOTH = template("both", "<robot> picks <part> and places at <goal>", "whole", "robot", "part", "goal")
PANDA, PARTS, GOALS = "<arms.panda>", "<parts.bolt>, <parts.nut>", "<places.tray_ws>, <places.bench_ws>"
# Events are declared in front of what else there is.
TEMPLATES = "".join(
    sorted((TAKE + PUT + BOTH).splitlines(keepends=True), key=lambda line: not line.startswith("Event"))
)


def specs(folder: Path, *stories: str, templates: str = TEMPLATES) -> list[ScenarioSpec]:
    found = list(lay_out(whole_plan(model_of(EVENTS + TREE + templates + "".join(stories))), "main.bdd", 1, folder))
    assert list(read_manifest(folder).scenarios) == found
    return found


def groups(found: list[ScenarioSpec]) -> dict[str, list[str]]:
    together: dict[str, list[str]] = {}
    for spec in found:
        assert spec.tree is not None
        together.setdefault(spec.tree.name, []).append(spec.name.removeprefix("t:"))
    return together


def test_scenarios_with_the_same_values_share_an_execution(tmp_path: Path) -> None:
    put = story("put", robot=PANDA, part=PARTS, goal=GOALS)
    found = specs(
        tmp_path, story("take", robot=PANDA, part=PARTS), put, story("both", robot=PANDA, part=PARTS, goal=GOALS)
    )
    # Picking an object, wherever it is placed, joins the first group that fits.
    assert groups(found) == {
        "t:handling 1": ["takes -- 1", "puts -- 1", "boths -- 1"],
        "t:handling 3": ["takes -- 2", "puts -- 3", "boths -- 3"],
        "t:handling 2": ["puts -- 2", "boths -- 2"],
        "t:handling 4": ["puts -- 4", "boths -- 4"],
    }
    assert len({(spec.seed, spec.tree.name) for spec in found if spec.tree is not None}) == 4
    assert all(spec.tree is not None and spec.tree.tail == 2.0 for spec in found)


def test_the_leaves_do_what_is_linked_to_them_with_the_values_of_all(tmp_path: Path) -> None:
    found = specs(tmp_path, story("put", robot=PANDA, part="<parts.nut>", goal="<places.tray_ws>"))
    (spec,) = found
    assert spec.tree is not None
    (leaf,) = [leaf for leaf in spec.tree.leaves() if leaf.name == "place"]
    assert (leaf.behaviour, leaf.problem) == ("place", "")
    assert dict(leaf.arguments) == {"agent": "env:panda", "object": "env:nut", "workspace": "env:tray_ws"}
    (other,) = [leaf for leaf in spec.tree.leaves() if leaf.name == "pick"]
    assert other.problem == "no scenario is linked to pick, so its behaviour is undefined"


def test_repeated_rows_are_executions_of_their_own(tmp_path: Path) -> None:
    take = story("take", robot=PANDA, part="<parts.nut>, <parts.nut>")
    assert len(groups(specs(tmp_path, take))) == 2


def test_events_are_those_of_the_nodes(tmp_path: Path) -> None:
    one = {"robot": PANDA, "part": "<parts.nut>"}
    found = specs(tmp_path, story("take", **one), story("both", **one, goal="<places.tray_ws>"))
    take, both = (dict(spec.events) for spec in found)
    start, end = "https://example.org/t/node-handling.pick start", "https://example.org/t/node-handling.pick end"
    assert (take["t:start"], take["t:take-start"], take["t:take-end"]) == (start, start, end)
    # The whole tree lasts as long as its execution; what its parts emit is known to all.
    assert (both["t:start"], both["t:end"]) == ("scenario-start", "scenario-end")
    assert both["t:take-end"] == end
    assert both["t:both-end"] == "https://example.org/t/node-handling.whole end"


def test_executions_of_one_setting_go_together(tmp_path: Path) -> None:
    one = {"robot": PANDA, "part": "<parts.nut>"}
    model = model_of(EVENTS + TREE + TEMPLATES + story("take", **one) + story("put", **one, goal="<places.tray_ws>"))
    take, put = (story.variants[0].iri for story in model.stories)
    builtin = Implementation("t:builtin", "catalog", "pick-place")
    executions = tuple(
        Execution(Iri(f"https://example.org/t/{name}"), variant, builtin, seed=seed, repeat=2)
        for name, variant, seed in (("a", take, None), ("b", put, None), ("c", put, 7))
    )
    model = replace(model, executions=executions)
    found = list(prepare(RunRequest(model, "main.bdd"), tmp_path).scenarios)
    assert list(read_manifest(tmp_path).scenarios) == found
    together: dict[str, list[str]] = {}
    for spec in found:
        assert spec.tree is not None
        assert spec.execution is not None
        together.setdefault(spec.tree.name, []).append(f"{spec.execution.name} {spec.repetition}")
    # The first one is that of the scenarios as they are, without a ``.bddx``.
    assert together == {
        "t:handling 2": ["t:a 1", "t:b 1"],
        "t:handling 2.2": ["t:a 2", "t:b 2"],
        "t:handling 3": ["t:c 1"],
        "t:handling 3.2": ["t:c 2"],
    }


def test_executions_in_different_settings_do_not_go_together() -> None:
    one = {"robot": PANDA, "part": "<parts.nut>"}
    model = model_of(EVENTS + TREE + TEMPLATES + story("take", **one) + story("put", **one, goal="<places.tray_ws>"))
    take, put = (story.variants[0].iri for story in model.stories)
    plain = Execution(Iri("https://example.org/t/a"), take, Implementation("t:builtin", "catalog", "pick-place"))
    others = (
        replace(plain, seed=7),
        replace(plain, timeout=9.0),
        replace(plain, implementation=Implementation("t:other", "catalog", "pick-place")),
        replace(plain, scene=SceneInstance("t:cell", (), (), (), (), (), "t:root")),
    )
    for number, other in enumerate((plain, *others)):
        executions = (plain, replace(other, iri=Iri("https://example.org/t/b"), variant=put))
        relations = Relations(replace(model, executions=executions))
        together = relations.group(take, plain.iri, 1) is relations.group(put, executions[1].iri, 1)
        assert together is (number == 0), other


def test_scenarios_in_different_scenes_do_not_go_together() -> None:
    one = {"robot": PANDA, "part": "<parts.nut>"}
    model = model_of(EVENTS + TREE + TEMPLATES + story("take", **one) + story("put", **one, goal="<places.tray_ws>"))
    take, put = (story.variants[0] for story in model.stories)
    found = Relations(model)
    assert found.group(take.iri, None, 1) is found.group(put.iri, None, 1) is not None
    bare = replace(put, scene=replace(put.scene, objects=()))
    stories = (model.stories[0], replace(model.stories[1], variants=(bare,)))
    found = Relations(replace(model, stories=stories))
    assert found.group(take.iri, None, 1) is not found.group(put.iri, None, 1)


def test_the_roots_of_a_tree_that_code_makes_are_all_its_nodes() -> None:
    nodes = (Iri("t:one"), Iri("t:two"))
    root = TreeNode(Iri("t:one"), "sequence")
    assert roots_of(BehaviourTree(Iri("t:tree"), nodes)) == tuple(TreeNode(node, "leaf") for node in nodes)
    assert roots_of(BehaviourTree(Iri("t:tree"), nodes, root)) == (root,)


def test_a_scenario_without_a_tree_has_neither_node_nor_group() -> None:
    model = model_of(EVENTS + TREE + TEMPLATES + story("take", robot=PANDA, part=PARTS))
    (variant,) = model.stories[0].variants
    linked = Relations(model).node(variant)
    assert linked is not None
    assert (linked.node.endswith("handling.pick"), linked.is_root) == (True, False)
    alone = Relations(replace(model, trees=()))
    assert alone.node(variant) is None
    assert alone.group(variant.iri, None, 1) is None
    assert alone.behaviours == {}
