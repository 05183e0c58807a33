"""The predicate *does not collide*: the way that a target is pushed, and contact forces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from catalog.judged_predicates import judged, limited, world
from robbdd_tools.monitor.verdict import Outcome


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


PUSHED = [[0.0, 0.0, 0.0], [0.02, 0.0, 0.0], [0.04, 0.0, 0.0], [0.06, 0.0, 0.0], [0.06, 0.0, 0.0]]


@pytest.mark.parametrize(
    ("force", "margin"),
    [
        ((0.0, 0.0, 0.0, 0.0, 0.0), 0.05),  # something else pushes it
        ((0.0, 0.0, 1.0, 0.0, 0.0), 0.01),  # hit before the third sample, it slides on
        ((0.0, 1.0, 1.0, 1.0, 1.0), -0.01),
        ((1.0, 0.0, 0.0, 0.0, 0.0), -0.01),
        ((0.0, 0.009, 0.0, 0.0, 0.0), 0.05),  # noise of the solver
        ((0.0, 0.0, 0.0, 0.0, 1.0), 0.05),
    ],
)
def test_an_object_collides_with_what_its_contact_moves(force: tuple[float, ...], margin: float) -> None:
    trace = world(5, tray=PUSHED, ball=[[0.0, 0.0, 0.2]] * 5)
    touched = replace(trace, touches={("ball", "tray"): np.array(force)}, touch_watched=("ball",))
    for target in ("tray", "tray_ws"):
        found = judged("object-does-not-collide", touched, one="ball", other=target)
        assert (found.robustness, found.unit) == (pytest.approx(margin), "m")
    limit = limited(touched, "tray", "displacement_limit", "0.08")
    assert judged("object-does-not-collide", limit, one="ball", other="tray").robustness == pytest.approx(margin + 0.03)


def test_what_was_hit_and_came_to_rest_is_moved_by_something_else() -> None:
    path = [[0.0, 0.0, 0.0], [0.03, 0.0, 0.0], [0.03, 0.0, 0.0], [0.06, 0.0, 0.0]]
    trace = world(4, tray=path, ball=[[0.0, 0.0, 0.2]] * 4)
    hit = replace(trace, touches={("ball", "tray"): np.array([0.0, 5.0, 0.0, 0.0])}, touch_watched=("ball",))
    assert judged("object-does-not-collide", hit, one="ball", other="tray").robustness == pytest.approx(0.02)


@pytest.mark.parametrize(("peak", "outcome"), [(139.0, Outcome.HOLDS), (142.0, Outcome.VIOLATED)])
def test_an_object_hits_what_cannot_move_by_force(peak: float, outcome: Outcome) -> None:
    trace = replace(world(3, ball=[[0.0, 0.0, 0.2]] * 3), immovable=("tray",), touch_watched=("ball",))
    pressed = replace(trace, touches={("ball", "tray"): np.array([0.0, peak, 3.0])})
    found = judged("object-does-not-collide", pressed, one="ball", other="tray_ws")
    assert (found.outcome, found.robustness, found.unit) == (outcome, pytest.approx(140.0 - peak), "N")
    far = [[1.0, 0.0, 0.0], [1.04, 0.0, 0.0], [1.04, 0.0, 0.0]]
    mixed = replace(
        world(3, ball=[[0.0, 0.0, 0.2]] * 3, far=far),
        immovable=("tray",),
        touch_watched=("ball",),
        touches={("ball", "tray"): np.array([0.0, 14.0, 0.0]), ("ball", "far"): np.array([0.0, 1.0, 0.0])},
    )
    found = judged("object-does-not-collide", mixed, one="ball", other="both_ws")
    assert (found.robustness, found.unit) == (pytest.approx(0.2), "")


def test_an_object_whose_contacts_were_not_recorded_is_unknown() -> None:
    trace = world(3, ball=[[0.0, 0.0, 0.2]] * 3)
    assert judged("object-does-not-collide", trace, one="ball", other="tray").outcome is Outcome.UNKNOWN
