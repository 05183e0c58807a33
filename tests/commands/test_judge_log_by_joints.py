"""``robbdd judge LOG``: the joints of an arm give its tool where the log has no frame of it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from logs.bags import Message, joints, text, transform, write
from logs.drives import clauses, robbdd

pytestmark = pytest.mark.physics
SCENE = """ns s = 'https://example.org/shop/'
obj set (ns=s) stock { object cube_a }
obj set (ns=s) fittings { object table, object bin_out }
ws set (ns=s) areas { workspace infeed, workspace outfeed }
agn set (ns=s) machines { agent ur10 }
comp (ns=s) on_table of ws <areas.infeed> { obj <fittings.table> }
comp (ns=s) in_bin of ws <areas.outfeed> { obj <fittings.bin_out> }
scene (ns=s) shop {
    obj set <stock>
    ws comp <on_table>
    ws comp <in_bin>
    agn set <machines>
}
"""
STORY = """import "shop.scene"
ns m = 'https://example.org/shop/moves/'
Task (ns=m) swing-task
Event (ns=m) evt-start
Event (ns=m) evt-pick-start
Event (ns=m) evt-place-end
Event (ns=m) evt-end
Scenario Template (ns=m) swing {
    duration: from <evt-start> until <evt-end>
    task: <swing-task>
    var arm
    var part
    var goal
    When:
        Behaviour (ns=m) carry {
            duration: from <evt-pick-start> until <evt-place-end>
            <arm> picks <part> and places at <goal>
        }
    Then: (
        slow: holds(<arm> moves slower than 1.2 m/s, from <evt-pick-start> until <evt-place-end>)
        and limits: holds(<arm> keeps its joints 5 % from their limits, from <evt-pick-start> until <evt-place-end>)
        and above: holds(<arm> is nearer than 2 m to <goal>, before <evt-place-end>)
    )
}
User Story (ns=m) move-parts {
    As A "packer"
    I Want "parts in the bin"
    So That "they are shipped"
    Scenarios:
        Scenario one {
            template: <swing>
            scene: <shop>
            variation:
                | <swing.arm>     | <swing.part>   | <swing.goal>    |
                |-----------------|----------------|-----------------|
                | <machines.ur10> | <stock.cube_a> | <areas.outfeed> |
        }
}
"""
PLACES = """import "shop.scene"
ns x = 'https://example.org/shop/sim/'
scene inst (ns=x) shop_sim {
    scene: <shop>
    kgraph (ns=x) poses {
        body room { frame origin { } }
        body foot { frame base { pose p1 {
            wrt: <room.origin> xyz: (0.1, 0, 0.2) m orientation: euler { angles: (0, 0, 90) unit: deg } } } }
        body out { frame o { pose p2 {
            wrt: <room.origin> xyz: (-0.4, 0.4, 0) m orientation: quat { xyzw: (0, 0, 0, 1) } } } }
    }
    obj set <stock> { model m1 as mjcf { catalog "cube" } }
    obj <fittings.table> { model m2 as mjcf { catalog "table" } }
    obj <fittings.bin_out> { model m3 as mjcf { catalog "bin" map body <poses.out> to "bin" } }
    agn <machines.ur10> { model m4 as mjcf { catalog "ur10" map body <poses.foot> to "base" } }
}
"""
EXECUTION = """import "shop.bdd"
import "shop.scenex"
ns e = 'https://example.org/shop/exec/'
bhv impl (ns=e) server { bhv action: "/move" }
Scenario Exec (ns=e) real { variant: <move-parts.one> scene inst: <shop_sim> bhv: <server> }
"""
# The order of the driver differs from that of the model.
ORDER = ("elbow", "shoulder_lift", "shoulder_pan", "wrist_1", "wrist_2", "wrist_3")
MODEL = ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")
HOME = {"shoulder_lift": -2.12, "elbow": 2.03, "wrist_1": -1.477, "wrist_2": -1.57, "wrist_3": -1.99}
RATE = 0.3
"""Speed (rad/s) at which the first joint turns."""
EVENTS = [text("pick-start", 101.0), text("place-end", 109.0)]


def posture(time: float) -> dict[str, float]:
    return {**HOME, "shoulder_pan": RATE * (time - 100.0)}


def states(lost: tuple[float, float] = (0.0, 0.0), *, left_out: str = "", factor: float = 1.0) -> list[Message]:
    """Joint states at 125 Hz for 10 s, in the order of the driver. From ``lost[0]`` to ``lost[1]`` there are none."""
    found: list[Message] = []
    for tick in range(1251):
        time = 100.0 + tick / 125
        known = posture(time)
        names = [name for name in ORDER if name != left_out]
        if not lost[0] < time - 100.0 < lost[1]:
            found.append(joints([f"{name}_joint" for name in names], [factor * known[one] for one in names], time))
    return found


def tool_in_base_link(position: dict[str, float]) -> Any:
    """Return the position (m) of the cup's rim in ``base_link``, by the published Denavit-Hartenberg parameters."""
    rows: Iterable[tuple[float, float, float]] = zip(
        (0.0, -0.612, -0.5723, 0.0, 0.0, 0.0),
        (0.1273, 0.0, 0.0, 0.163941, 0.1157, 0.0922),
        (math.pi / 2, 0.0, 0.0, math.pi / 2, -math.pi / 2, 0.0),
        strict=True,
    )
    # ``base`` of the parameters is turned by half a turn about z.
    pose = np.diag([-1.0, -1.0, 1.0, 1.0])
    for name, (a, d, alpha) in zip(MODEL, rows, strict=True):
        c, s, k, m = math.cos(position[name]), math.sin(position[name]), math.cos(alpha), math.sin(alpha)
        pose = pose @ np.array([[c, -s * k, s * m, a * c], [s, c * k, -c * m, a * s], [0, m, k, d], [0, 0, 0, 1.0]])
    return (pose @ np.array([0.0, 0.0, 0.16, 1.0]))[:3]


@pytest.fixture
def shop(tmp_path: Path) -> Path:
    files = {"shop.scene": SCENE, "shop.bdd": STORY, "shop.scenex": PLACES, "shop.bddx": EXECUTION}
    for name, content in files.items():
        (tmp_path / name).write_text(content, encoding="utf-8")
    return tmp_path


def judged(shop: Path, messages: Sequence[Message], *more: str) -> tuple[dict[str, dict[str, Any]], str]:
    bag = write(shop / "drive", sorted(messages, key=lambda one: one.received))
    return judged_log(shop, bag, *more)


def judged_log(shop: Path, log: Path, *more: str) -> tuple[dict[str, dict[str, Any]], str]:
    out = shop / "log.json"
    done = robbdd(shop, "judge", str(log), "shop.bddx", "--no-store", "--json", str(out), *more)
    assert done.returncode in (0, 1), done.stderr
    return {one["name"].rpartition(".")[2]: one for one in clauses(out)}, done.stderr


def expected(place: Any, turn: float) -> tuple[float, float]:
    """Return the margins of *slow* and *above* for a base at ``place`` (m) that is turned by ``turn`` (rad)."""
    c, s = math.cos(turn), math.sin(turn)
    tool = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ tool_in_base_link(posture(109.0)) + place
    # The first joint alone moves: the tool is on a circle about the base.
    radius = float(np.hypot(*tool_in_base_link(posture(109.0))[:2]))
    bin_middle = np.array([-0.4, 0.4, 0.0])
    return 1.2 - RATE * radius, 2.0 - float(np.linalg.norm((tool - bin_middle)[:2]))


def test_the_tool_follows_from_the_joints_and_the_base_of_the_scenex(shop: Path) -> None:
    camera = transform("camera", (0.0, 0.0, 1.0), stamp=0.0, parent="base_link", topic="/tf_static")
    found, remarks = judged(shop, [camera, *states(), *EVENTS])
    slow, near = expected(np.array([0.1, 0.0, 0.2]), math.pi / 2)
    assert found["slow"]["robustness"] == pytest.approx(slow, abs=1e-4)
    # The distance also has a vertical part, which makes the margin smaller.
    assert near - 0.3 < found["above"]["robustness"] < near
    # The first joint is at 2.7 rad of ±2π rad; the elbow at 2.03 rad.
    assert found["limits"]["robustness"] == pytest.approx(100 * (2 * math.pi - 2.7) / (4 * math.pi) - 5, abs=1e-3)
    words = "the log has no frame of the world: 'base_link' is the base of s:ur10, which stands where the .scenex"
    assert words in remarks
    assert "the log has no frame for s:ur10" not in remarks


def test_the_base_of_the_log_takes_precedence(shop: Path) -> None:
    base = transform("cell_base", (0.5, 0.0, 0.0), stamp=0.0, parent="world", topic="/tf_static")
    usual = transform("base_link", (-0.4, 0.4, 0.0), stamp=0.0, parent="world", topic="/tf_static")
    first, remarks = judged(shop, [base, usual, *states(), *EVENTS], "--base", "ur10=cell_base")
    assert "the base of s:ur10 is the frame 'cell_base'" in remarks
    second, remarks = judged_log(shop, shop / "drive")
    assert "the base of s:ur10 is the frame 'base_link'" in remarks
    assert first["slow"]["robustness"] == pytest.approx(second["slow"]["robustness"], abs=1e-6)
    assert first["above"]["robustness"] < second["above"]["robustness"] - 0.1
    wrong, remarks = judged_log(shop, shop / "drive", "--base", "ur10=cell_bas")
    assert "the log has no frame 'cell_bas' for the base of s:ur10; nearest: cell_base" in remarks
    assert wrong["slow"]["verdict"] == "holds"
    assert "the base of s:ur10 is where the .scenex places it" in remarks


def test_a_gap_in_the_joints_is_unknown_with_its_place(shop: Path) -> None:
    found, _ = judged(shop, [*states((4.0, 6.0)), *EVENTS])
    assert found["slow"]["reason"] == "s:ur10 was not observed between 4.00 s and 6.00 s"
    assert found["limits"]["reason"] == "the joints of s:ur10 were not observed between 4.00 s and 6.00 s"
    assert found["above"]["verdict"] == "holds"
    found, _ = judged_log(shop, shop / "drive", "--max-gap", "2.5")
    assert found["slow"]["verdict"] == "holds"


def test_a_missing_joint_is_named_and_nothing_passes(shop: Path) -> None:
    found, remarks = judged(shop, [*states(left_out="wrist_2"), *EVENTS])
    assert {name: one["verdict"] for name, one in found.items() if name != "when"} == {
        "slow": "unknown",
        "limits": "unknown",
        "above": "unknown",
    }
    assert "the log has no joint 'wrist_2' of s:ur10" in remarks
    assert "name it with --joint ur10/wrist_2=NAME" in remarks


def test_joints_in_degrees_are_not_used(shop: Path) -> None:
    found, remarks = judged(shop, [*states(factor=180 / math.pi), *EVENTS])
    assert found["limits"]["verdict"] == "unknown"
    assert "beyond the limits of the arm: record them in rad" in remarks


@pytest.mark.parametrize(
    ("option", "value", "words"),
    [
        ("--joint", "elbo=q2", "no agent has a joint 'elbo'; nearest: elbow"),
        ("--joints", "ur5=/joint_states", "the scene has no element 'ur5'"),
        ("--base", "ur5=base", "the scene has no element 'ur5'"),
        ("--column", "time", "'time' must be NAME=VALUE"),
    ],
)
def test_wrong_names_are_refused(option: str, value: str, words: str, shop: Path) -> None:
    bag = write(shop / "drive", [*states()[:10], *EVENTS])
    done = robbdd(shop, "judge", str(bag), "shop.bddx", "--no-store", option, value)
    assert done.returncode == 2
    assert words in done.stderr


def test_a_table_with_columns_of_its_own_gives_the_same(shop: Path) -> None:
    bag, _ = judged(shop, [*states(), *EVENTS])
    rows = ["timestamp " + " ".join(f"actual_q_{one}" for one in range(6)) + " robot_mode"]
    for tick in range(1251):
        known = posture(100.0 + tick / 125)
        rows.append(" ".join([f"{tick / 125:.6f}", *(f"{known[name]:.9f}" for name in MODEL), "RUNNING"]))
    table, events = shop / "rtde.csv", shop / "events.csv"
    table.write_text("\n".join(rows), encoding="utf-8")
    events.write_text("time,event\n1,pick-start\n9,place-end\n", encoding="utf-8")
    names = [word for one, joint in enumerate(MODEL) for word in ("--joint", f"{joint}=actual_q_{one}")]
    found, _ = judged_log(shop, table, "--column", "time=timestamp", "--events", str(events), *names)
    for name in ("slow", "limits", "above"):
        assert found[name]["robustness"] == pytest.approx(bag[name]["robustness"], abs=1e-5), found[name]
