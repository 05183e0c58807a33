"""A ``.scenex`` states the boxes of workspaces: they decide in logs and in simulation alike."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from kit import fixture
from logs.drives import clauses, robbdd
from logs.named_drive import HEAD, cell, named
from robbdd_tools.features.diagnostics import fast_diagnostics

pytestmark = pytest.mark.physics


def turned(degrees: int) -> str:
    return f"orientation: euler {{ angles: (0, 0, {degrees}) unit: deg }}"


SIMULATED = """bhv impl (ns=exec) built-in { catalog "pick-place" }
Scenario Exec (ns=exec) sim { variant: <tidy-bench.part-to-bin> scene inst: <bench_sim> bhv: <built-in> }
"""


def with_boxes(folder: Path, boxes: str, text: str) -> Path:
    path = cell(folder, text)
    scenex = path.with_name("bench.scenex")
    stated = scenex.read_text(encoding="utf-8").replace(
        "    agn <arms", f"    ws <places.left_ws> {{ {boxes} }}\n    agn <arms"
    )
    scenex.write_text(stated, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("boxes", "verdict", "margin"),
    [
        # The cube ends 60 mm above the frame of the bin.
        ("box { offset: (0, 0, 5) cm size: (100, 100, 60) mm }", "holds", 0.02),
        ("box { offset: (0, 30, 50) mm size: (100, 100, 100) mm }", "holds", 0.02),
        ("box { offset: (0, 0, 25) mm size: (100, 100, 30) mm }", "violated", -0.02),
        ("box { offset: (0, 0, 1) m size: (1, 1, 1) m }", "violated", -0.44),
        (f"box {{ offset: (60, 0, 50) mm size: (100, 20, 60) mm {turned(180)} }}", "violated", -0.01),
        (f"box {{ offset: (60, 0, 50) mm size: (100, 20, 60) mm {turned(90)} }}", "violated", -0.05),
        (f"box {{ offset: (40, 40, 60) mm size: (200, 40, 60) mm {turned(45)} }}", "holds", 0.02),
        (f"box {{ offset: (40, 40, 60) mm size: (200, 40, 60) mm {turned(-45)} }}", "violated", 0.02 - 0.04 * 2**0.5),
        ("box { size: (1, 1, 1) mm } box { offset: (0, 0, 60) mm size: (20, 20, 20) mm }", "holds", 0.01),
    ],
)
def test_the_box_decides_in_a_log(boxes: str, verdict: str, margin: float, tmp_path: Path) -> None:
    path, out = with_boxes(tmp_path, boxes, named()), tmp_path / "out.json"
    robbdd(path.parent, "judge", "real.bddx", "--no-store", "--json", str(out))
    (goal,) = (one for one in clauses(out) if one["name"].endswith("at-goal"))
    assert (goal["verdict"], goal["robustness"]) == (verdict, pytest.approx(margin, abs=1e-6))


def test_the_same_box_decides_in_simulation(tmp_path: Path) -> None:
    boxes = "box { offset: (40, 0, 50) mm size: (70, 70, 80) mm }"
    path, out = with_boxes(tmp_path, boxes, HEAD + SIMULATED), tmp_path / "out.json"
    chosen = ("--where", "thing=cube0 and goal=left_ws", "--no-store", "--json", str(out))
    robbdd(path.parent, "run", "real.bddx", *chosen)
    (scenario,) = json.loads(out.read_text(encoding="utf-8"))["scenarios"]
    (goal,) = (one for one in scenario["clauses"] if one["name"].endswith("at-goal"))
    assert goal["verdict"] == "holds"
    # The centre of the cube is 21 mm above the frame of the bin, and the box begins at 10 mm. The catalog's region
    # begins at 5 mm, and its margin is 16 mm.
    assert 0 < goal["robustness"] < 0.012


@pytest.mark.parametrize("command", ["judge", "run"])
def test_no_other_space_counts_in_place_of_an_impossible_box(command: str, tmp_path: Path) -> None:
    box = "box { size: (1, 1, 1) m orientation: euler { angles: (0, 30) unit: deg } }"
    path, out = with_boxes(tmp_path, box, named() if command == "judge" else HEAD + SIMULATED), tmp_path / "out.json"
    chosen = () if command == "judge" else ("--where", "thing=cube0 and goal=left_ws")
    robbdd(path.parent, command, "real.bddx", *chosen, "--no-store", "--json", str(out))
    (goal,) = (one for one in clauses(out) if one["name"].endswith("at-goal"))
    assert (goal["verdict"], goal["robustness"]) == ("unknown", None)
    assert "a box of the workspace 'left_ws' needs an orientation that is a rotation" in json.dumps(goal)


@pytest.mark.parametrize(
    ("box", "code", "message"),
    [
        ("size: (1, 1) m", "pose", "a size needs 3 numbers, not 2"),
        ("offset: (1, 1, 1, 1) m size: (1, 1, 1) m", "pose", "an offset needs 3 numbers, not 4"),
        (
            "size: (1, 1, 1) m orientation: euler { angles: (0, 30) unit: deg }",
            "pose",
            "this is not a rotation: it has 3 angles",
        ),
        (
            "size: (1, 1, 1) m orientation: euler { sample <spin> }",
            "pose",
            "the orientation of a box cannot be drawn at random: write a rotation",
        ),
        (
            "size: (1, 0, 1) m",
            "number-range",
            "an edge of a box cannot be 0: write a number greater than 0 and up",
        ),
    ],
)
def test_an_impossible_box_is_reported(box: str, code: str, message: str) -> None:
    case = fixture(
        "//- a.scenex\nimport \"a.scene\"\nns s = 'https://example.org/s/'\n"
        f"scene inst (ns=s) one {{ scene: <lab> ws <places.bench> {{ box {{ {box} }} }} }}\n"
        "//- a.scene\nns e = 'https://example.org/e/'\nws set (ns=e) places { workspace bench }\n"
        "scene (ns=e) lab { ws set <places> }\n"
    )
    (found,) = (one for one in fast_diagnostics(case.snapshot, case.uri) if one.code == code)
    assert found.message.startswith(message.partition(" and up")[0])
