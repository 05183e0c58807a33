"""A ``.bddx`` is read back from the graph as plain data, from every format."""

from __future__ import annotations

import math

import pytest

from kit import MODEL, SCENE, fixture
from robbdd_tools.catalog.executable import Implementation, SceneInstance
from robbdd_tools.graph.acceptance_model import Execution
from robbdd_tools.graph.rdf.serialize import FORMATS, parse, serialize
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.monitor.policy import Observation, Policy, Provider, Rule, View
from robbdd_tools.protocol.recorded_log import RecordedLog

X, T, ENV = "https://example.org/x/", "https://example.org/t/", "https://example.org/env/"
BDDX = """import "main.bdd"
import "bench.scenex"
ns x = 'https://example.org/x/'
bhv impl (ns=x) own { py { module: my.arm, attr: Pick } }
obs provider (ns=x) truth { simulation ground truth update-rate: 100 Hz noise: 2 mm latency: 0.05 s
    range: 30 cm to 1.5 m from var <fetch.robot> misses: 5 % }
obs provider (ns=x) poses { ros topic: "/poses" type: "geometry_msgs/msg/PoseArray" noise: 5 mm }
observation (ns=x) part-pose { provider: <truth> observes var <fetch.part> observes obj <furniture.tray> }
observation (ns=x) seen-pose {
    provider: <poses>
    observes obj <parts.bolt>
    time extractor: py { module: my.ros, attr: stamp }
    entity mapper: string { "b" to obj <parts.bolt> }
}
obs policy (ns=x) near for <fetch.on-bench> horizon: 2.0 seconds certain beyond: 3 sigma {
    observations: { <part-pose>, <seen-pose> }
    evaluator: linear distance { between: 10 mm and 0.05 m max time offset: 0.1 s }
}
obs policy (ns=x) told for <fetch.on-bench> { trinary topic: "/seen" }
obs policy (ns=x) coded for <fetch.on-bench> {
    observations: { <part-pose> }
    evaluator: py { module: my.rules, attr: near }
}
robot log (ns=x) monday {
    path: "bags/monday"
    where <fetch.part> = <parts.bolt> and <fetch.robot> = <arms.panda>
    frames: { "camera/object_7" to obj <parts.bolt>, "tool0" to agn <arms.panda> }
    base frames: { "base_link" to agn <arms.panda> }
    world frame: "odom"
    joint topics: { "/arm/joint_states" to agn <arms.panda> }
    events: { <start> when "/task becomes 2" }
    grips: { <arms.panda> while "/vacuum" }
    annotations: "monday.csv"
    uncertainty: { 3 mm, 2 deg, 0.5 cm of obj <parts.bolt> }
}
Scenario Exec (ns=x) second {
    variant: <fetching.bench-to-tray>  scene inst: <bench_mjc>  bhv: <own>
    policies: { <told>, <near>, <coded> }  repeat: 3  seed: 42  timeout: 60 seconds
    log: <monday>
}
Scenario Exec (ns=x) first { variant: <fetching.bench-to-tray>  scene inst: <bench_mjc>  bhv: <own> }
"""
SCENEX = """import "lab.scene"
ns s = 'https://example.org/s/'
scene inst (ns=s) bench_mjc { scene: <bench_scene> }
"""
VIEW = View(T + "var-robot", 0.3, 1.5)
TRUTH = Provider(X + "truth", "ground-truth", 100.0, 0.002, 0.05, view=VIEW, misses=0.05)
PART = Observation(X + "part-pose", TRUTH, (T + "var-part", ENV + "tray"))
SEEN = Observation(
    X + "seen-pose",
    Provider(X + "poses", "topic", noise=0.005, source="/poses", type="geometry_msgs/msg/PoseArray"),
    (ENV + "bolt",),
    time_extractor="my.ros:stamp",
    mapped=(("b", ENV + "bolt"),),
)
CLAUSE = T + "on-bench"
POLICIES = (
    Policy(X + "told", CLAUSE, Rule("topic", "/seen")),
    Policy(X + "near", CLAUSE, Rule("distance", "", "between", (0.01, 0.05), 0.1), 2.0, (PART, SEEN), sigma=3.0),
    Policy(X + "coded", CLAUSE, Rule("python", "my.rules:near"), None, (PART,)),
)

PANDA, BOLT = ENV + "panda", ENV + "bolt"
MONDAY = RecordedLog(
    X + "monday",
    "bags/monday",
    ((T + "var-part", BOLT), (T + "var-robot", PANDA)),
    (("camera/object_7", BOLT), ("tool0", PANDA)),
    (("base_link", PANDA),),
    "odom",
    (("/arm/joint_states", PANDA),),
    ((T + "start", "/task becomes 2"),),
    ((PANDA, "/vacuum"),),
    "monday.csv",
    (("others", 0.003), ("angle", math.radians(2)), (BOLT, 0.005)),
)


def executions(text: str = BDDX, form: str = "ttl") -> tuple[Execution, ...]:
    case = fixture(f"//- run.bddx\n{text}\n//- main.bdd\n{MODEL}\n//- lab.scene\n{SCENE}\n//- bench.scenex\n{SCENEX}")
    graph = build_graph(case.snapshot, case.uri).graph
    return read_model(parse(serialize(graph, form), form)).executions


@pytest.mark.parametrize("form", FORMATS)
def test_executions_come_back_in_written_order(form: str) -> None:
    own = Implementation(X + "own", "python", "my.arm:Pick")
    second, first = executions(form=form)
    variant = second.variant
    assert variant == T + "bench-to-tray"
    scene = SceneInstance("https://example.org/s/bench_mjc", scene="https://example.org/env/bench_scene")
    assert second == Execution(second.iri, variant, own, scene, POLICIES, 3, 42, 60.0, MONDAY)
    assert first == Execution(first.iri, variant, own, scene)
    assert (second.iri, first.iri) == (X + "second", X + "first")


@pytest.mark.parametrize(
    ("source", "kind", "name"),
    [
        ('bhv action: "/bdd/pickplace"', "ros-action", "/bdd/pickplace"),
        ('catalog "pick-place"', "catalog", "pick-place"),
        ('process "./policy --fast"', "process", "./policy --fast"),
        ('endpoint "ws://lab:9000/arm"', "endpoint", "ws://lab:9000/arm"),
    ],
)
def test_an_implementation_says_what_it_is(source: str, kind: str, name: str) -> None:
    text = BDDX.replace("py { module: my.arm, attr: Pick }", source)
    assert executions(text)[0].implementation == Implementation(X + "own", kind, name)


def test_an_external_system_has_a_time_for_its_answers() -> None:
    text = BDDX.replace("py { module: my.arm, attr: Pick }", 'process "./policy" answer within: 0.25 s')
    assert executions(text)[0].implementation == Implementation(X + "own", "process", "./policy", limit=0.25)


@pytest.mark.parametrize(
    ("condition", "form", "bounds"),
    [
        ("less-than: 5 cm", "less-than", (0.05,)),
        ("greater-than: 0.5 m", "greater-than", (0.5,)),
        ("equals: 10 cm tolerance: 5 mm", "equals", (0.1, 0.005)),
    ],
)
def test_distances_are_in_metres(condition: str, form: str, bounds: tuple[float, ...]) -> None:
    text = BDDX.replace("between: 10 mm and 0.05 m", condition)
    rule = executions(text)[0].policies[1].rule
    assert (rule.form, rule.bounds) == (form, pytest.approx(bounds))


@pytest.mark.parametrize("form", FORMATS)
def test_a_field_of_view_is_an_angle_in_radians(form: str) -> None:
    execution, _ = executions(BDDX.replace("> misses", "> field of view: 60 deg misses"), form)
    (observation, _) = execution.policies[1].observations
    assert observation.provider.view is not None
    assert observation.provider.view.angle == pytest.approx(math.pi / 3)
