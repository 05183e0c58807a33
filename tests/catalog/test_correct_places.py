"""Where objects belong: the predicates that use the relation which a scene states."""

from __future__ import annotations

from dataclasses import replace

import pytest

from catalog.judged_predicates import judged, world
from monitor.traces import still
from robbdd_tools.monitor.trace import Trace
from robbdd_tools.monitor.verdict import Outcome

BOTH = ("tray_ws", "far_ws")
INSIDE_TRAY = (0.05, 0.0, 0.1)
INSIDE_FAR = (1.0, 0.0, 0.1)


def placed(correct: dict[str, tuple[str, ...]], **places: tuple[float, float, float]) -> Trace:
    paths = {name: still(2, place) for name, place in places.items()}
    return replace(world(2, **paths), correct_places=correct)


@pytest.mark.parametrize(
    ("workspace", "correct", "outcome"),
    [
        ("tray_ws", ("tray_ws",), Outcome.HOLDS),
        ("tray_ws", ("far_ws", "tray_ws"), Outcome.HOLDS),
        ("tray_ws", ("far_ws",), Outcome.VIOLATED),
        ("tray_ws", (), Outcome.UNKNOWN),
    ],
)
def test_a_workspace_is_correct_if_the_scene_states_it(
    workspace: str, correct: tuple[str, ...], outcome: Outcome
) -> None:
    trace = placed({"ball": correct, "cube": ("tray_ws",)}, ball=INSIDE_FAR)
    found = judged("is-correct-for", trace, workspace=workspace, object="ball")
    assert found.outcome is outcome
    if outcome is Outcome.UNKNOWN:
        assert found.reason == "the scene states no workspace that is correct for ball"


@pytest.mark.parametrize(
    ("correct", "margin"),
    [
        ({"ball": ("tray_ws",), "cube": ("far_ws",)}, 0.1),
        ({"ball": BOTH, "cube": BOTH}, 0.1),
        ({"ball": ("far_ws",), "cube": ("far_ws",)}, -0.75),  # the ball is in the wrong one
        ({"ball": ("tray_ws",), "cube": ("tray_ws",)}, -0.8),
    ],
)
def test_every_object_must_be_in_a_correct_workspace(correct: dict[str, tuple[str, ...]], margin: float) -> None:
    trace = placed(correct, ball=INSIDE_TRAY, cube=INSIDE_FAR)
    found = judged("are-sorted-correctly", trace, objects=("ball", "cube"), workspaces=BOTH)
    assert found.robustness == pytest.approx(margin)


@pytest.mark.parametrize(("x", "margin"), [(0.05, -0.1), (0.2, -0.0001), (0.3, -0.1)])
def test_an_object_that_belongs_in_none_of_the_workspaces_is_never_sorted(x: float, margin: float) -> None:
    trace = placed({"ball": ("far_ws",)}, ball=(x, 0.0, 0.1))
    found = judged("are-sorted-correctly", trace, objects=("ball",), workspaces=("tray_ws",))
    assert (found.outcome, found.robustness) == (Outcome.VIOLATED, pytest.approx(margin))


def test_an_object_without_a_stated_place_makes_sorting_unknown() -> None:
    trace = placed({"ball": ("tray_ws",)}, ball=INSIDE_TRAY, cube=INSIDE_TRAY)
    found = judged("are-sorted-correctly", trace, objects=("ball", "cube"), workspaces=BOTH)
    assert found.outcome is Outcome.UNKNOWN
