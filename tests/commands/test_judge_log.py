"""``robbdd judge LOG`` and ``robbdd export``: bags of simulated runs, and logs written by hand."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from kit import EXAMPLES
from logs.bags import ROS2, Message, detected, goals, pose, transform, write
from logs.drives import ONE, clauses, drive, judged, robbdd, verdicts

pytestmark = pytest.mark.physics
NOT_IN_A_LOG = {"can reach", "has config"}
"""Words of predicates on what a log does not contain."""


@pytest.mark.parametrize(
    ("example", "model", "storage"),
    [
        ("pickplace", "pickplace.bddx", "sqlite"),
        ("sorting", "sorting.bdd", "mcap"),
        ("inturn", "inturn.bdd", "sqlite"),
        ("shelf", "shelf.bdd", "sqlite"),
        ("deadlines", "deadlines.bdd", "mcap"),
        ("relatedstories", "stories.bdd", "sqlite"),
    ],
)
def test_a_bag_of_a_run_gives_its_verdicts_and_margins(example: str, model: str, storage: str, tmp_path: Path) -> None:
    folder = shutil.copytree(EXAMPLES / example, tmp_path / "models")
    assert robbdd(folder, "run", model, "--first", "1", "--json", "run.json").returncode == 0
    run = json.loads((folder / "run.json").read_text(encoding="utf-8"))["scenarios"]
    variant = run[0]["variant"]
    robbdd(folder, "export", "latest", "--ros2", "-o", "bag", *(["--mcap"] if storage == "mcap" else []))
    bag = "bag" if (folder / "bag" / "metadata.yaml").exists() else "bag/1"
    values = {name.rpartition("var-")[2]: value for name, value in run[0]["values"].items()}
    where = " and ".join(f"{name}={one.rpartition(':')[2]}" for name, one in values.items() if isinstance(one, str))
    where = where or " and ".join(f"{name}={one}" for name, one in values.items() if isinstance(one, float))
    chosen = ["--where", where, "--scenario", variant]
    done = robbdd(folder, "judge", bag, model, "--no-store", "--json", "log.json", *chosen)
    assert done.returncode in (0, 1), done.stderr
    for simulated, logged in zip(run[0]["clauses"], clauses(folder / "log.json"), strict=True):
        if any(words in simulated["sentence"] for words in NOT_IN_A_LOG):
            assert logged["verdict"] == "unknown"
            continue
        assert logged["verdict"] == simulated["verdict"], logged
        # Stamps are rounded to nanoseconds. The camera that a policy simulates adds noise of 2 mm to each axis.
        tolerance = 0.02 if example == "pickplace" else 1e-6
        if logged["robustness"] is not None:
            assert logged["robustness"] == pytest.approx(simulated["robustness"], abs=tolerance), logged["sentence"]


@pytest.fixture(scope="module")
def models(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return shutil.copytree(EXAMPLES / "pickplace", tmp_path_factory.mktemp("log") / "models")


def test_a_drive_that_puts_the_cube_into_the_bin_holds(models: Path, tmp_path: Path) -> None:
    found, remarks = judged(models, tmp_path, drive())
    assert set(verdicts(found).values()) == {"holds"}, found
    assert "the log does not report crit:evt-end: the end of the log counts" in remarks


def test_a_bin_that_is_stated_to_be_somewhere_was_not_seen_to_stay_there(models: Path, tmp_path: Path) -> None:
    """A static transform says where somebody put the bin, not whether the arm has pushed it."""
    static = [transform("bin_left", (0.55, 0.3, 0.8), stamp=0.0, topic="/tf_static")]
    found, _ = judged(models, tmp_path, [*static, *without("bin_left")])
    assert verdicts(found)["goal-untouched"] == "unknown"
    (untouched,) = (one for one in found if one["name"].endswith("goal-untouched"))
    words = "the log does not observe env:bin_left: its place is that of a static transform or of the .scenex"
    assert untouched["reason"] == f"{words}, so whether it moved is not known"
    assert verdicts(found)["at-goal"] == "holds", "where the bin is counts as known"


def without(frame: str) -> list[Message]:
    """A drive without one of its frames."""
    return [one for one in drive() if one.topic != "/tf" or one.make(ROS2).transforms[0].child_frame_id != frame]


def test_a_cube_beside_the_bin_violates(models: Path, tmp_path: Path) -> None:
    found, _ = judged(models, tmp_path, drive(end=(0.55, 0.0, 0.825)))
    assert verdicts(found)["at-goal"] == "violated"
    goal = next(one for one in found if one["name"].endswith("at-goal"))
    assert goal["robustness"] < -0.05
    assert goal["at"] == pytest.approx(8.0)


def test_what_was_not_seen_is_unknown_with_the_gap(models: Path, tmp_path: Path) -> None:
    found, _ = judged(models, tmp_path, drive((7.0, 9.0)))
    goal = next(one for one in found if one["name"].endswith("at-goal"))
    assert (goal["verdict"], goal["reason"]) == ("unknown", "env:cube0 was not observed between 7.00 s and 9.00 s")
    found, _ = judged(models, tmp_path, drive((7.0, 9.0)), "--max-gap", "3")
    assert verdicts(found)["at-goal"] == "holds"


def test_an_event_that_the_log_lacks_is_unknown_or_comes_from_a_table(models: Path, tmp_path: Path) -> None:
    silent = [one for one in drive() if one.topic != "/events"]
    found, _ = judged(models, tmp_path, silent)
    assert verdicts(found)["at-goal"] == "unknown"
    assert "never occurred" in next(one for one in found if one["name"].endswith("at-goal"))["reason"]
    table = tmp_path / "events.csv"
    table.write_text("time,event\n1,pick-start\n3,pick-end\n6,place-start\n8,evt-place-end\n", encoding="utf-8")
    found, _ = judged(models, tmp_path, silent, "--events", str(table))
    assert set(verdicts(found).values()) == {"holds"}, found


def test_a_frame_of_another_name_is_named_by_an_argument(models: Path, tmp_path: Path) -> None:
    messages = drive(cube="object_7")
    found, remarks = judged(models, tmp_path, messages)
    assert verdicts(found)["at-goal"] == "unknown"
    assert "the log has no frame for env:cube0" in remarks
    assert "name it with --frame cube0=FRAME" in remarks
    found, _ = judged(models, tmp_path, messages, "--frame", "cube0=object_7")
    assert verdicts(found)["at-goal"] == "holds"


def test_a_drive_of_detections_and_actions_holds(models: Path, tmp_path: Path) -> None:
    """The camera detects the cube, and actions report when they begin and end."""
    plain = drive()
    seen = [_replaced(one) for one in plain if one.topic in ("/tf", "/panda/holds")]
    fixed = [one for one in plain if one.topic == "/tf_static"]
    states = [(1.0, "pick", 2), (3.0, "pick", 4), (6.0, "place", 2), (8.0, "place", 4)]
    done = [goals(action, {"a": number}, time) for time, action, number in states]
    found, remarks = judged(models, tmp_path, [*fixed, *seen, *done], "--world", "map")
    assert set(verdicts(found).values()) == {"holds"}, (found, remarks)
    failed = [*done[:3], goals("place", {"a": 6}, 8.0)]
    found, remarks = judged(models, tmp_path, [*fixed, *seen, *failed], "--world", "map")
    assert verdicts(found)["at-goal"] == "unknown"
    assert "a goal on '/place/_action/status' did not succeed: 'place-end' is not reported" in remarks


def _replaced(one: Message) -> Message:
    """Turn the transform of the cube into a detection."""
    if one.topic != "/tf":
        return one
    (moved,) = one.make(ROS2).transforms
    if moved.child_frame_id != "cube0":
        return one
    where = moved.transform.translation
    return detected([("", "cube0", (where.x, where.y, where.z))], one.received, topic="/camera/objects")


@pytest.mark.parametrize(
    ("stated", "verdict", "reason"),
    [
        (("2 mm",), "holds", ""),
        (("40 mm",), "unknown", "is within the uncertainty of the measurements, ±0.08 m"),
        (("2 mm", "cube0=70 mm"), "unknown", "is within the uncertainty of the measurements, ±0.072 m"),
        (("40 mm", "cube0=0 mm", "bin_left=1 mm"), "holds", ""),
    ],
)
def test_a_margin_within_the_uncertainty_of_the_measurements_is_unknown(
    stated: tuple[str, ...], verdict: str, reason: str, models: Path, tmp_path: Path
) -> None:
    more = [word for one in stated for word in ("--uncertainty", one)]
    found, _ = judged(models, tmp_path, drive(), *more)
    goal = next(one for one in found if one["name"].endswith("at-goal"))
    assert goal["verdict"] == verdict, goal
    assert reason in goal["reason"]


def test_a_stored_judgement_keeps_its_uncertainty(models: Path, tmp_path: Path) -> None:
    folder = shutil.copytree(models, tmp_path / "models")
    bag = write(tmp_path / "drive", drive())
    robbdd(folder, "judge", str(bag), "pickplace.bdd", *ONE, "--uncertainty", "60 mm")
    again = robbdd(folder, "judge", "1", "pickplace.bdd", "--json", str(tmp_path / "again.json"))
    assert again.returncode == 1, again.stderr
    assert verdicts(clauses(tmp_path / "again.json"))["at-goal"] == "unknown"


@pytest.mark.parametrize(
    ("option", "value", "words"),
    [
        ("--uncertainty", "cub0=3 mm", "the scene has no element 'cub0'; nearest: cube0"),
        (
            "--world",
            "mapp",
            "the log has no frame 'mapp' for --world; it has: bin_left, bin_right, cube0, map",
        ),
        ("--frame", "bin_lef=tray", "the scene has no element 'bin_lef'; nearest: bin_left"),
        ("--uncertainty", "3", "'3' is no uncertainty: write '3 mm'"),
        ("--uncertainty", "cube0=3 deg", "'cube0=3 deg' is no uncertainty"),
        ("--uncertainty", "-3 mm", "'-3 mm' is no uncertainty"),
        ("--uncertainty", "3 N", "'3 N' is no uncertainty"),
    ],
)
def test_a_wrong_name_or_quantity_is_refused(option: str, value: str, words: str, models: Path, tmp_path: Path) -> None:
    bag = write(tmp_path / "drive", drive())
    done = robbdd(models, "judge", str(bag), "pickplace.bdd", "--no-store", *ONE, f"{option}={value}")
    assert done.returncode == 2
    assert words in done.stderr


def test_a_log_of_several_scenarios_is_refused_with_their_values(models: Path, tmp_path: Path) -> None:
    bag = write(tmp_path / "drive", drive())
    done = robbdd(models, "judge", str(bag), "pickplace.bdd")
    assert done.returncode == 2
    assert "drive is the log of one execution, but 4 scenarios fit" in done.stderr
    assert "thing = cube0, robot = panda, source = table_ws, goal = left_ws" in done.stderr
    assert not (models / ".robbdd").exists()


def test_the_result_is_a_stored_run_that_is_judged_again_and_not_simulated(models: Path, tmp_path: Path) -> None:
    folder = shutil.copytree(models, tmp_path / "models")
    bag = write(tmp_path / "drive", drive())
    done = robbdd(folder, "judge", str(bag), "pickplace.bdd", *ONE)
    assert done.returncode == 0, done.stderr
    assert "kept as run 1" in done.stderr
    listed = robbdd(folder, "runs").stdout
    assert "1 hold" in listed
    shown = subprocess.run(
        [sys.executable, "-P", "-m", "robbdd_tools.agent.show_trace", str(folder / ".robbdd" / "runs" / "1"), "0"],
        capture_output=True,
        encoding="utf-8",
        check=True,
    )
    drawn = json.loads(shown.stdout)
    names = [body["name"] for body in drawn["bodies"]]
    assert names == ["env:bin_left", "env:bin_right", "env:cube0", "env:table", "env:panda/tool"]
    assert drawn["forces"] is None
    assert drawn["bodies"][2]["position"] == pytest.approx([0.45, 0.0, 0.825], abs=1e-3)
    again = robbdd(folder, "judge", "1", "pickplace.bdd")
    assert again.returncode == 0, again.stderr
    refused = robbdd(folder, "replay", "1")
    assert refused.returncode == 2
    assert "drive is a log: nothing of it can be simulated again" in refused.stderr


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("drive.bag", b"", "drive.bag cannot be read as a ROS bag"),
        ("drive.mcap", b"\x89MCAP0\r\n", "drive.mcap cannot be read as MCAP"),
        ("drive.csv", b"a,b\n", "drive.csv:1: there is no column 'time'"),
    ],
)
def test_a_damaged_log_is_refused(name: str, content: bytes, words: str, models: Path, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(content)
    done = robbdd(models, "judge", str(tmp_path / name), "pickplace.bdd", *ONE, "--no-store")
    assert done.returncode == 2
    assert words in done.stderr


def test_a_folder_that_exists_is_not_written(models: Path, tmp_path: Path) -> None:
    folder = shutil.copytree(models, tmp_path / "models")
    assert robbdd(folder, "run", "pickplace.bdd", "--first", "1").returncode == 0
    done = robbdd(folder, "export", "1", "--ros2", "-o", str(tmp_path))
    assert done.returncode == 2
    assert "exists: name a new folder" in done.stderr


def test_the_clock_of_a_source_moves_when_a_clause_is_judged(models: Path, tmp_path: Path) -> None:
    """The cube reaches the bin at 7 s, and the behaviour ends at 7.05 s. A clock that is 0.99 s behind changes that."""
    silent = [one for one in drive() if one.topic != "/events"]
    table = tmp_path / "events.csv"
    table.write_text("time,event\n1,pick-start\n3,pick-end\n6,place-start\n7.05,evt-place-end\n", encoding="utf-8")
    found, _ = judged(models, tmp_path, silent, "--events", str(table))
    assert verdicts(found)["at-goal"] == "holds"
    found, _ = judged(models, tmp_path, silent, "--events", str(table), "--clock", "/tf=-0.99")
    assert verdicts(found)["at-goal"] == "violated"
    wrong = robbdd(models, "judge", str(tmp_path / "drive"), "pickplace.bdd", *ONE, "--clock", "/tf=soon")
    assert "'/tf=soon' must be TOPIC=SECONDS, for example /camera/pose=0.12" in wrong.stderr


def twice() -> list[Message]:
    """The robot puts the cube into the bin, and then, 20 s later, beside it."""
    again = drive(end=(0.55, 0.0, 0.825))
    late = [moved_by(one, 20.0) for one in again if one.topic != "/tf_static"]
    return [*drive(), *late]


def moved_by(one: Message, seconds: float) -> Message:
    if one.topic != "/tf":
        return replace(one, received=one.received + seconds)
    (found,) = one.make(ROS2).transforms
    where = found.transform.translation
    return transform(found.child_frame_id, (where.x, where.y, where.z), stamp=one.received + seconds)


def test_a_log_of_two_executions_is_refused_until_one_is_chosen(models: Path, tmp_path: Path) -> None:
    bag = write(tmp_path / "both", twice())
    done = robbdd(models, "judge", str(bag), "pickplace.bdd", "--no-store", *ONE)
    assert done.returncode == 2
    words = "the log reports 'pick-start' again at 21.00 s, after 'place-end' at 8.00 s: it has more than one execution"
    assert f"{words}; choose one with --from SECONDS and --until SECONDS, for example --until 14.5" in done.stderr
    first, _ = judged(models, tmp_path, twice(), "--until", "14.5")
    assert verdicts(first)["at-goal"] == "holds"
    second, _ = judged(models, tmp_path, twice(), "--from", "14.5")
    assert verdicts(second)["at-goal"] == "violated"
    (goal,) = (one for one in second if one["name"].endswith("at-goal"))
    assert goal["at"] == pytest.approx(13.5)
    whole, _ = judged(models, tmp_path, twice(), "--from", "0")
    assert verdicts(whole)["at-goal"] == "holds"


def test_numbers_on_a_topic_report_events(models: Path, tmp_path: Path) -> None:
    def number(value: int, received: float) -> Message:
        def make(store: Any) -> Any:
            return store.types["std_msgs/msg/UInt8"](data=value)

        return Message("/task", received, "std_msgs/msg/UInt8", make)

    states = [number(value, time) for value, time in ((0, 0.5), (1, 1.0), (2, 3.0), (4, 8.0))]
    silent = [one for one in drive() if one.topic != "/events"]
    declared = [
        f"evt-{name}=/task becomes {value}" for name, value in (("pick-start", 1), ("pick-end", 2), ("place-end", 4))
    ]
    more = [word for one in declared for word in ("--event", one)]
    found, _ = judged(models, tmp_path, [*silent, *states], *more)
    assert set(verdicts(found).values()) == {"holds"}, found
    for stated, words in (
        ("evt-pik=/task becomes 1", "the scenario has no event 'evt-pik'; nearest: evt-pick-end, evt-pick-start"),
        ("evt-pick-end=task", "'evt-pick-end=task' declares no event: write EVENT=/topic"),
    ):
        done = robbdd(models, "judge", str(tmp_path / "drive"), "pickplace.bdd", "--no-store", *ONE, "--event", stated)
        assert done.returncode == 2
        assert words in done.stderr


def test_a_goal_is_no_evidence_of_where_a_thing_is(models: Path, tmp_path: Path) -> None:
    """Only the place to which the cube is to be brought is in the log: it lies in the bin from the first second on."""
    without = drive(cube="unknown_thing")
    goal = [pose("/goal/cube0", (0.55, 0.3, 0.86), stamp=0.01 + tick / 10) for tick in range(100)]
    found, remarks = judged(models, tmp_path, [*without, *goal])
    assert verdicts(found)["at-goal"] == "unknown"
    assert "'goal/cube0' may be where env:cube0 is meant to be, not where it is, so it is not used" in remarks
    seen = [pose("/camera/cube0", (0.55, 0.3, 0.86), stamp=0.01 + tick / 10) for tick in range(100)]
    found, remarks = judged(models, tmp_path, [*without, *goal, *seen])
    assert verdicts(found)["at-goal"] == "holds"
    assert "env:cube0 is the frame 'camera/cube0'" in remarks
