"""A ``.scenex`` is read back from the graph as plain data, in whatever form it was written."""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

import pytest

from graph.test_executions import BDDX
from kit import MODEL, SCENE, fixture
from robbdd_tools.base.plain import from_plain
from robbdd_tools.catalog.executable import ArmModel, Law, MountedGripper, OpeningModel, SceneInstance
from robbdd_tools.graph.places import placed_model
from robbdd_tools.graph.rdf.serialize import FORMATS, parse, serialize
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.write.build import build_graph

S, ENV = "https://example.org/s/", "https://example.org/env/"
SCENEX = """import "lab.scene"
ns s = 'https://example.org/s/'
distrib (ns=s) spread { uniform { dimension: 3  lower: (25, -40, 2)  upper: (60, 40, 2) } }
distrib (ns=s) tumble { uniform-rotation }
distrib (ns=s) jitter { normal { dimension: 2  mean: (0, 1)  std-dev: 0.5 } }
ktree arm_t { body base { frame origin { } frame mount { pose up {
    wrt: <origin> xyz: (0, 0, 50) cm orientation: quat { xyzw: (0, 0, 0, 2) } } } } }
ktree inst (ns=s) left of <arm_t>
ktree inst (ns=s) right of <arm_t>
ktree (ns=s) cell {
    tree <left>
    tree <right>
    body room { frame root { } }
    joints { fixed stand { parent: <room.root> child: <left.base.origin> }
             revolute hinge { parent: <left.base.mount>.z child: <right.base.origin>.x offset: OFFSET } }
}
scene inst (ns=s) bench_mjc {
    scene: <bench_scene>
    kgraph (ns=s) g {
        tree <cell>
        body nut { frame origin { pose there {
            wrt: <cell.room.root> xyz: sample <spread> cm orientation: ORIENTATION } } }
    }
    model world as mjcf { sys path = 'world.xml' }
    obj set <washers> { model washer_m as urdf { ros pkg = 'parts', path = 'washer.urdf' } }
    obj <washers.washer1> { model special as mjcf { sys path = 'special.xml' } }
    obj <parts.nut> { model nut_m as mjcf { sys path = 'nut.xml'  map body <g.nut> to "nut"
        opening { joint: "lid" closed: 2 mm open: 0.5 deg } } }
    agn <arms.panda> {
        model panda_m as mjcf {
            sys path = 'arm.xml'
            map tree <left> to "arm"
            tool: "tcp"
            gripper { actuator: "grip" open: 0.04 close: 0 pads: "a", "b" stroke: 80 mm }
            home: (0, 1.5) rad
            velocity: (1, 2) rad/s
        }
    }
    friction of obj set <washers> on agn <arms.panda>: 0.1
    friction of obj <parts.nut> on obj <washers.washer0>: 0.25
}
""".replace("offset: OFFSET", "offset { xyz: (0, 0, 100) mm }")
TURN = "euler { angles: (0, 0, 90) unit: deg }"


def instance(orientation: str = TURN, form: str = "ttl") -> SceneInstance:
    return instance_of(SCENEX.replace("ORIENTATION", orientation), form)


def instance_of(text: str, form: str = "ttl") -> SceneInstance:
    case = fixture(f"//- run.bddx\n{BDDX}\n//- main.bdd\n{MODEL}\n//- lab.scene\n{SCENE}\n//- bench.scenex\n{text}")
    graph = build_graph(case.snapshot, case.uri).graph
    scene = read_model(parse(serialize(graph, form), form)).executions[0].scene
    assert scene is not None
    return scene


@pytest.mark.parametrize("form", FORMATS)
def test_the_instance_is_the_same_after_every_format(form: str) -> None:
    assert instance(form=form) == instance()


def test_models_belong_to_the_elements_and_to_each_of_a_set() -> None:
    scene = instance()
    named = {one.element: [(m.format, m.kind, m.name, m.package) for m in one.models] for one in scene.elements}
    assert named[ENV + "washer0"] == named[ENV + "washer2"] == [("urdf", "ros", "washer.urdf", "parts")]
    assert named[ENV + "washer1"] == [("mjcf", "file", "special.xml", "")]
    assert [model.name for model in scene.models] == ["world.xml"]


def test_an_arm_has_its_tool_gripper_and_limits_in_si_units() -> None:
    arms = [model.arm for one in instance().elements for model in one.models if model.arm is not None]
    assert arms == [ArmModel("tcp", "grip", 0.04, 0.0, ("a", "b"), 0.08, (0.0, 1.5), (1.0, 2.0))]


@pytest.mark.parametrize(
    ("written", "mounted"),
    [
        ("sys path = 'hand.xml' on: 'flange'", MountedGripper("file", "hand.xml", "flange")),
        (
            "ros pkg = 'hands', path = 'hand.urdf' on: 'tool0' offset: (0, 1, 2) cm "
            "orientation: euler { angles: (0, 0, 180) unit: deg }",
            MountedGripper("ros", "hand.urdf", "tool0", "hands", (0.0, 0.01, 0.02), (0.0, 0.0, 0.0, 1.0)),
        ),
    ],
)
def test_a_gripper_from_a_file_of_its_own_is_fixed_to_the_arm(written: str, mounted: MountedGripper) -> None:
    text = SCENEX.replace("ORIENTATION", TURN).replace('{ actuator: "grip"', f'{{ {written} actuator: "grip"')
    scene = instance_of(text)
    (arm,) = [model.arm for one in scene.elements for model in one.models if model.arm is not None]
    found = arm.mounted
    assert found is not None
    assert (arm.actuator, found.position) == ("grip", pytest.approx(mounted.position))
    assert found.rotation == pytest.approx(mounted.rotation)
    assert replace(found, position=mounted.position, rotation=mounted.rotation) == mounted
    assert [(one.kind, one.name) for one in scene.sources][-1] == (mounted.kind, mounted.name)


@pytest.mark.parametrize("written", ["euler { angles: (0, 30) unit: deg }", "quat { sample <tumble> }"])
def test_an_orientation_that_is_no_rotation_is_kept_to_be_refused(written: str) -> None:
    hand = f"{{ sys path = 'hand.xml' on: 'flange' orientation: {written} actuator: \"grip\""
    text = SCENEX.replace("ORIENTATION", TURN).replace('{ actuator: "grip"', hand)
    (mounted,) = [m.arm.mounted for one in instance_of(text).elements for m in one.models if m.arm is not None]
    assert mounted is not None
    assert mounted.rotation == (0.0, 0.0, 0.0, 0.0)


def test_a_thing_that_opens_has_its_joint_and_positions_with_units() -> None:
    found = [model.opening for one in instance().elements for model in one.models if model.opening is not None]
    assert found == [OpeningModel("lid", "2 mm", "0.5 deg")]


def test_an_arm_may_leave_its_data_to_its_file() -> None:
    whole = SCENEX[SCENEX.index("            tool:") : SCENEX.index("        }\n    }\n    friction")]
    gripper = instance_of(SCENEX.replace("ORIENTATION", TURN).replace(whole, "gripper { close: 255 }\n"))
    assert [m.arm for one in gripper.elements for m in one.models if m.arm] == [ArmModel(closed=255.0)]
    nothing = instance_of(SCENEX.replace("ORIENTATION", TURN).replace(whole, ""))
    assert {model.arm for one in nothing.elements for model in one.models} == {None}
    assert [one.is_agent for one in nothing.elements if one.element.endswith("panda")] == [True]


def test_the_friction_of_a_set_is_that_of_each_pair() -> None:
    found = [(one.first, one.second, one.coefficient) for one in instance().frictions]
    washers = [(f"{ENV}washer{number}", f"{ENV}panda", 0.1) for number in range(3)]
    assert found == [*washers, (f"{ENV}nut", f"{ENV}washer0", 0.25)]


def test_mappings_lead_to_bodies_and_trees_of_the_graph() -> None:
    models = {model.name: model for one in instance().elements for model in one.models}
    assert models["nut.xml"].bodies == ((S + "g.nut", "nut"),)
    assert models["arm.xml"].trees == ((S + "left", "arm"),)


def test_instances_of_a_tree_have_frames_of_their_own() -> None:
    links = {(link.frame.removeprefix(S), link.base.removeprefix(S)): link for link in instance().links}
    assert links["left.base.mount", "left.base.origin"].position == (0.0, 0.0, 0.5)
    assert links["left.base.mount", "left.base.origin"].rotation == (1.0, 0.0, 0.0, 0.0)
    assert links["right.base.mount", "right.base.origin"].kind == "pose"
    assert links["left.base.origin", "cell.room.root"].kind == "fixed"
    hinge = links["right.base.origin", "left.base.mount"]
    assert (hinge.kind, hinge.axes, hinge.position) == ("revolute", ("z", "x"), (0.0, 0.0, 0.1))
    assert instance().anchor == S + "cell.room.root"


def test_a_sampled_position_keeps_its_distribution_and_unit() -> None:
    (link,) = [link for link in instance().links if link.position_law]
    assert (link.position_law, link.scale) == (S + "spread", 0.01)
    assert instance().laws == (Law(S + "spread", "uniform", (25.0, -40.0, 2.0), (60.0, 40.0, 2.0)),)


@pytest.mark.parametrize(
    ("orientation", "expected"),
    [
        (TURN, (sqrt(0.5), 0, 0, sqrt(0.5))),
        ("quat { xyzw: (0, 0, 1, 1) }", (sqrt(0.5), 0, 0, sqrt(0.5))),
        ("direction-cosine { x: (0, 1, 0) y: (-1, 0, 0) z: (0, 0, 1) }", (sqrt(0.5), 0, 0, sqrt(0.5))),
        ("direction-cosine { x: (-1, 0, 0) y: (0, 1, 0) z: (0, 0, -1) }", (0, 0, 1, 0)),
        ("euler { axes: zxy angles: (90, 0, 90) unit: deg }", (0.5, -0.5, 0.5, 0.5)),
        ("euler { axes: zxy extrinsic angles: (90, 0, 90) unit: deg }", (0.5, 0.5, 0.5, 0.5)),
        ("euler { axes: xyz extrinsic angles: (3.141592653589793, 0, 0) }", (0, 1, 0, 0)),
    ],
)
def test_orientations_of_all_forms_are_quaternions(orientation: str, expected: tuple[float, ...]) -> None:
    link = next(link for link in instance(orientation).links if link.frame == S + "g.nut.origin")
    assert link.rotation == pytest.approx(expected, abs=1e-9)


def test_numbers_that_are_no_rotation_state_none() -> None:
    for text in ("quat { xyzw: (0, 0, 0, 0) }", "direction-cosine { x: (1, 0, 0) y: (1, 0, 0) z: (0, 0, 1) }"):
        assert next(link for link in instance(text).links if link.frame == S + "g.nut.origin").rotation == ()


def test_what_is_read_can_be_written_as_json_and_tells_where_it_stands() -> None:
    import json
    from dataclasses import asdict

    text = SCENEX.replace("ORIENTATION", TURN)
    case = fixture(f"//- run.bddx\n{BDDX}\n//- main.bdd\n{MODEL}\n//- lab.scene\n{SCENE}\n//- bench.scenex\n{text}")
    scene = placed_model(build_graph(case.snapshot, case.uri), case.snapshot).executions[0].scene
    assert scene is not None
    assert from_plain(SceneInstance, json.loads(json.dumps(asdict(scene)))) == scene
    origin = scene.elements[-1].models[0].origin
    assert origin is not None
    assert str(origin) == f"/fixture/bench.scenex:{text[: text.index('panda_m')].count(chr(10)) + 1}:15"


def test_as_and_to_may_be_left_out() -> None:
    short = SCENEX.replace("nut_m as mjcf", "nut_m mjcf").replace('map body <g.nut> to "nut"', "map body <g.nut>")
    assert 'to "nut"' not in short
    assert _named(short) == _named(SCENEX)


def _named(text: str) -> list[tuple[tuple[str, str], ...]]:
    scene = instance_of(text.replace("ORIENTATION", TURN))
    return [model.bodies for one in scene.elements for model in one.models]
