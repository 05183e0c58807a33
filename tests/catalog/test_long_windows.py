"""Windows with many samples are evaluated in parts where a predicate allows it, with the margins of the whole."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from catalog.judged_predicates import BALL_OUTLINE, REGIONS, world
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor import judge
from robbdd_tools.monitor.judge import WindowEvidence, margins_of
from robbdd_tools.monitor.time import Window
from robbdd_tools.monitor.trace import Trace

ARGUMENTS = {
    "located-at": {"object": "ball", "workspace": "tray_ws"},
    "held-by": {"object": "ball", "agent": "arm"},
    "is-nearer-than": {"one": "ball", "distance": "0.3 m", "other": "tray"},
    "is-farther-than": {"one": "ball", "distance": "0.3 m", "other": "tray"},
    "is-tilted-less-than": {"object": "ball", "limit": "20 deg"},
    "moves-slower-than": {"agent": "arm", "limit": "0.2 m/s"},
    "sorted-into": {"objects": ("ball", "arm"), "workspaces": ("tray_ws", "both_ws")},
    "is-entirely-inside": {"object": "ball", "workspace": "tray_ws"},
    "is-correct-for": {"workspace": "tray_ws", "object": "ball"},
    "are-sorted-correctly": {"objects": ("ball",), "workspaces": ("tray_ws", "far_ws")},
}


def moving(random: np.random.Generator, count: int) -> Trace:
    paths = {name: np.cumsum(random.normal(0, 0.01, (count, 3)), axis=0).tolist() for name in ("ball", "tray", "arm")}
    trace = world(count, **paths)
    turns = random.normal(0, 1, trace.orientations.shape)
    return replace(
        trace,
        times=np.cumsum(random.uniform(0.001, 0.1, count)),
        orientations=turns / np.linalg.norm(turns, axis=2)[:, :, None],
        outlines=BALL_OUTLINE,
        grips={"arm": random.integers(0, 2, (count, len(trace.names))).astype(float)},
        correct_places={"ball": ("tray_ws",)},
    )


def test_the_list_has_every_predicate_that_is_evaluated_in_parts() -> None:
    assert {one.name for one in load_catalog().predicates.values() if one.pointwise} == set(ARGUMENTS)


@pytest.mark.parametrize("name", ARGUMENTS)
def test_parts_have_the_margins_of_the_whole(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    random = np.random.default_rng(1)
    for count in (1, 2, 3, 50, 200):
        trace = moving(random, count)
        first = int(random.integers(0, count))
        evidence = WindowEvidence(trace, Window(first, int(random.integers(first, count))), REGIONS)
        predicate = load_catalog().predicates[name]
        expected = margins_of(predicate, evidence, ARGUMENTS[name])
        monkeypatch.setattr(judge, "PART", int(random.integers(1, 30)))
        found = margins_of(predicate, evidence, ARGUMENTS[name])
        monkeypatch.undo()
        assert np.array_equal(found, expected, equal_nan=True)
