"""What leaves clauses of a graph file unknown is reported at the node that causes it, as in text."""

from __future__ import annotations

from pathlib import Path

import pytest

import robbdd_tools as robbdd
from kit import EXAMPLES, MODEL, SCENE, corpus, fixture
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.graph.rdf.serialize import serialize
from robbdd_tools.graph.write.build import build_graph

BENCH = (
    SCENE.replace("object bolt, object nut", "object cube_a, object cube_b")
    .replace("bench,", "table,")
    .replace("furniture.bench", "furniture.table")
)
CELL = MODEL.replace("parts.bolt", "parts.cube_a").replace("parts.nut", "parts.cube_b")


def found(tmp_path: Path, model: str, scene: str = BENCH) -> dict[str, list[tuple[str, str]]]:
    """Return the findings on the graph of a model: code → (first words of the line, message)."""
    case = fixture(f"//- main.bdd\n{model}//- lab.scene\n{scene}")
    text = serialize(build_graph(case.snapshot, case.uri).graph, "ttl")
    path = tmp_path / "m.ttl"
    path.write_text(text, encoding="utf-8")
    lines = text.splitlines()
    findings: dict[str, list[tuple[str, str]]] = {}
    for one in robbdd.load(path).diagnostics:
        findings.setdefault(one.code, []).append((lines[one.place.line - 1].split(" ")[0], one.message))
    return findings


def test_a_model_without_such_causes_has_no_finding(tmp_path: Path) -> None:
    assert found(tmp_path, CELL) == {}


@pytest.mark.parametrize("example", sorted(EXAMPLES.rglob("*.bdd*")), ids=lambda path: path.name)
def test_the_graph_of_an_example_has_the_findings_of_its_text(example: Path, tmp_path: Path) -> None:
    def codes(path: Path) -> set[str]:
        return {one.code for one in robbdd.load(path).diagnostics if one.severity <= Severity.WARNING}

    path = tmp_path / "m.ttl"
    path.write_text(robbdd.load(example).graph(), encoding="utf-8")
    # The graph is in another folder than the model's files and Python modules.
    assert codes(path) - {"model-file", "python-source"} == codes(example)


def test_elements_without_a_model_are_warnings_if_a_scenario_uses_them(tmp_path: Path) -> None:
    scene = SCENE.replace("object bolt, object nut", "object one, object two")
    model = MODEL.replace("parts.bolt", "parts.one").replace("parts.nut", "parts.two")
    findings = found(tmp_path, model, scene.replace("object tray", "object tray, object gizmo"))
    assert [node for node, _ in findings["no-model"]] == ["env:one", "env:two"]
    assert "it has none of the catalog's words (ball, bin, " in findings["no-model"][0][1]
    bystander = BENCH.replace("scene (ns=env) bench_scene {", "obj set (ns=env) kit { object gizmo }\nscene (ns=env) "
                              "bench_scene { obj set <kit>")  # fmt: skip
    ((node, message),) = found(tmp_path, CELL, bystander)["no-model"]
    assert (node, message) == (
        "env:gizmo",
        "'env:gizmo': no model fits the name 'gizmo': no scenario uses it, so runs omit it",
    )


def test_a_set_name_that_fits_gives_its_elements_a_model(tmp_path: Path) -> None:
    scene = BENCH.replace("parts", "cubes").replace("cube_a", "bolt").replace("cube_b", "nut")
    assert found(tmp_path, MODEL.replace("<parts", "<cubes"), scene) == {}


def test_a_workspace_that_nothing_carries_is_reported_at_its_node(tmp_path: Path) -> None:
    scene = BENCH.replace(" ws comp <tray_comp> agn", " agn").replace(" ws comp <tray_comp> }", " }")
    ((node, message),) = found(tmp_path, CELL, scene)["no-region"]
    assert node == "env:tray_ws"
    assert "carries 'tray_ws', so that scenarios with it stay unknown" in message


def test_too_many_containers_and_agents_are_reported(tmp_path: Path) -> None:
    many = ", ".join(f"object tray{number}" for number in range(9))
    findings = found(tmp_path, CELL, BENCH.replace("bench_scene {", "bench_scene { obj set <more>")
                     .replace("ws set", f"obj set (ns=env) more {{ {many} }}\nws set", 1))  # fmt: skip
    assert "place the scene in a .scenex" in findings["no-room"][0][1]


CONFIGURED = CELL.replace("    var goal\n", "    var goal\n    var value\n").replace(
    "on-bench:", "slow: holds(<robot> has config KEY = <value>, before <pick-start>) and on-bench:"
).replace("Given:\n        ", "Given: (").replace("before <pick-start>)\n", "before <pick-start>))\n").replace(
    "                var <fetch.goal>", "                var <fetch.value>: { VALUE }\n                var <fetch.goal>"
)  # fmt: skip


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("ee_speed", "0.5", ""),
        ("speed", "0.5", "there is no configuration 'speed'; did you mean 'ee_speed' (an agent), 'max_speed'"),
        ("ee_speed", "50", "'ee_speed' cannot be '50': it must be a number from 0.01 to 3 m/s"),
        ("mass", "0.5", "'panda' (an agent) has no mass: it applies to a loose object"),
    ],
)
def test_a_configuration_that_cannot_be_made_is_reported_at_its_clause(
    key: str, value: str, message: str, tmp_path: Path
) -> None:
    findings = found(tmp_path, CONFIGURED.replace("KEY", key).replace("VALUE", value))
    assert set(findings) == ({"setting"} if message else set())
    for node, text in findings.get("setting", ()):
        assert node == "t:slow"
        assert text.startswith(f"'t:slow': {message}")


def test_a_step_function_beside_the_graph_judges_a_text(tmp_path: Path) -> None:
    model = CELL.replace("in-tray: holds(<part> is located at <goal>,", "in-tray: holds(pred('{o} is safe', o=<part>),")
    ((node, message),) = found(tmp_path, model)["no-evaluator"]
    assert (node, message.startswith("'t:in-tray': nothing judges this text")) == ("t:in-tray", True)
    steps = tmp_path / "steps" / "m_steps.py"
    steps.parent.mkdir()
    steps.write_text("from behave import then\n@then('{part} is safe for 0.5 seconds after event \"{e}\"')\n"
                     "def safe(context, part, e): pass\n", encoding="utf-8")  # fmt: skip
    assert found(tmp_path, model) == {}


def test_files_and_modules_are_looked_for_next_to_the_graph(tmp_path: Path) -> None:
    scenex = """import "lab.scene"
ns sim = 'https://example.org/sim/'
scene inst (ns=sim) lab_sim { scene: <bench_scene>
    obj <parts.cube_a> { model a_model as mjcf { sys path = "a.xml" gripper { sys path = "b.xml" on: "hand" } } }
    obj <parts.cube_b> { model b_model as mjcf { py { module: shapes, attr: Shape } } }
}
"""
    bddx = """import "main.bdd"
import "lab.scenex"
ns x = 'https://example.org/x/'
bhv impl (ns=x) own { py { module: mine, attr: Pick } }
obs provider (ns=x) truth { simulation ground truth update-rate: 100 Hz }
observation (ns=x) pose { provider: <truth> observes var <fetch.part> }
obs policy (ns=x) near for <fetch.in-tray> { observations: { <pose> } evaluator: py { module: mine, attr: near } }
Scenario Exec (ns=x) run { variant: <fetching.bench-to-tray> scene inst: <lab_sim> bhv: <own> policies: { <near> }
    repeat: 1 seed: 1 timeout: 60 seconds }
"""
    case = fixture(f"//- run.bddx\n{bddx}//- main.bdd\n{CELL}//- lab.scenex\n{scenex}//- lab.scene\n{BENCH}")
    path = tmp_path / "run.ttl"
    path.write_text(serialize(build_graph(case.snapshot, case.uri).graph, "ttl"), encoding="utf-8")

    def messages() -> list[str]:
        found = robbdd.load(path).diagnostics
        return sorted(one.message for one in found if one.code in ("python-source", "model-file"))

    mine = "there is no module 'mine': put mine.py next to this file"
    assert messages() == [
        "'sim:lab_sim.a_model': the model file 'a.xml' is not on this machine: put it there, or change the path, "
        "before a run with it",
        "'sim:lab_sim.a_model': the model file 'b.xml' is not on this machine: put it there, or change the path, "
        "before a run with it",
        "'sim:lab_sim.b_model': there is no module 'shapes': put shapes.py next to this file",
        f"'x:near': {mine}",
        f"'x:own': {mine}",
    ]
    (tmp_path / "a.xml").touch()
    (tmp_path / "b.xml").touch()
    (tmp_path / "shapes.py").write_text("class Shape: ...\n", encoding="utf-8")
    (tmp_path / "mine.py").write_text("class Pick: ...\n", encoding="utf-8")
    assert messages() == ["'x:near': the module 'mine' has no 'near'"]


def test_the_published_form_of_an_execution_is_read() -> None:
    """The bindings to ROS, the policies, and the scene instance that the execution itself does not name."""
    folder = corpus(".bddx")[0].parent.parent / "graphs"
    execution, criteria = (folder / f"pickplace_table_custom.{kind}.ttl" for kind in ("bddx", "bdd"))
    model = robbdd.load(execution, criteria)
    (file,) = model.files
    (read,) = file.acceptance.executions
    assert read.implementation.words == "ROS action '/bdd/mockup_bhv_server'"
    assert {policy.rule.kind for policy in read.policies} == {"topic"}
    assert len(read.policies) == 3
    assert read.scene is not None
    (source,) = read.scene.models
    assert (source.format, source.name) == ("mjcf", "~/.cache/mj_kdl_wrapper/assets/pickplace.xml")
    assert sorted(one.code for one in model.diagnostics) == ["model-file", *["not-simulated"] * 4]


@pytest.mark.parametrize(
    "clause", ["<goal> is correct for <part>", "<robot> moves safely whenever <goal> is correct for <part>"]
)
def test_objects_without_a_correct_place_are_found_in_clauses_and_their_conditions(tmp_path: Path, clause: str) -> None:
    asked = CELL.replace(
        "<part> is located at <goal>, 0.5 seconds after <place-end>", f"{clause}, from <pick-start> until <place-end>"
    )
    assert asked != CELL
    assert [message.split("'")[1] for _, message in found(tmp_path, asked)["no-correct-place"]] == [
        "env:cube_a",
        "env:cube_b",
    ]
