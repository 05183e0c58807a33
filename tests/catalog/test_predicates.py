"""Evaluators on worlds made by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from monitor.traces import heights, still, trace_of
from robbdd_tools.base.quantity_units import QuantityError
from robbdd_tools.catalog.api import Arguments, Region
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.judge import judge
from robbdd_tools.monitor.time import Before, During
from robbdd_tools.monitor.trace import EventStamp, Trace
from robbdd_tools.monitor.verdict import Outcome, Verdict
from robbdd_tools.protocol.specs import SceneSpec
from robbdd_tools.world.scene import contents_of

REGIONS = {
    "tray_ws": (("tray", Region((0.0, 0.0, 0.1), (0.2, 0.1, 0.1))),),
    "far_ws": (("far", Region((0.0, 0.0, 0.1), (0.2, 0.1, 0.1))),),
    "both_ws": (
        ("tray", Region((0.0, 0.0, 0.1), (0.2, 0.1, 0.1))),
        ("far", Region((0.0, 0.0, 0.1), (0.2, 0.1, 0.1))),
    ),
}


def judged(predicate: str, trace: Trace, **arguments: str | tuple[str, ...]) -> Verdict:
    whole = During("start", "end")
    words: Arguments = arguments
    return judge(load_catalog().predicates[predicate], words, whole, trace, REGIONS)


def world(count: int = 2, **paths: list[list[float]]) -> Trace:
    bodies = {"tray": still(count), "far": still(count, (1.0, 0.0, 0.0)), **paths}
    return trace_of(bodies, {"start": 0.0, "end": (count - 1) * 0.1}, {"arm": {"ball": [1.0] * count}})


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


def test_does_not_collide_adds_up_the_way_that_the_target_moves() -> None:
    shaken = world(3, tray=[[0.0, 0.0, 0.0], [0.02, 0.0, 0.0], [0.0, 0.0, 0.0]])
    assert judged("does-not-collide", shaken, agent="arm", target="tray").robustness == pytest.approx(0.01)
    assert judged("does-not-collide", shaken, agent="arm", target="tray_ws").robustness == pytest.approx(0.01)
    assert judged("does-not-collide", shaken, agent="arm", target="far_ws").robustness == pytest.approx(0.05)


def test_does_not_collide_is_violated_when_the_way_is_too_long() -> None:
    pushed = world(3, tray=[[0.0, 0.0, 0.0], [0.04, 0.0, 0.0], [0.08, 0.0, 0.0]])
    found = judged("does-not-collide", pushed, agent="arm", target="both_ws")
    assert found.outcome is Outcome.VIOLATED
    assert found.at == pytest.approx(0.2)


def test_sorted_into_asks_every_object_for_some_workspace() -> None:
    trace = world(ball=still(2, (0.0, 0.0, 0.1)), cube=still(2, (1.0, 0.0, 0.1)), nut=heights([0.1, 0.3]))
    both = ("tray_ws", "far_ws")
    assert judged("sorted-into", trace, objects=("ball", "cube"), workspaces=both).outcome is Outcome.HOLDS
    assert judged("sorted-into", trace, objects=("ball", "cube"), workspaces=("tray_ws",)).outcome is Outcome.VIOLATED
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


def limited(trace: Trace, target: str, name: str, value: str) -> Trace:
    """A trace in which an element has a configuration of how to judge it."""
    return replace(trace, settings={(target, name): value})


BALL_OUTLINE = {"ball": (((0.0, 0.0, 0.0), 0.03),)}


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


def test_does_not_collide_up_to_the_way_that_is_configured() -> None:
    pushed = world(3, tray=[[0.0, 0.0, 0.0], [0.04, 0.0, 0.0], [0.08, 0.0, 0.0]])
    for limit, outcome in (("0.09", Outcome.HOLDS), ("0.07", Outcome.VIOLATED)):
        trace = limited(pushed, "tray", "displacement_limit", limit)
        assert judged("does-not-collide", trace, agent="arm", target="tray_ws").outcome is outcome


def test_does_not_collide_by_force_is_in_newtons() -> None:
    pressed = replace(world(3), forces={("arm", "tray"): np.array([0.0, 12.0, 3.0])})
    for limit, robustness in (("20", 8.0), ("10", -2.0)):
        found = judged(
            "does-not-collide", limited(pressed, "tray", "force_limit", limit), agent="arm", target="tray_ws"
        )
        assert (found.robustness, found.unit) == (pytest.approx(robustness), "N")
    unwatched = limited(world(3), "tray", "force_limit", "10")
    found = judged("does-not-collide", unwatched, agent="arm", target="tray")
    assert found.reason == "the trace has no record of 'contact forces of arm on tray'"


@pytest.mark.parametrize(("peak", "outcome"), [(139.0, Outcome.HOLDS), (742.0, Outcome.VIOLATED)])
def test_what_cannot_be_pushed_is_judged_by_contact_force(peak: float, outcome: Outcome) -> None:
    pressed = replace(world(3), forces={("arm", "tray"): np.array([0.0, peak, 3.0])}, immovable=("tray",))
    found = judged("does-not-collide", pressed, agent="arm", target="tray_ws")
    assert (found.outcome, found.robustness, found.unit) == (outcome, pytest.approx(140.0 - peak), "N")


def test_what_cannot_be_pushed_and_is_never_touched_holds_by_the_whole_limit() -> None:
    watched = replace(world(3), watched=("arm",), immovable=("tray",))
    assert judged("does-not-collide", watched, agent="arm", target="tray").robustness == 140.0


def test_a_fixed_target_without_a_record_of_forces_is_unknown() -> None:
    found = judged("does-not-collide", replace(world(3), immovable=("tray",)), agent="arm", target="tray")
    assert found.outcome is Outcome.UNKNOWN
    assert found.reason == "the trace has no record of 'contact forces of arm on tray'"


def test_a_target_of_which_a_part_can_be_pushed_has_the_smaller_share_as_its_margin() -> None:
    far = [[1.0, 0.0, 0.0], [1.04, 0.0, 0.0], [1.04, 0.0, 0.0]]
    forces = {("arm", "tray"): np.array([0.0, 14.0, 0.0])}
    pushed = replace(world(3, far=far), forces=forces, immovable=("tray",))
    found = judged("does-not-collide", pushed, agent="arm", target="both_ws")
    assert (found.robustness, found.unit) == (pytest.approx(0.2), "")
    hit = replace(pushed, forces={("arm", "tray"): np.array([0.0, 126.0, 0.0])})
    assert judged("does-not-collide", hit, agent="arm", target="both_ws").robustness == pytest.approx(0.1)


def test_an_agent_moves_safely_as_long_as_its_tool_is_slow() -> None:
    slow = world(3, arm=[[0.0, 0.0, 0.0], [0.02, 0.0, 0.0], [0.03, 0.0, 0.0]])
    assert judged("moves-safely", slow, agent="arm").robustness == pytest.approx(0.25 - 0.2)
    fast = world(4, arm=heights([0.0, 0.0, 0.03, 0.03]))
    found = judged("moves-safely", fast, agent="arm")
    assert (found.robustness, found.unit) == (pytest.approx(0.25 - 0.3), "m/s")
    assert found.at == pytest.approx(0.2)
    assert judged("moves-safely", limited(fast, "arm", "max_speed", "0.5"), agent="arm").outcome is Outcome.HOLDS


def test_speed_at_the_beginning_of_a_window_is_that_since_the_sample_before_it() -> None:
    trace = world(4, arm=heights([0.0, 0.0, 0.03, 0.03]))
    predicate = load_catalog().predicates["moves-safely"]
    for time, robustness in ((0.1, 0.25), (0.2, -0.05)):
        events = (EventStamp("e", time),)
        found = judge(predicate, {"agent": "arm"}, Before("e"), replace(trace, events=events), REGIONS)
        assert found.robustness == pytest.approx(robustness)
    assert judged("moves-safely", world(1, arm=still(1)), agent="arm").outcome is Outcome.UNKNOWN


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


@pytest.mark.parametrize(("limit", "robustness", "unit"), [("0.5 m/s", 0.3, "m/s"), ("0.1 m/s", -0.1, "m/s")])
def test_moves_slower_than_a_limit(limit: str, robustness: float, unit: str) -> None:
    found = judged("moves-slower-than", world(arm=[[0.0, 0.0, 0.0], [0.02, 0.0, 0.0]]), agent="arm", limit=limit)
    assert found.robustness == pytest.approx(robustness)
    assert found.unit == unit


@pytest.mark.parametrize(
    ("distance", "nearer", "unit"), [("50 cm", 20.0, "cm"), ("0.2 m", -0.1, "m"), ("310 mm", 10.0, "mm")]
)
def test_distances_are_compared_in_the_unit_of_the_clause(distance: str, nearer: float, unit: str) -> None:
    trace = world(ball=still(2, (0.0, 0.3, 0.0)))
    for other in ("tray", "tray_ws"):
        one = judged("is-nearer-than", trace, one="ball", distance=distance, other=other)
        assert (one.robustness, one.unit) == (pytest.approx(nearer), unit)
        far = judged("is-farther-than", trace, one="ball", distance=distance, other=other)
        assert (far.robustness, far.unit) == (pytest.approx(-nearer), unit)


def test_of_a_workspace_the_nearest_carrier_counts() -> None:
    trace = world(ball=still(2, (0.9, 0.0, 0.0)))
    found = judged("is-nearer-than", trace, one="ball", distance="0.3 m", other="both_ws")
    assert found.robustness == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("limit", "robustness", "unit"), [("45 deg", 15.0, "deg"), ("0.5 rad", 0.5 - np.pi / 6, "rad")]
)
def test_tilt_is_the_angle_of_the_upward_axis(limit: str, robustness: float, unit: str) -> None:
    upright = world(ball=still(2, (0.0, 0.0, 0.1)))
    orientations = upright.orientations.copy()
    # 30° about x, after a turn about z, which does not tilt.
    about_x, about_z = (np.cos(np.pi / 12), np.sin(np.pi / 12)), (np.cos(0.4), np.sin(0.4))
    tilted = (about_x[0] * about_z[0], about_x[1] * about_z[0], -about_x[1] * about_z[1], about_x[0] * about_z[1])
    orientations[:, upright.column("ball")] = tilted
    found = judged("is-tilted-less-than", replace(upright, orientations=orientations), object="ball", limit=limit)
    assert (found.robustness, found.unit) == (pytest.approx(robustness), unit)
    untilted = judged("is-tilted-less-than", upright, object="ball", limit="10 deg")
    assert untilted.robustness == pytest.approx(10.0)


@pytest.mark.parametrize("limit", ["0.25", "0.25 m", "fast", "0.25 mph"])
def test_a_quantity_that_does_not_fit_is_no_evidence(limit: str) -> None:
    with pytest.raises(QuantityError):
        judged("moves-slower-than", world(arm=still(2)), agent="arm", limit=limit)


SMALL_BALL = {"ball": (((0.0, 0.0, 0.0), 0.05),)}
CORNERS = {"ball": tuple(((x, y, z), 0.0) for x in (-0.05, 0.05) for y in (-0.05, 0.05) for z in (-0.05, 0.05))}


@pytest.mark.parametrize(
    ("place", "margin"),
    [
        ((0.0, 0.0, 0.05), 0.05),
        ((0.0, 0.05, 0.05), 0.0),
        ((0.0, 0.06, 0.05), -0.01),  # located at the tray, but it sticks out
        ((0.0, 0.0, 0.16), -0.01),  # higher than the rim
        ((0.5, 0.0, 0.05), -0.35),
    ],
)
def test_entirely_inside_is_the_distance_of_the_farthest_point(
    place: tuple[float, float, float], margin: float
) -> None:
    trace = replace(world(ball=still(2, place)), outlines=SMALL_BALL)
    found = judged("is-entirely-inside", trace, object="ball", workspace="tray_ws")
    assert found.robustness == pytest.approx(margin, abs=1e-9)


def test_a_turned_box_sticks_out_with_its_corner() -> None:
    trace = replace(world(ball=still(2, (0.0, 0.045, 0.05))), outlines=CORNERS)
    assert judged("is-entirely-inside", trace, object="ball", workspace="tray_ws").outcome is Outcome.HOLDS
    orientations = trace.orientations.copy()
    orientations[:, trace.column("ball")] = (np.cos(np.pi / 8), 0.0, 0.0, np.sin(np.pi / 8))
    turned = judged("is-entirely-inside", replace(trace, orientations=orientations), object="ball", workspace="tray_ws")
    assert turned.robustness == pytest.approx(0.1 - 0.045 - 0.05 * np.sqrt(2))


def test_an_object_without_an_outline_is_unknown_where_all_of_it_counts() -> None:
    trace = world(ball=still(2, (0.0, 0.0, 0.05)))
    for outlines in ({}, {"ball": ()}):
        bare = replace(trace, outlines=outlines)
        assert judged("is-entirely-inside", bare, object="ball", workspace="tray_ws").outcome is Outcome.UNKNOWN
        assert judged("is-at-rest", bare, object="ball").outcome is Outcome.UNKNOWN


@pytest.mark.parametrize(("way", "margin"), [(0.0, 0.01), (0.001, 0.0), (0.0015, -0.005)])
def test_what_shifts_is_not_at_rest(way: float, margin: float) -> None:
    trace = replace(world(ball=[[0.0, 0.0, 0.1], [way, 0.0, 0.1]]), outlines=SMALL_BALL)
    assert judged("is-at-rest", trace, object="ball").robustness == pytest.approx(margin, abs=1e-9)


def test_what_turns_on_the_spot_is_not_at_rest() -> None:
    trace = replace(world(ball=still(2, (0.0, 0.0, 0.1))), outlines=CORNERS)
    orientations = trace.orientations.copy()
    orientations[1, trace.column("ball")] = (-np.cos(0.01), 0.0, 0.0, -np.sin(0.01))  # 0.02 rad in 0.1 s, as -q
    found = judged("is-at-rest", replace(trace, orientations=orientations), object="ball")
    assert found.robustness == pytest.approx(0.01 - 0.2 * 0.05 * np.sqrt(3))


def test_one_sample_does_not_show_rest() -> None:
    trace = replace(world(1, ball=still(1)), outlines=SMALL_BALL)
    assert judged("is-at-rest", trace, object="ball").outcome is Outcome.UNKNOWN


def touching(force: float, watched: tuple[str, ...] = ("ball",)) -> Trace:
    pressed = {("ball", "tray"): np.array([0.0, force])} if force else {}
    return replace(world(ball=still(2)), touches=pressed, touch_watched=watched)


@pytest.mark.parametrize(
    ("force", "touches", "apart"), [(0.0, -0.01, 0.0), (0.009, -0.01, 0.0), (0.01, -0.01, -0.01), (3.0, -0.01, -3.0)]
)
def test_touching_is_a_contact_force_at_each_sample(force: float, touches: float, apart: float) -> None:
    for one, other in (("ball", "tray"), ("tray", "ball"), ("ball", "tray_ws")):
        found = judged("touches", touching(force), one=one, other=other)
        assert found.robustness == pytest.approx(touches)  # the first sample has no contact
        assert judged("does-not-touch", touching(force), one=one, other=other).robustness == pytest.approx(apart)


def test_a_force_is_compared_with_the_limit() -> None:
    found = judged("presses-with-less-than", touching(3.0), one="ball", other="tray_ws", limit="2 N")
    assert (found.outcome, found.robustness, found.unit) == (Outcome.VIOLATED, pytest.approx(-1.0), "N")
    assert judged("presses-with-less-than", touching(3.0), one="ball", other="tray", limit="3 N").robustness == 0.0


@pytest.mark.parametrize("predicate", ["touches", "does-not-touch"])
def test_forces_that_were_not_recorded_are_unknown(predicate: str) -> None:
    assert judged(predicate, touching(0.0, ()), one="ball", other="tray").outcome is Outcome.UNKNOWN
    assert judged(predicate, touching(0.0), one="far", other="tray").outcome is Outcome.UNKNOWN
    assert judged(predicate, touching(0.0), one="tray_ws", other="tray").outcome is Outcome.UNKNOWN
    # One of the two trays was watched by nobody.
    assert judged(predicate, touching(0.0, ("tray",)), one="both_ws", other="ball").outcome is Outcome.UNKNOWN


@pytest.mark.parametrize(
    ("place", "force", "margin"),
    [
        ((0.0, 0.0, 0.15), 1.0, 0.1),
        ((0.0, 0.06, 0.15), 1.0, 0.04),
        ((0.0, 0.1, 0.15), 1.0, 0.0),
        ((0.0, 0.11, 0.15), 1.0, -0.01),  # it leans over the edge
        ((0.18, 0.0, 0.15), 1.0, 0.02),
        ((0.0, 0.0, 0.0), 1.0, -0.05),  # it is inside, or hangs through
        ((0.0, 0.11, 0.0), 1.0, -0.05),  # it touches the side
        ((0.0, 0.0, 0.15), 0.0, -0.05),  # it hovers
        ((0.0, 0.0, 0.1), 0.0, -0.0001),  # it is let go of without contact
    ],
)
def test_on_top_needs_contact_and_the_centre_above(
    place: tuple[float, float, float], force: float, margin: float
) -> None:
    slab = tuple(((x, y, z), 0.0) for x in (-0.2, 0.2) for y in (-0.1, 0.1) for z in (0.0, 0.05))
    trace = replace(
        world(ball=still(2, place)),
        outlines={**SMALL_BALL, "tray": slab},
        touches={("ball", "tray"): np.full(2, force)},
        touch_watched=("ball", "tray"),
    )
    found = judged("is-on-top-of", trace, one="ball", other="tray")
    assert found.robustness == pytest.approx(margin, abs=1e-9)


def test_on_top_is_unknown_without_forces_or_outlines() -> None:
    trace = replace(world(ball=still(2, (0.0, 0.0, 0.15))), outlines={**SMALL_BALL, "tray": SMALL_BALL["ball"]})
    assert judged("is-on-top-of", trace, one="ball", other="tray").outcome is Outcome.UNKNOWN
    felt = replace(trace, touch_watched=("ball",), outlines=SMALL_BALL)
    assert judged("is-on-top-of", felt, one="ball", other="tray").outcome is Outcome.UNKNOWN


def test_the_footprint_turns_with_the_object() -> None:
    bar = tuple(((x, y, z), 0.0) for x in (-0.2, 0.2) for y in (-0.02, 0.02) for z in (-0.05, 0.05))
    trace = replace(
        world(ball=still(2, (0.0, 0.1, 0.1))),
        outlines={**SMALL_BALL, "tray": bar},
        touches={("ball", "tray"): np.ones(2)},
    )
    assert judged("is-on-top-of", trace, one="ball", other="tray").robustness == pytest.approx(-0.08)
    orientations = trace.orientations.copy()
    orientations[:, trace.column("tray")] = (np.cos(np.pi / 4), 0.0, 0.0, np.sin(np.pi / 4))
    turned = replace(trace, orientations=orientations)
    assert judged("is-on-top-of", turned, one="ball", other="tray").robustness == pytest.approx(0.02)
