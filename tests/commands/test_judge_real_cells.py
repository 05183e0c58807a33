"""What the logs of real cells are like: noise, carts that drive, drivers in millimetres, things without a model."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from kit import EXAMPLES
from logs.bags import ROS2, Message, text, transform, write
from logs.drives import clauses, drive, judged, robbdd, verdicts

pytestmark = pytest.mark.physics
UNTOUCHED = "goal-untouched"


@pytest.fixture(scope="module")
def models(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return shutil.copytree(EXAMPLES / "pickplace", tmp_path_factory.mktemp("cell") / "models")


def seen_with_noise(error: float) -> list[Message]:
    """A drive in which a camera sees the bin with errors of up to ``error`` (m)."""
    random = np.random.default_rng(1)
    noise = random.uniform(-error / 2, error / 2, size=(501, 3))
    bins = [
        transform("bin_left", (np.array([0.55, 0.3, 0.8]) + one).tolist(), stamp=tick / 50)
        for tick, one in enumerate(noise)
    ]
    return [one for one in drive() if frame_of(one) != "bin_left"] + bins


def frame_of(message: Message) -> str:
    return message.make(ROS2).transforms[0].child_frame_id if message.topic == "/tf" else ""


def on(clause: str, found: list[dict[str, Any]]) -> dict[str, Any]:
    return next(one for one in found if one["name"].endswith(clause))


def test_the_noise_of_a_camera_pushes_no_bin(models: Path, tmp_path: Path) -> None:
    messages = seen_with_noise(0.004)
    unstated = on(UNTOUCHED, judged(models, tmp_path, messages)[0])
    assert unstated["verdict"] == "unknown"
    assert "but it was never more than 5 mm from where it began" in unstated["reason"], unstated["reason"]
    stated = on(UNTOUCHED, judged(models, tmp_path, messages, "--uncertainty", "bin_left=4 mm")[0])
    assert (stated["verdict"], stated["robustness"]) == ("holds", pytest.approx(0.05))
    vague = on(UNTOUCHED, judged(models, tmp_path, messages, "--uncertainty", "bin_left=15 mm")[0])
    assert (vague["verdict"], vague["reason"]) == (
        "unknown",
        "its margin of +0.05 m is within the uncertainty of the measurements, ±0.06 m",
    )


def test_a_bin_on_the_cart_of_the_arm_is_not_pushed_by_driving(models: Path, tmp_path: Path) -> None:
    """The arm and the bin stand on a cart that drives by 2 m while the arm moves."""
    cell = [one for one in drive() if frame_of(one) not in ("bin_left", "panda")]
    cart = [transform("cart", (2.0 * tick / 500, 0.0, 0.0), stamp=tick / 50) for tick in range(501)]
    tools = [transform("panda", (0.5, 0.0, 1.0), stamp=tick / 50, parent="cart") for tick in range(501)]
    tray = transform("bin_left", (0.0, 0.4, 0.8), stamp=0.0, parent="cart", topic="/tf_static")
    found, _ = judged(models, tmp_path, [*cell, tray, *cart, *tools])
    untouched = on(UNTOUCHED, found)
    assert untouched["verdict"] == "unknown", untouched
    assert "whether it moved is not known" in untouched["reason"]


def test_a_bin_behind_a_marker_that_is_observed_is_observed(models: Path, tmp_path: Path) -> None:
    cell = [one for one in drive() if frame_of(one) != "bin_left"]
    marker = [transform("tag_3", (0.55, 0.2, 0.8), stamp=tick / 50) for tick in range(501)]
    tray = transform("bin_left", (0.0, 0.1, 0.0), stamp=0.0, parent="tag_3", topic="/tf_static")
    found, _ = judged(models, tmp_path, [*cell, tray, *marker])
    assert set(verdicts(found).values()) == {"holds"}, found


def test_a_driver_in_millimetres_is_named(models: Path, tmp_path: Path) -> None:
    cell = [one for one in drive() if frame_of(one) != "cube0"]
    cubes = [transform("cube0", (450.0, 0.0, 825.0), stamp=tick / 50) for tick in range(501)]
    found, remarks = judged(models, tmp_path, [*cell, *cubes])
    assert on("at-source", found)["verdict"] == "violated"
    assert "env:cube0 and env:table are 939 m apart: positions in a log are read in metres" in remarks, remarks
    assert "apart" not in judged(models, tmp_path, drive())[1]


GIZMOS = {
    "cell.scene": """
ns cell = 'https://example.org/gizmos/'
obj set (ns=cell) things { object gizmo, object plinth }
ws set (ns=cell) spots { workspace top }
agn set (ns=cell) helpers { agent elbow }
comp (ns=cell) on_plinth of ws <spots.top> { obj <things.plinth> }
scene (ns=cell) gizmo_cell { obj set <things> agn set <helpers> ws comp <on_plinth> }
""",
    "cell.scenex": """
import "cell.scene"
ns real = 'https://example.org/gizmos/real/'
scene inst (ns=real) lab {
    scene: <gizmo_cell>
    obj <things.gizmo> { model gizmo_model as mjcf { catalog "cube" } }
    obj <things.plinth> { model plinth_model as mjcf { catalog "table" } }
    agn <helpers.elbow> { model elbow_model as mjcf { catalog "ur10" } }
}
""",
    "gizmo.bdd": """
import "cell.scene"
ns req = 'https://example.org/gizmos/requirements/'
Event (ns=req) begun
Event (ns=req) done
Scenario Template (ns=req) resting {
    duration: from <begun> until <done>
    var what
    var where
    var who
    Given:
        there: holds(<what> is located at <where>, from <begun> until <done>)
    When:
        Behaviour (ns=req) take { duration: from <begun> until <done> <who> picks <what> }
    Then:
        still-there: holds(<what> is located at <where>, from <begun> until <done>)
}
User Story (ns=req) rest {
    As A "keeper" I Want "the gizmo to stay" So That "I find it"
    Scenarios:
        Scenario stays {
            template: <resting>
            scene: <gizmo_cell>
            variation:
                var <resting.what>: { <things.gizmo> }
                var <resting.where>: { <spots.top> }
                var <resting.who>: { <helpers.elbow> }
        }
}
""",
}


def test_a_scenex_gives_a_scenario_its_models(tmp_path: Path) -> None:
    for name, content in GIZMOS.items():
        (tmp_path / name).write_text(content, encoding="utf-8")
    messages = [text("begun", 0.5), text("done", 9.0)]
    for tick in range(501):
        messages.append(transform("gizmo", (0.5, 0.0, 0.83), stamp=tick / 50))
        messages.append(transform("plinth", (0.5, 0.0, 0.8), stamp=tick / 50))
    write(tmp_path / "drive", messages)
    without = robbdd(tmp_path, "judge", "drive", "gizmo.bdd", "--no-store")
    assert "is not known: state its box in a .scenex" in without.stdout
    assert "plinth has no model" in without.stderr
    done = robbdd(
        tmp_path, "judge", "drive", "gizmo.bdd", "--scenex", "cell.scenex", "--no-store", "--json", "out.json"
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert set(verdicts(clauses(tmp_path / "out.json")).values()) == {"holds"}
    wrong = robbdd(tmp_path, "judge", "drive", "gizmo.bdd", "--scenex", "cell.scene", "--no-store")
    assert (wrong.returncode, wrong.stderr) == (2, "robbdd: cell.scene is not a .scenex file\n")
