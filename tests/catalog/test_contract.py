"""What every registered word of the language must satisfy, ours and those of other packages."""

from __future__ import annotations

import re
from itertools import combinations
from math import isclose
from pathlib import Path
from typing import Any

import pytest

from robbdd_tools.catalog.api import Behaviour, ObjectModel, Predicate, RobotModel
from robbdd_tools.catalog.registry import DuplicateWord, build_catalog, load_catalog
from robbdd_tools.judging.parsed_sentences import fluent_pattern, read_clause, read_step
from robbdd_tools.protocol.clauses import BehaviourCall, Fluent
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.robot_specs import mjcf_path

CATALOG = load_catalog()
every_predicate = pytest.mark.parametrize("predicate", CATALOG.predicates.values(), ids=lambda word: word.name)
every_behaviour = pytest.mark.parametrize("behaviour", CATALOG.behaviours.values(), ids=lambda word: word.name)
every_object = pytest.mark.parametrize("model", CATALOG.objects.values(), ids=lambda word: word.name)
every_robot = pytest.mark.parametrize("robot", CATALOG.robots.values(), ids=lambda word: word.name)
every_sentence = pytest.mark.parametrize(
    "word", [*CATALOG.predicates.values(), *CATALOG.behaviours.values()], ids=lambda word: word.name
)
NAME = re.compile(r"[a-z][a-z0-9]*(-[a-z0-9]+)*")
CURIE = re.compile(r"[a-z]+:[A-Za-z][\w-]*")


def test_the_catalog_has_words_of_every_kind() -> None:
    assert {"located-at", "held-by", "does-not-collide"} <= CATALOG.predicates.keys()
    assert {"pick-place", "pick", "place"} <= CATALOG.behaviours.keys()
    assert {"cube", "ball", "bin", "table", "box"} <= CATALOG.objects.keys()
    assert "franka-panda" in CATALOG.robots


def test_a_name_is_claimed_once() -> None:
    cube = CATALOG.objects["cube"]
    with pytest.raises(DuplicateWord, match="'cube' is defined twice: in here and in there"):
        build_catalog([("here", cube), ("there", cube)])


@every_sentence
def test_phrase_and_sentence_name_each_slot_once(word: Predicate | Behaviour) -> None:
    slots = sorted(slot.name for slot in word.slots)
    assert sorted(re.findall(r"<(\w+)>|[$#](\w+)", word.phrase)) == sorted(
        (name, "") if f"<{name}>" in word.phrase else ("", name) for name in slots
    )
    assert sorted(re.findall(r"\{(\w+)\}", word.sentence)) == slots
    assert all(f'"{{{name}}}"' in word.sentence for name in slots)
    assert len({slot.property for slot in word.slots}) == len(word.slots)
    assert all(CURIE.fullmatch(slot.property) for slot in word.slots)
    assert NAME.fullmatch(word.name)
    assert word.doc.endswith(".")


@every_predicate
@pytest.mark.parametrize("time", ['before event "t:e"', 'from "t:a" until "t:e"'])
def test_a_predicate_reads_back_from_its_own_sentence(predicate: Predicate, time: str) -> None:
    words = {slot.name: f"t:{slot.name}" for slot in predicate.slots}
    found = read_clause(f"{predicate.sentence.format(**words)} {time}")
    assert isinstance(found, Fluent)
    assert (found.predicate, found.arguments) == (predicate, words)


@every_behaviour
def test_a_behaviour_reads_back_from_its_own_sentence(behaviour: Behaviour) -> None:
    words = {slot.name: f"t:{slot.name}" for slot in behaviour.slots}
    found = read_step("when", behaviour.sentence.format(**words))
    assert isinstance(found, BehaviourCall)
    assert (found.behaviour, found.arguments) == (behaviour, words)


@every_behaviour
def test_a_behaviour_has_a_duration(behaviour: Behaviour) -> None:
    assert len(behaviour.events) >= 2
    assert len(set(behaviour.events)) == len(behaviour.events)
    assert all(NAME.fullmatch(event) for event in behaviour.events)
    assert behaviour.rdf_types


@every_predicate
def test_a_predicate_has_a_type_and_a_unit_of_its_margin(predicate: Predicate) -> None:
    assert CURIE.fullmatch(predicate.rdf_type)
    assert predicate.unit in ("", "m", "m/s", "s", "rad", "N", "%")
    re.compile(fluent_pattern(predicate))


def test_no_two_predicates_share_type_or_sentence() -> None:
    for one, other in combinations(CATALOG.predicates.values(), 2):
        assert one.rdf_type != other.rdf_type
        assert one.sentence != other.sentence
        assert one.phrase != other.phrase


def test_prefixes_are_claimed_once() -> None:
    for models in (CATALOG.objects.values(), CATALOG.robots.values()):
        prefixes = [prefix for model in models for prefix in model.prefixes]
        assert len(set(prefixes)) == len(prefixes)
        assert all(prefix == prefix.lower() for prefix in prefixes)


@pytest.mark.parametrize(
    ("name", "model"),
    [
        ("cube1", "cube"),
        ("ball_red", "ball"),
        ("bin_left", "bin"),
        ("container", "bin"),
        ("tray2", "tray"),
        ("shelf", "shelf"),
        ("bottle_1", "bottle"),
        ("cylinder3", "cylinder"),
        ("Table", "table"),
        ("bench", "table"),
        ("dining_table", "table"),
        ("box3", "box"),
        ("red-cube", "cube"),
        ("operator", "person"),
        ("operator_table", "table"),
        ("worker-bench", "table"),
        ("cereal-box", "box"),
        ("work_bench", "table"),
        ("workbench", "table"),
        ("RedCube", "cube"),
        ("bin_cubes", "bin"),
        ("big_shelf_box", "shelf"),
        ("bottle_crate", "bin"),
        ("ballBin", "bin"),
        ("bin_ball", "bin"),
        ("tray-table", "table"),
        ("cube_on_table", "cube"),
        ("bin_for_bolts", "bin"),
        ("bottle-box", "box"),
        ("hex-nut", "nut"),
        ("nuts", "nut"),
        ("M20_screw", "bolt"),
        ("part1", "part"),
        ("workpiece", "part"),
        ("part_bin", "bin"),
        ("red_cube_part", "cube"),
        ("worker_item", "part"),
    ],
)
def test_objects_are_chosen_by_the_words_of_their_name(name: str, model: str) -> None:
    chosen = CATALOG.object_for(name)
    assert chosen is not None
    assert chosen.name == model


def test_a_name_that_nothing_stands_for_has_no_model() -> None:
    assert CATALOG.object_for("gizmo") is None
    assert CATALOG.robot_for("gizmo") is None
    for name in ("first-aid-cabinet", "screwdriver", "doughnut", "partition"):
        assert CATALOG.object_for(name) is None


def test_the_name_of_a_set_selects_no_unspecific_model() -> None:
    assert CATALOG.object_for("gizmo", ["parts"]) is None
    assert CATALOG.object_for("part1", ["cubes"]) == CATALOG.objects["cube"]
    assert CATALOG.object_for("gizmo", ["nut_bins"]) == CATALOG.objects["bin"]


@pytest.mark.parametrize(
    ("name", "sets", "model"),
    [
        ("my-kinova-arm", [], "kinova-gen3"),
        ("robot1", ["panda_arms"], "franka-panda"),
        ("ur10", ["panda_arms"], "ur10"),
        ("left-UR-10", [], "ur10"),
        ("mobile_panda", [], "mobile-panda"),
        ("robot1", ["arms"], None),
    ],
)
def test_agents_are_chosen_by_name_and_else_by_that_of_their_set(name: str, sets: list[str], model: str | None) -> None:
    chosen = CATALOG.robot_for(name, sets)
    assert (None if chosen is None else chosen.name) == model


@every_object
def test_an_object_is_of_this_world(model: ObjectModel) -> None:
    assert 0.001 < model.mass < 100.0
    assert 0.05 < model.friction < 1.5
    assert all(size >= 0.0 for shape in model.shapes for size in shape.size)
    assert all(0.0 <= channel <= 1.0 for channel in model.color)
    assert model.shapes
    assert not model.graspable or model.free
    assert model.graspable or model.places


@every_object
def test_an_object_rests_on_its_lowest_point(model: ObjectModel) -> None:
    lowest = min(shape.position[2] - _half_height(shape.size, shape.kind) for shape in model.shapes)
    assert isclose(-lowest, model.rest_height, abs_tol=1e-9)


def _half_height(size: tuple[float, float, float], kind: str) -> float:
    return {"box": size[2], "sphere": size[0], "cylinder": size[1]}[kind]


@every_robot
def test_a_robot_model_loads_and_holds_what_the_catalog_names(robot: RobotModel) -> None:
    path = mjcf_path(robot)
    assert isinstance(path, Path)
    model: Any = mujoco.MjModel.from_xml_path(str(path))
    lower, upper = zip(*(model.joint(name).range for name in robot.joints), strict=True)
    assert all(low <= angle <= high for low, angle, high in zip(lower, robot.home, upper, strict=True))
    assert len(robot.velocity_limits) == len(robot.torque_limits) == len(robot.home) == len(robot.joints)
    limits = [float(model.jnt_actfrcrange[model.joint(name).id, 1]) for name in robot.joints]
    assert limits == list(robot.torque_limits)
    assert model.site(robot.tool_site).id >= 0
    assert model.actuator(robot.gripper_actuator).id >= 0
    assert all(model.geom(pad).id >= 0 for pad in robot.pads)
    assert robot.source
