"""Predicates of place, grip, reach and configuration, on traces made by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from catalog.judged_predicates import BALL_OUTLINE, REGIONS, judged, limited, world
from monitor.traces import heights, still, trace_of
from robbdd_tools.catalog.api import Arguments, Region
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.judge import judge
from robbdd_tools.monitor.time import Before, During
from robbdd_tools.monitor.trace import EventStamp
from robbdd_tools.monitor.verdict import Outcome, Verdict
from robbdd_tools.protocol.specs import SceneSpec
from robbdd_tools.world.scene import contents_of


@pytest.mark.parametrize(
    ("place", "margin"),
    [
        ((0.0, 0.0, 0.05), 0.05),
        ((0.19, 0.0, 0.1), 0.01),
        ((0.0, 0.13, 0.1), -0.03),
        ((0.23, 0.14, 0.1), -0.05),
        ((0.0, 0.0, -0.02), -0.02),
        # A contact gives way a little.
        ((0.0, 0.0, -0.0009), 0.0),
        ((0.0, 0.0, -0.0011), -0.0011),
    ],
)
def test_located_at_is_the_distance_to_the_nearest_face(place: tuple[float, float, float], margin: float) -> None:
    found = judged("located-at", world(ball=still(2, place)), object="ball", workspace="tray_ws")
    assert found.robustness == pytest.approx(margin)


def test_located_at_follows_the_object_that_carries_the_workspace() -> None:
    moved = world(tray=[[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]], ball=still(2, (0.0, 0.0, 0.1)))
    assert judged("located-at", moved, object="ball", workspace="tray_ws").robustness == pytest.approx(-0.3)


def test_located_at_a_workspace_of_two_regions_is_in_either() -> None:
    found = judged("located-at", world(ball=still(2, (1.0, 0.0, 0.1))), object="ball", workspace="both_ws")
    assert found.outcome is Outcome.HOLDS


def test_located_at_an_unknown_workspace_is_unknown() -> None:
    found = judged("located-at", world(ball=still(2)), object="ball", workspace="nowhere_ws")
    assert found.outcome is Outcome.UNKNOWN


def test_held_by_needs_the_grip_throughout() -> None:
    assert judged("held-by", world(ball=still(2)), object="ball", agent="arm").robustness == 1.0
    assert judged("held-by", world(ball=still(2)), object="tray", agent="arm").robustness == -1.0


def test_sorted_into_asks_every_object_for_some_workspace() -> None:
    trace = world(ball=still(2, (0.0, 0.0, 0.1)), cube=still(2, (1.0, 0.0, 0.1)), nut=heights([0.1, 0.3]))
    both = ("tray_ws", "far_ws")
    assert judged("sorted-into", trace, objects=("ball", "cube"), workspaces=both).outcome is Outcome.HOLDS
    assert judged("sorted-into", trace, objects=("ball", "cube"), workspaces=("tray_ws",)).outcome is Outcome.VIOLATED
    for words in ("sorted-into", "are-sorted-correctly"):
        for objects, workspaces, slot in (((), both, "objects"), (("ball",), (), "workspaces")):
            nothing = judged(words, trace, objects=objects, workspaces=workspaces)
            assert (nothing.outcome, nothing.reason) == (Outcome.UNKNOWN, f"the set of {slot} is empty")
    assert judged("sorted-into", trace, objects=("ball", "nut"), workspaces=both).robustness == pytest.approx(-0.1)


def dropped(held: list[float], path: list[list[float]]) -> Verdict:
    count = len(path)
    bodies = {"tray": still(count), "far": still(count, (1.0, 0.0, 0.0)), "ball": path}
    trace = trace_of(bodies, {"start": 0.0, "end": (count - 1) * 0.1}, {"arm": {"ball": held}})
    return judged("does-not-drop", trace, agent="arm", object="ball")


def test_what_is_held_or_at_rest_on_a_workspace_is_not_dropped() -> None:
    assert dropped([1.0] * 3, heights([0.5, 0.3, 0.7])).robustness == pytest.approx(0.05)
    assert dropped([0.0] * 3, still(3, (0.0, 0.0, 0.02))).robustness == pytest.approx(0.02)
    assert dropped([0.0, 1.0, 1.0], heights([0.02, 0.02, 0.5])).outcome is Outcome.HOLDS


def test_what_is_let_go_of_close_to_a_workspace_is_not_dropped() -> None:
    released = heights([0.05, 0.05, 0.03, 0.02, 0.02, 0.02, 0.02])
    found = dropped([1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0], released)
    assert found.robustness == pytest.approx(0.02)


def test_what_falls_is_dropped_from_the_sample_on_at_which_it_has_fallen_too_far() -> None:
    found = dropped([1.0, 1.0, 0.0, 0.0, 0.0], heights([0.3, 0.3, 0.27, 0.2, 0.02]))
    assert found.outcome is Outcome.VIOLATED
    assert found.robustness == pytest.approx(0.05 - 0.28)
    assert found.at == pytest.approx(0.3)


def test_what_rests_beside_every_workspace_is_dropped() -> None:
    found = dropped([0.0] * 3, still(3, (0.5, 0.0, 0.02)))
    assert (found.outcome, found.robustness) == (Outcome.VIOLATED, pytest.approx(-0.3))


def test_a_moment_without_contact_is_no_drop() -> None:
    assert dropped([1.0, 0.0, 1.0, 1.0], still(4, (0.5, 0.5, 0.3))).outcome is Outcome.HOLDS


@pytest.mark.parametrize(
    ("giver", "receiver", "is_dropped"),
    [
        # Handed over, and lowered by the receiver.
        ([1, 1, 0, 0, 0], [0, 1, 1, 1, 1], False),
        # Handed over, and dropped by the receiver.
        ([1, 1, 0, 0, 0], [0, 1, 1, 0, 0], False),
        # Dropped before the receiver has it.
        ([1, 1, 0, 0, 0], [0, 0, 0, 0, 1], True),
        # Handed back, and dropped by the giver.
        ([1, 0, 1, 1, 0], [0, 1, 1, 0, 0], True),
        ([1, 1, 0, 0, 0], None, True),
        # Held by neither.
        ([0, 0, 0, 0, 0], [0, 0, 0, 0, 0], True),
    ],
)
def test_what_another_agent_has_taken_over_is_dropped_by_neither_or_by_it(
    giver: list[float], receiver: list[float] | None, is_dropped: bool
) -> None:
    bodies = {"tray": still(5), "far": still(5, (1.0, 0.0, 0.0)), "ball": heights([0.5, 0.5, 0.5, 0.44, 0.3])}
    grips = {"arm": {"ball": giver}} | ({} if receiver is None else {"other": {"ball": receiver}})
    trace = trace_of(bodies, {"start": 0.0, "end": 0.4}, grips)
    found = judged("does-not-drop", trace, agent="arm", object="ball")
    assert found.outcome is (Outcome.VIOLATED if is_dropped else Outcome.HOLDS)


def test_can_reach_is_the_margin_that_was_measured() -> None:
    margins = np.array([0.4, 0.2, np.nan])
    trace = replace(world(3), reaches={("arm", "tray"): margins}, events=(EventStamp("e", 0.1),))
    predicate = load_catalog().predicates["can-reach"]
    words = {"agent": "arm", "object": "tray"}
    assert judge(predicate, words, Before("e"), trace, REGIONS).robustness == pytest.approx(0.2)
    beyond = replace(trace, reaches={("arm", "tray"): np.array([0.4, -3.14, np.nan])})
    assert judge(predicate, words, Before("e"), beyond, REGIONS).outcome is Outcome.VIOLATED
    late = replace(trace, events=(EventStamp("e", 0.2),))
    assert judge(predicate, words, Before("e"), late, REGIONS).outcome is Outcome.UNKNOWN


@pytest.mark.parametrize(
    ("settings", "robustness"),
    [
        ({("ball", "mass"): "0.25"}, 1.0),
        ({("ball", "mass"): "0.250000001"}, 1.0),
        ({("ball", "mass"): "0.26"}, -1.0),
    ],
)
def test_has_config_compares_the_numbers(settings: dict[tuple[str, str], str], robustness: float) -> None:
    trace = replace(world(ball=still(2)), settings=settings)
    assert judged("has-config", trace, target="ball", name="mass", value="0.25").robustness == robustness


def test_has_config_of_a_workspace_is_that_of_all_its_carriers() -> None:
    trace = replace(world(), settings={("tray", "height_scale"): "2", ("far", "height_scale"): "1"})
    words = {"name": "height_scale", "value": "2"}
    assert judged("has-config", trace, target="tray_ws", **words).outcome is Outcome.HOLDS
    assert judged("has-config", trace, target="both_ws", **words).outcome is Outcome.VIOLATED


@pytest.mark.parametrize(
    ("place", "margin"),
    [
        ((0.0, 0.0, 0.05), 0.05),
        ((0.0, 0.06, 0.1), 0.01),
        ((0.0, 0.08, 0.1), -0.01),
        ((0.0, 0.0, 0.18), -0.01),
        ((0.0, 0.0, 0.01), 0.01),
    ],
)
def test_the_whole_object_is_inside_but_at_the_face_that_carries_it(
    place: tuple[float, float, float], margin: float
) -> None:
    trace = replace(world(ball=still(2, place)), outlines=BALL_OUTLINE)
    words = {"object": "ball", "workspace": "tray_ws"}
    assert judged("located-at", limited(trace, "ball", "whole_object", "yes"), **words).robustness == pytest.approx(
        margin
    )
    assert judged("located-at", trace, **words).outcome is Outcome.HOLDS


def test_the_whole_object_turns_with_it() -> None:
    upright = replace(world(ball=still(2, (0.0, 0.05, 0.1))), outlines={"ball": (((0.06, 0.0, 0.0), 0.0),)})
    quarter = np.tile([2**-0.5, 0.0, 0.0, 2**-0.5], (2, 1))
    orientations = upright.orientations.copy()
    orientations[:, upright.column("ball")] = quarter
    turned = replace(upright, orientations=orientations)
    words = {"object": "ball", "workspace": "tray_ws"}
    for trace, margin in ((upright, 0.05), (turned, -0.01)):
        found = judged("located-at", limited(trace, "ball", "whole_object", "yes"), **words)
        assert found.robustness == pytest.approx(margin)


def test_sorted_into_exactly_one_is_not_into_two() -> None:
    trace = world(ball=still(2, (0.0, 0.0, 0.1)))
    words = {"objects": ("ball",), "workspaces": ("tray_ws", "both_ws")}
    assert judged("sorted-into", trace, **words).outcome is Outcome.HOLDS
    for element in ("ball", "tray"):
        found = judged("sorted-into", limited(trace, element, "exactly_one", "yes"), **words)
        assert (found.outcome, found.robustness) == (Outcome.VIOLATED, pytest.approx(-0.1))
    apart = {"objects": ("ball",), "workspaces": ("tray_ws", "far_ws")}
    assert judged("sorted-into", limited(trace, "ball", "exactly_one", "yes"), **apart).outcome is Outcome.HOLDS


@pytest.mark.parametrize("name", ["has-config", "can-reach"])
def test_what_was_not_recorded_is_unknown(name: str) -> None:
    predicate = load_catalog().predicates[name]
    words = {slot.name: "tray" for slot in predicate.slots} | {"name": "mass", "value": "1"}
    assert judged(name, world(), **words).outcome is Outcome.UNKNOWN


TABLE = {
    "table_ws": (("table", Region((0.0, 0.0, 0.1), (0.5, 0.5, 0.1))),),
    "bin_ws": (("bin", Region((0.0, 0.0, 0.06), (0.1, 0.1, 0.05))),),
}
COMPOSED = {"table_ws": ("bin_ws",)}
IN_BIN, ON_FLOOR = (0.0, 0.0, 0.05), (2.0, 0.0, -0.70)


def located(
    place: str,
    ball: list[list[float]],
    bin_at: list[list[float]],
    contents: dict[str, tuple[str, ...]],
    name: str = "ball",
) -> Verdict:
    bodies = {"table": still(len(ball)), "bin": bin_at, "ball": ball}
    trace = trace_of(bodies, {"start": 0.0, "end": (len(ball) - 1) * 0.1})
    words: Arguments = {"object": name, "workspace": place}
    found = replace(trace, contents=contents)
    return judge(load_catalog().predicates["located-at"], words, During("start", "end"), found, TABLE)


def test_what_lies_in_a_bin_is_located_at_the_table_if_the_bin_is_composed_into_it() -> None:
    in_bin = still(2, IN_BIN), still(2)
    assert located("bin_ws", *in_bin, {}).robustness == pytest.approx(0.04)
    assert located("bin_ws", *in_bin, COMPOSED).robustness == pytest.approx(0.04)
    assert located("table_ws", *in_bin, {}).robustness == pytest.approx(-0.04)
    assert located("table_ws", *in_bin, COMPOSED).robustness == pytest.approx(0.05)
    beside = still(2, (0.2, 0.0, 0.05)), still(2)
    assert located("table_ws", *beside, {}).robustness == pytest.approx(0.05)
    assert located("table_ws", still(2, (0.11, 0.0, 0.05)), still(2), {}).robustness == pytest.approx(0.01)


def test_a_bin_is_not_located_at_what_it_carries() -> None:
    """Its centre is in its own workspace, which must neither contain it nor remove it from the table."""
    on_table, fallen = still(2, (0.0, 0.0, 0.06)), still(2, (2.0, 0.0, -0.64))
    for contents in ({}, COMPOSED):
        assert located("table_ws", on_table, on_table, contents, "bin").robustness == pytest.approx(0.06)
        assert located("table_ws", fallen, fallen, contents, "bin").outcome is Outcome.VIOLATED
    assert located("bin_ws", on_table, on_table, {}, "bin").outcome is Outcome.UNKNOWN


def test_a_bin_that_is_pushed_off_the_table_takes_its_part_of_the_workspace_along() -> None:
    ball = [list(IN_BIN), [2.0, 0.0, -0.65]]
    moved = [[0.0, 0.0, 0.0], list(ON_FLOOR)]
    assert located("table_ws", ball, moved, COMPOSED).robustness == pytest.approx(0.04)
    assert located("table_ws", ball, moved, {}).outcome is Outcome.VIOLATED
    # Where the bin stood, there is table again.
    assert located("table_ws", still(2, IN_BIN), [list(ON_FLOOR), list(ON_FLOOR)], {}).robustness == pytest.approx(0.05)


def test_composition_counts_at_any_depth() -> None:
    scene = SceneSpec(contains={"room": ("table", "shelf"), "table": ("bin",), "bin": ("room",)})
    assert contents_of(scene, "room") == ("table", "shelf", "bin")
    assert contents_of(scene, "shelf") == ()
