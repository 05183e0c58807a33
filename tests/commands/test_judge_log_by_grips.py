"""``robbdd judge LOG``: declared signals of a gripper say what is held; what they leave open is unknown."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from kit import EXAMPLES
from logs.bags import Message, contact, joints, text, transform, truth, wrench, write
from logs.drives import clauses, drive, robbdd

pytestmark = pytest.mark.physics
STORY = """import "bench.scene"
ns g = 'https://example.org/grips/'
Task (ns=g) carry-task
Event (ns=g) evt-start
Event (ns=g) evt-pick-start
Event (ns=g) evt-pick-end
Event (ns=g) evt-place-end
Event (ns=g) evt-end
Scenario Template (ns=g) carry {
    duration: from <evt-start> until <evt-end>
    task: <carry-task>
    var thing
    var robot
    var goal
    When:
        Behaviour (ns=g) over {
            duration: from <evt-pick-start> until <evt-place-end>
            <robot> picks <thing> and places at <goal>
        }
    Then: (
        held: holds(<thing> is held by <robot>, 1 seconds after <evt-pick-end>)
        and (not free: holds(<thing> is held by <robot>, 1 seconds after <evt-place-end>))
    )
}
User Story (ns=g) grips {
    As A "packer"
    I Want "parts to be held"
    So That "none is lost"
    Scenarios:
        Scenario one {
            template: <carry>
            scene: <bench_scene>
            variation:
                | <carry.thing> | <carry.robot> | <carry.goal>     |
                |---------------|---------------|------------------|
                | <cubes.cube0> | <arms.panda>  | <places.left_ws> |
        }
}
"""


@pytest.fixture(scope="module")
def models(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = shutil.copytree(EXAMPLES / "pickplace", tmp_path_factory.mktemp("grips") / "models")
    (folder / "grips.bdd").write_text(STORY, encoding="utf-8")
    return folder


def signals(make: Callable[[bool, float], Message]) -> list[Message]:
    """A signal at 50 Hz that is on from 2.9 s to 7.9 s, while the cube is carried."""
    return [make(2.9 <= tick / 50 < 7.9, tick / 50) for tick in range(501)]


def others() -> list[Message]:
    """A drive without texts on what is held."""
    return [one for one in drive() if one.topic != "/panda/holds"]


def judged(models: Path, folder: Path, messages: list[Message], *grips: str) -> dict[str, dict[str, Any]]:
    bag = write(folder / "drive", sorted(messages, key=lambda one: one.received))
    out = folder / "log.json"
    more = [word for grip in grips for word in ("--grip", grip)]
    done = robbdd(models, "judge", str(bag), "grips.bdd", "--no-store", "--json", str(out), *more)
    assert done.returncode in (0, 1), done.stderr
    return {one["name"].rpartition(".")[2]: one for one in clauses(out)}


def verdicts(found: dict[str, dict[str, Any]]) -> tuple[str, str]:
    (free,) = (one for one in found.values() if one["sentence"].startswith("not"))
    return found["held"]["verdict"], free["verdict"]


def finger(on: bool, time: float) -> Message:
    return joints(["finger"], [0.0155 if on else 0.04], time, efforts=[-12.0 if on else 0.1], topic="/hand")


SIGNALS: dict[str, tuple[Callable[[bool, float], Message], str]] = {
    "vacuum": (lambda on, time: truth("/vacuum", on, time), "panda=/vacuum"),
    "contact": (lambda on, time: contact("/pad", on, time), "panda=/pad"),
    "joint": (finger, "panda=joint finger between 10 mm and 20 mm"),
    "effort": (finger, "panda=effort finger above 5 N"),
    "wrench": (lambda on, time: wrench("/ft", (0, 3, 4) if on else (0, 0, 1), time), "panda=wrench /ft above 4.5 N"),
}


@pytest.mark.parametrize("kind", SIGNALS)
def test_a_signal_and_the_place_of_the_tool_say_what_is_held(kind: str, models: Path, tmp_path: Path) -> None:
    make, grip = SIGNALS[kind]
    assert verdicts(judged(models, tmp_path, [*others(), *signals(make)], grip)) == ("holds", "holds")


def test_signals_of_one_agent_must_all_agree(models: Path, tmp_path: Path) -> None:
    never = [truth("/vacuum", False, tick / 50) for tick in range(501)]
    found = judged(models, tmp_path, [*others(), *signals(finger), *never], SIGNALS["joint"][1], "panda=/vacuum")
    assert verdicts(found) == ("violated", "holds")


def test_without_a_signal_the_reason_says_what_to_add(models: Path, tmp_path: Path) -> None:
    found = judged(models, tmp_path, others())
    assert verdicts(found) == ("unknown", "unknown")
    words = "the log does not say what env:panda holds: add --grip panda=SIGNAL of its gripper, or record texts on"
    assert words in found["held"]["reason"]


def test_a_hand_that_is_closed_on_something_else_does_not_hold_the_object(models: Path, tmp_path: Path) -> None:
    """The cube stays 0.2 m away from the tool."""
    away = [transform("cube0", (0.45, 0.2, 0.825), stamp=tick / 50) for tick in range(501)]
    seen = [one for one in others() if one.topic != "/tf"]
    tool = [transform("panda", (0.45, 0.0, 0.825), stamp=tick / 50) for tick in range(501)]
    found = judged(models, tmp_path, [*seen, *away, *tool, *signals(finger)], SIGNALS["joint"][1])
    assert verdicts(found) == ("violated", "holds")


def test_of_two_objects_at_the_tool_neither_is_known_to_be_held(models: Path, tmp_path: Path) -> None:
    beside = [transform("cube1", (0.45, 0.0, 0.825), stamp=tick / 50) for tick in range(501)]
    still = [transform("cube0", (0.45, 0.03, 0.825), stamp=tick / 50) for tick in range(501)]
    tool = [transform("panda", (0.45, 0.01, 0.825), stamp=tick / 50) for tick in range(501)]
    seen = [one for one in others() if one.topic != "/tf"]
    messages = [*seen, *beside, *still, *tool, *signals(finger)]
    assert verdicts(judged(models, tmp_path, messages, SIGNALS["joint"][1])) == ("unknown", "holds")


def test_an_object_without_poses_is_held_only_if_the_signal_is_declared_for_it(models: Path, tmp_path: Path) -> None:
    """Nothing says where the cube is."""
    blind = [
        text("pick-start", 1.0),
        text("pick-end", 3.0),
        text("place-end", 8.0),
        *signals(SIGNALS["vacuum"][0]),
    ]
    found = judged(models, tmp_path, blind, "panda=/vacuum")
    assert verdicts(found) == ("unknown", "unknown")
    assert "add --frame cube0=FRAME, or --grip panda/cube0=SIGNAL" in found["held"]["reason"]
    shutil.rmtree(tmp_path / "drive")
    assert verdicts(judged(models, tmp_path, blind, "panda/cube0=/vacuum")) == ("holds", "holds")


def test_a_gap_of_the_signal_is_unknown(models: Path, tmp_path: Path) -> None:
    lost = [one for one in signals(finger) if not 3.2 < one.received < 3.9]
    found = judged(models, tmp_path, [*others(), *lost], SIGNALS["joint"][1])
    assert found["held"]["verdict"] == "unknown"
    assert "it was not observed what env:panda held at 3.2" in found["held"]["reason"]


@pytest.mark.parametrize(
    ("grip", "words"),
    [
        ("panda=/vacum", "the log has no topic of truth values '/vacum'; it has: /vacuum"),
        ("panda=joint thumb above 1 mm", "the log has no joint 'thumb'; it has: finger"),
        ("panda=effort slide above 1", "the log has no efforts of joint 'slide'"),
        ("panda=joint percent above 5 mm", "joint 'percent' has positions up to 100, which are neither in m nor"),
        ("panda=wrench /ft above 1 N", "the log has no wrenches on '/ft'"),
        ("pandora=/vacuum", "the scene has no element 'pandora'; nearest: panda"),
        ("panda/cub0=/vacuum", "the scene has no element 'cub0'; nearest: cube0"),
        ("panda=fingers", "declares no grip: write AGENT=/topic"),
    ],
)
def test_a_signal_that_the_log_lacks_is_refused(grip: str, words: str, models: Path, tmp_path: Path) -> None:
    slide = joints(["slide"], [0.0], 1.0)
    if "percent" in grip:
        slide = joints(["percent"], [100.0], 1.0)
    kept = [one for one in (*signals(finger), *signals(SIGNALS["vacuum"][0]), slide) if one.received < 2]
    if "thumb" in grip:
        kept.remove(slide)
    bag = write(tmp_path / "drive", sorted(kept, key=lambda one: one.received))
    done = robbdd(models, "judge", str(bag), "grips.bdd", "--no-store", "--grip", grip)
    assert done.returncode == 2
    assert words in done.stderr
