"""The example with two loops: each is executed and judged by its own events, in physics and on stored traces."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from kit import EXAMPLES
from robbdd_tools.cli import main

pytestmark = pytest.mark.physics
BETWEEN = """    When:
        Behaviour (ns=turn) carry-one {
            duration: from <evt-one-start> until <evt-one-end>
            <arms.panda> picks <balls.ball1> and places at <places.balls_ws>
        }
    Then:
        one-ball: holds(<balls.ball1> is located at <places.balls_ws>, after <evt-one-end>)
        one-of-two: holds(<balls> is located at <places.balls_ws>, after <evt-one-end>)
    Given:
        loose-balls"""
"""A behaviour between the loops, with clauses after it."""


def scenarios(path: str) -> list[list[dict[str, Any]]]:
    document: Any = json.loads(Path(path).read_text(encoding="utf-8"))
    return [scenario["clauses"] for scenario in document["scenarios"]]


def named(clauses: list[dict[str, Any]], name: str) -> list[dict[str, Any]]:
    return [clause for clause in clauses if clause["name"] == name]


def not_held(clauses: list[dict[str, Any]]) -> list[tuple[str, str]]:
    return [(clause["name"], clause["verdict"]) for clause in clauses if clause["verdict"] != "holds"]


@pytest.fixture
def model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(shutil.copytree(EXAMPLES / "inturn", tmp_path / "inturn"))
    return Path("inturn.bdd")


def test_the_loops_follow_each_other_and_each_has_its_own_events(model: Path) -> None:
    assert main(["run", "inturn.bdd", "--json", "run.json"]) == 1
    fast, slow = scenarios("run.json")
    assert not_held(fast) == []
    assert not_held(slow) == [("in-time", "violated")]
    (cubes,), (wait,) = named(fast, "cubes-sorted"), named(fast, "balls-wait")
    first_ball, second_ball = named(fast, "ball-in-its-bin")
    (loose,), (last,) = named(fast, "loose-balls"), named(fast, "balls-sorted")
    assert wait["at"] <= cubes["at"] < loose["at"] + 0.1 < first_ball["at"] < second_ball["at"] <= last["at"]
    # The clauses between the loops are edited, and judged on the stored traces.
    text = model.read_text(encoding="utf-8")
    moved = "balls-wait: holds(<balls> is located at <places.table_ws>, from <evt-pick-start> until <evt-place-end>)"
    first, _, rest = text.partition(moved)
    assert rest
    later = rest.replace("cubes-stay:", f"{moved}\n            and\n            cubes-stay:")
    model.write_text(first.rstrip().removesuffix("// No ball is moved while the cubes are sorted.").rstrip()
                     .removesuffix("and") + later, encoding="utf-8")  # fmt: skip
    assert main(["judge", "latest", "inturn.bdd", "--json", "judge.json"]) == 1
    # Until the end of the last loop, balls are moved.
    assert not_held(scenarios("judge.json")[0]) == [("balls-wait", "violated")]


def test_a_behaviour_between_the_loops_is_executed_between_them(model: Path) -> None:
    text = model.read_text(encoding="utf-8").replace("    Given:\n        loose-balls", BETWEEN)
    text = text.replace("evt-end\n", "evt-end\nEvent (ns=turn) evt-one-start\nEvent (ns=turn) evt-one-end\n", 1)
    text = text.replace("{ 0.5, 0.3 }", "{ 0.5 }").replace("in <balls> )", "in <rest> )")
    text = text.replace("set var balls", "set var balls\n    set var rest")
    values = "set var <kind-after-kind.rest>: { { <balls.ball0> } }"
    model.write_text(text.replace("var <kind-after-kind.speed>", f"{values}\nvar <kind-after-kind.speed>"))
    assert main(["run", "inturn.bdd", "--json", "run.json"]) == 1
    (clauses,) = scenarios("run.json")
    (cubes,), (one,), (both,) = (named(clauses, name) for name in ("cubes-sorted", "one-ball", "balls-sorted"))
    (ball,) = named(clauses, "ball-in-its-bin")
    assert cubes["at"] < one["at"] < ball["at"] <= both["at"]
    # The ball of the last loop is not in its bin yet when the behaviour between the loops has ended.
    assert not_held(clauses) == [("one-of-two", "violated")]
