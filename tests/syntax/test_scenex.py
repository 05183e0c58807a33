"""Executable scenes and executions are parsed to trees; on errors, the trees keep their names."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.parse import parse_declaration
from robbdd_tools.syntax.salvage import salvage
from robbdd_tools.syntax.split import split
from robbdd_tools.syntax.symbols import walk

TREE = """ktree (ns=x) arm {
    root: <base.origin>
    body base {
        frame origin { }
        frame mount {
            pose mount_in_base {
                wrt: <origin>
                xyz: (0, 0.5, -1e-3) m
                orientation: euler { axes: xyz extrinsic angles: (0, 0, 90) unit: deg }
            }
        }
        inertia {
            frame: <origin>
            mass: 1.5 kg
            inertia-matrix: ((1, 0, 0), (0, 1, 0), (0, 0, 1)) kg*m^2
        }
    }
    body link { frame origin { } }
    tree <gripper>
    joints {
        fixed bolted { parent: <base.mount> child: <gripper.palm.origin> }
        revolute turn {
            parent: <base.mount>.z
            child: <link.origin>.z
            actuation { gear ratio: 100 command-interface: position torque state-interface: position }
            offset { xyz: (0, 0, 333) mm }
            limits { position: (-1, 1) rad velocity: (0, 2) rad/s effort: (-5, 5) N*m }
            polarity: NegativePolarity
        }
        revolute follow {
            parent: <base.mount>.x
            child: <link.origin>.y
            mimic { joint: <turn> multiplier: 2 offset: 0.1 }
        }
        serial { root: <base.origin> tip: <link.origin> }
    }
}"""
INSTANCE = """scene inst (ns=x) bench_mjc {
    scene: <bench_scene>
    kgraph (ns=x) cell {
        anchor: <world.root>
        body world { frame root { } }
        joints { parallel { } }
    }
    model all as mjcf { sys path = 'bench.xml' }
    obj <parts.bolt> { model bolt_m as urdf { ros pkg = 'parts', path = 'bolt.urdf' map body <cell.world> to "w" } }
    obj set <washers> { model washer_m as usd { py { module: a.b, attr: washers } } }
    agn set <arms> {
        agn <arms.panda> {
            model panda_m as mjcf { catalog "franka-panda" map tree <arm> to "panda" }
            camera wrist { frame: <cell.world.root> type: rgbd resolution: (640, 480) fov: 1.2 rad update-rate: 30 Hz }
            force-torque ft { frame: <cell.world.root> observes: force torque update-rate: 100 Hz }
            imu inertial { frame: <cell.world.root> observes: orientation angular-velocity update-rate: 200 Hz }
        }
    }
}"""


def parse(text: str, language: str = "scenex") -> tree.ChunkTree:
    declaration = parse_declaration(language, text)
    assert declaration.faults == ()
    assert declaration.tree is not None
    return declaration.tree


def names(text: str, language: str = "scenex") -> dict[str, SymbolKind]:
    return {symbol.path: symbol.kind for symbol in parse_declaration(language, text).symbols}


@pytest.mark.parametrize(
    ("text", "law"),
    [
        ("uniform { dimension: 3 lower: (0, 0, 0) upper: (1, 1, 1) }", tree.Uniform),
        ("uniform-rotation", tree.UniformRotation),
        ("normal { dimension: 2 mean: (0, 0) covariance: ((1, 0), (0, 1)) }", tree.Normal),
        ("normal { dimension: 1 mean: 0.0 std-dev: 0.5 }", tree.Normal),
    ],
)
def test_distributions_have_their_laws(text: str, law: type[tree.Node]) -> None:
    root = parse(f"distrib (ns=x) spread {{ {text} }}")
    assert isinstance(root, tree.Distribution)
    assert isinstance(root.law, law)


def test_numbers_and_units_of_a_pose_are_kept_as_written() -> None:
    pose = next(node for node in walk(parse(TREE)) if isinstance(node, tree.Pose))
    assert isinstance(pose.position, tree.Vector)
    assert [getattr(number, "value", None) for number in pose.position.values] == [0, 0.5, -0.001]
    assert pose.unit == "m"
    assert isinstance(pose.orientation, tree.Euler)
    assert isinstance(pose.orientation.value, tree.EulerAngles)
    angles = pose.orientation.value
    assert (angles.axes, angles.extrinsic, angles.unit) == ("xyz", True, "deg")


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("quat { xyzw: (0, 0, 0, 1) }", tree.Vector),
        ("quat { sample <spread> }", tree.Sample),
        ("euler { angles: (0, 0, 0) }", tree.EulerAngles),
        ("direction-cosine { x: (1, 0, 0) y: (0, 1, 0) z: (0, 0, 1) }", tree.Axes),
        ("sample <spread>", tree.Sample),
    ],
)
def test_orientations_are_values_or_samples(text: str, kind: type[tree.Node]) -> None:
    text = f"ktree t {{ body b {{ frame f {{ pose p {{ xyz: sample <spread> m orientation: {text} }} }} }} }}"
    pose = next(node for node in walk(parse(text, "ktree")) if isinstance(node, tree.Pose))
    assert isinstance(pose.position, tree.Sample)
    assert isinstance(getattr(pose.orientation, "value", pose.orientation), kind)


def test_a_joint_has_its_ends_and_limits() -> None:
    joints = {node.name.text: node for node in walk(parse(TREE)) if isinstance(node, tree.RevoluteJoint)}
    assert joints["turn"].parent_frame.axis == "z"
    limits = [node for node in walk(joints["turn"]) if isinstance(node, tree.Limit)]
    assert [(limit.quantity, limit.unit) for limit in limits] == [
        ("position", "rad"),
        ("velocity", "rad/s"),
        ("effort", "N*m"),
    ]
    mimic = next(node for node in walk(joints["follow"]) if isinstance(node, tree.Mimic))
    assert (mimic.joint.role, mimic.joint.path) == ("Joint", "turn")


def test_a_tree_declares_its_bodies_frames_poses_and_joints() -> None:
    assert names(TREE) == {
        "arm": SymbolKind.TREE,
        "arm.base": SymbolKind.BODY,
        "arm.base.origin": SymbolKind.FRAME,
        "arm.base.mount": SymbolKind.FRAME,
        "arm.base.mount.mount_in_base": SymbolKind.POSE,
        "arm.link": SymbolKind.BODY,
        "arm.link.origin": SymbolKind.FRAME,
        "arm.bolted": SymbolKind.JOINT,
        "arm.turn": SymbolKind.JOINT,
        "arm.follow": SymbolKind.JOINT,
    }


def test_a_tree_without_a_namespace_is_a_template() -> None:
    assert names("ktree arm { }", "ktree") == {"arm": SymbolKind.TREE_TEMPLATE}
    assert names("ktree inst (ns=x) left of <arm>") == {"left": SymbolKind.TREE_INSTANCE}


def test_a_scene_instance_declares_its_graph_models_and_sensors() -> None:
    assert names(INSTANCE) == {
        "bench_mjc": SymbolKind.SCENE_INSTANCE,
        "bench_mjc.cell": SymbolKind.GRAPH,
        "bench_mjc.cell.world": SymbolKind.BODY,
        "bench_mjc.cell.world.root": SymbolKind.FRAME,
        "bench_mjc.all": SymbolKind.MODEL,
        "bench_mjc.bolt_m": SymbolKind.MODEL,
        "bench_mjc.washer_m": SymbolKind.MODEL,
        "bench_mjc.panda_m": SymbolKind.MODEL,
        "bench_mjc.wrist": SymbolKind.SENSOR,
        "bench_mjc.ft": SymbolKind.SENSOR,
        "bench_mjc.inertial": SymbolKind.SENSOR,
    }


def test_models_come_from_a_path_a_package_code_or_the_catalog() -> None:
    models = [node for node in walk(parse(INSTANCE)) if isinstance(node, tree.Model)]
    assert [(model.kind, type(model.source)) for model in models] == [
        ("mjcf", tree.SystemPath),
        ("urdf", tree.RosPath),
        ("usd", tree.PythonAttribute),
        ("mjcf", tree.CatalogEntry),
    ]


@pytest.mark.parametrize(
    ("text", "source"),
    [
        ('bhv impl (ns=x) i { bhv action: "/bdd/pickplace" }', tree.RosAction),
        ("bhv impl (ns=x) i { py { module: my_pkg.behaviours, attr: PickPlace } }", tree.PythonAttribute),
        ('bhv impl (ns=x) i { catalog "pick-place" }', tree.CatalogEntry),
        ('obs provider (ns=x) p { ros topic: "/poses" type: "geometry_msgs/msg/PoseArray" }', tree.RosTopic),
        ("obs provider (ns=x) p { ros simulation entity state update-rate: 10 Hz }", tree.SimulatedStates),
        (
            'obs provider (ns=x) p { ros transform listener reference-frame: "world" update-rate: 10 Hz }',
            tree.Transforms,
        ),
        ("obs provider (ns=x) p { simulation ground truth update-rate: 100 Hz }", tree.GroundTruth),
    ],
)
def test_implementations_and_providers_have_their_sources(text: str, source: type[tree.Node]) -> None:
    root = parse(text, "bddx")
    assert isinstance(root, tree.Implementation | tree.Provider)
    assert isinstance(root.source, source)


def test_ground_truth_may_be_noisy_and_late() -> None:
    text = "obs provider (ns=x) p { simulation ground truth update-rate: 100 Hz noise: 2 mm latency: 0.05 s }"
    truth = next(node for node in walk(parse(text, "bddx")) if isinstance(node, tree.GroundTruth))
    assert truth.noise is not None
    assert truth.latency is not None
    assert (truth.rate.value, truth.noise.value, truth.noise_unit, truth.latency.value) == (100, 2, "mm", 0.05)


def test_an_observation_names_what_it_observes() -> None:
    text = """observation (ns=x) part {
        provider: <truth>  observes var <fetch.part>
        time extractor: py { module: a.b, attr: stamp }
        entity mapper: string { "bolt_1" to obj <parts.bolt>, "tray" to ws <places.tray> }
    }"""
    root = parse(text, "bddx")
    assert isinstance(root, tree.Observation)
    assert [target.reference.role for target in root.targets] == ["Variable"]
    assert isinstance(root.entity_mapper, tree.StringMapper)
    assert [entry.target.reference.path for entry in root.entity_mapper.entries] == ["parts.bolt", "places.tray"]


@pytest.mark.parametrize(
    ("text", "condition"),
    [
        ("less-than: 0.05 m", tree.LessThan),
        ("greater-than: 5 cm", tree.GreaterThan),
        ("between: 1 mm and 2 mm", tree.Between),
        ("equals: 1 m tolerance: 1 cm", tree.Equals),
    ],
)
def test_a_policy_evaluates_distances(text: str, condition: type[tree.Node]) -> None:
    text = f"""obs policy (ns=x) near for <fetch.at-bench> horizon: 2.0 seconds {{
        observations: {{ <part>, <bench> }}
        evaluator: linear distance {{ {text} max time offset: 0.1 s }}
    }}"""
    root = parse(text, "bddx")
    assert isinstance(root, tree.Policy)
    assert isinstance(root.rule, tree.Evaluation)
    assert isinstance(root.rule.evaluator, tree.LinearDistance)
    assert isinstance(root.rule.evaluator.condition, condition)


def test_an_execution_may_say_how_often_with_which_seed_and_how_long() -> None:
    head = "Scenario Exec (ns=x) run { variant: <s.v> scene inst: <i> bhv: <b> policies: { <p>, <q> }"
    root = parse(head + " repeat: 10 seed: 42 timeout: 60 seconds }", "bddx")
    assert isinstance(root, tree.Execution)
    assert [policy.path for policy in root.policies] == ["p", "q"]
    assert [number and number.value for number in (root.repeat, root.seed, root.timeout)] == [10, 42, 60]
    plain = parse(head + " }", "bddx")
    assert isinstance(plain, tree.Execution)
    assert (plain.repeat, plain.seed, plain.timeout) == (None, None, None)


@pytest.mark.parametrize(
    ("language", "text", "heads"),
    [
        ("scenex", f"ns x = 'y'\n{TREE}\n{INSTANCE}\nktree inst (ns=x) a of <b>", 4),
        ("ktree", "ktree a {\n}\nktree b {\n}", 2),
        ("scenex", "scene inst (ns=x) i {\n scene: <s>\n\ndistrib (ns=x) d { uniform-rotation }", 2),
        ("bddx", "bhv impl (ns=x) i {\nobs provider (ns=x) p {\nobs policy (ns=x) q\nobservation (ns=x) o", 4),
        ("bddx", "Scenario Exec (ns=x) r {\n  variant: <s.v>\n  scene inst: <i>\n  bhv: <b>\n}", 1),
    ],
)
def test_files_split_into_their_declarations(language: str, text: str, heads: int) -> None:
    assert len(split(language, text)) == heads


@pytest.mark.parametrize(
    ("text", "place", "words"),
    [
        ("ktree inst (ns=x) a of <>", ">", "the name of a kinematic tree template"),
        ("distrib (ns=x) d { gauss }", "gauss", "'uniform'"),
        (TREE.replace("mass: 1.5 kg", "mass: 1.5 lb"), "lb", "expected 'g' or 'kg'"),
        (TREE.replace("rad/s", "rad"), "rad", "expected 'deg/s' or 'rad/s'"),
    ],
)
def test_a_fault_names_its_place_and_what_was_expected(text: str, place: str, words: str) -> None:
    fault = parse_declaration("scenex", text).faults[0]
    assert text[fault.span.start : fault.span.end] == place
    assert words in fault.message


@pytest.mark.parametrize("text", [TREE, INSTANCE])
def test_the_names_of_a_broken_declaration_are_those_of_a_whole_one(text: str) -> None:
    assert {symbol.path: symbol.kind for symbol in salvage(text)} == names(text)


def test_a_declaration_cut_short_keeps_the_names_before_the_cut() -> None:
    kept = names(TREE[: TREE.index("actuation")])
    assert kept.keys() >= {"arm", "arm.base.origin", "arm.base.mount", "arm.link.origin", "arm.bolted", "arm.turn"}
    assert "arm.follow" not in kept


@given(st.data())
def test_no_text_raises(data: st.DataObject) -> None:
    text = data.draw(st.sampled_from([TREE, INSTANCE]))
    start = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(start, min(len(text), start + 100)))
    inserted = data.draw(st.text(alphabet="<>(){}\"'|:,.- \nabody\u20ac\U0001f916", max_size=12))
    edited = text[:start] + inserted + text[end:]
    declaration = parse_declaration("scenex", edited)
    assert all(0 <= fault.span.start <= fault.span.end <= len(edited) for fault in declaration.faults)
