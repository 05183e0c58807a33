"""Reasons and clauses are worded for people: local names, the error first, the place last."""

from __future__ import annotations

from dataclasses import replace

import pytest

from robbdd_tools.monitor.fault import Fault, Frame
from robbdd_tools.protocol.messages import ClauseJudged
from robbdd_tools.protocol.specs import ClauseSpec, ScenarioSpec, SceneSpec
from robbdd_tools.run.readable import clause_title, readable

SCENE = SceneSpec(("env:cube0", "env:bin.left"), ("env:panda",), {"env:left_ws": ("env:bin.left",)})
SPEC = ScenarioSpec(
    "f.feature", 3, "t:v -- 1", "t:story", "t:v", 1, {}, 7, SCENE, {"t:evt-place-end": "place-end"}, ()
)  # fmt: skip
JUDGED = ClauseJudged(0, 5, "unknown", None, "", None, "", None)


@pytest.mark.parametrize(
    ("reason", "shown"),
    [
        ("env:panda cannot reach a free place at env:left_ws", "panda cannot reach a free place at left_ws"),
        ("env:panda cannot reach env:left_ws: 9 mm short", "panda cannot reach left_ws: 9 mm short"),
        ("event t:evt-place-end never occurred: lost env:cube0", "event evt-place-end never occurred: lost cube0"),
        ("no step definition for 'it is in \"env:bin.left\"'", "no step definition for 'it is in \"bin.left\"'"),
        ("bench.scenex:37:29: there is no model file m.xml", "there is no model file m.xml (bench.scenex, line 37)"),
        # Not names of the scenario: texts of users, times, addresses.
        ("gripper:left is open", "gripper:left is open"),
        ("stopped at 12:30: env:cube0x", "stopped at 12:30: env:cube0x"),
        ("KeyError: 'gaol' (C:/a/b.py:18)", "KeyError: 'gaol' (C:/a/b.py:18)"),
        ("", ""),
    ],
)
def test_reasons_have_local_names_of_the_scenario_and_their_place_at_the_end(reason: str, shown: str) -> None:
    judged = replace(JUDGED, reason=reason)
    assert readable(judged, SPEC) == replace(judged, reason=shown)


def test_the_error_of_users_code_takes_the_place_of_the_reason() -> None:
    fault = Fault("KeyError", "'gaol'", "acting:Raises", (Frame("/long/path/acting.py", 18, "step"),))
    judged = replace(JUDGED, reason="x.bddx:7:2: acting:Raises failed at env:cube0", fault=fault.id)
    assert readable(judged, SPEC, {fault.id: fault}).reason == "KeyError: 'gaol' (acting.py, line 18)"
    bare = replace(fault, frames=())
    assert readable(replace(judged, fault=bare.id), SPEC, {bare.id: bare}).reason == "KeyError: 'gaol'"
    # The error of another scenario is not this one's.
    assert readable(judged, SPEC).reason == "acting:Raises failed at cube0 (x.bddx, line 7)"


@pytest.mark.parametrize(
    ("name", "title"),
    [
        ("at-goal", "at-goal"),
        ("when-bhv-fetch.when", "the behaviour"),
        ("text-fetch.then.0", "'cube0 is green after evt-end'"),
    ],
)
def test_a_clause_is_named_as_in_the_model_or_by_its_kind_or_its_sentence(name: str, title: str) -> None:
    clause = ClauseSpec(5, f"https://x/{name}", name, "then", '"env:cube0" is green after event "t:evt-end"')
    assert clause_title(clause) == title
