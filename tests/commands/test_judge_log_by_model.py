"""``robbdd judge LOG``: executions say how a log is observed, and scene instances where things stand."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from kit import EXAMPLES
from logs.bags import text, transform, truth, write
from logs.drives import ONE, clauses, drive, robbdd

pytestmark = pytest.mark.physics
ROBOT = """import "pickplace.bdd"
import "bench.scenex"
ns exec = 'https://example.org/robbdd/execution/'
bhv impl (ns=exec) server { bhv action: "/pick" }
obs provider (ns=exec) camera { ros transform listener reference-frame: "map" update-rate: 30 Hz }
observation (ns=exec) things {
    provider: <camera>
    observes var <pick-place.thing>
    observes var <pick-place.goal>
    entity mapper: string { "object_7" to obj <cubes.cube0> }
}
obs policy (ns=exec) near-goal for <pick-place.at-goal> {
    observations: { <things> }
    evaluator: linear distance { less-than: 0.2 m }
}
obs policy (ns=exec) starts for <pick-place.at-source> { trinary topic: "/seen" }
Scenario Exec (ns=exec) on-the-robot {
    variant: <tidy-bench.part-to-bin>
    scene inst: <bench_sim>
    bhv: <server>
    policies: { <near-goal>, <starts> }
}
"""


@pytest.mark.parametrize(
    ("seen", "verdict", "reason"),
    [
        ([(0.0, 1)], "holds", ""),
        ([(0.0, 1), (0.9, 0)], "violated", ""),
        ([(0.0, 1), (0.9, 2)], "unknown", "the topic '/seen' reports nothing known at 1.00 s"),
        ([(2.0, 1)], "unknown", "the topic '/seen' reports nothing known at 1.00 s"),
        ([], "unknown", "its verdicts come from the ROS topic '/seen', which the log does not have"),
    ],
)
def test_the_observations_and_topics_of_an_execution_decide(
    seen: list[tuple[float, int]], verdict: str, reason: str, tmp_path: Path
) -> None:
    folder = shutil.copytree(EXAMPLES / "pickplace", tmp_path / "models")
    (folder / "robot.bddx").write_text(ROBOT, encoding="utf-8")
    bag = write(tmp_path / "drive", [*drive(cube="object_7"), *(truth("/seen", value, time) for time, value in seen)])
    out = tmp_path / "log.json"
    done = robbdd(folder, "judge", str(bag), "robot.bddx", "--no-store", "--json", str(out), *ONE)
    assert done.returncode in (0, 1), done.stderr
    found = {one["name"].rpartition(".")[2]: one for one in clauses(out)}
    assert (found["at-source"]["verdict"], found["at-source"]["reason"]) == (verdict, reason)
    assert found["at-goal"]["verdict"] == "holds"
    # The bin's region is 0.06 m above its origin.
    assert 0.1 < found["at-goal"]["robustness"] < 0.2


@pytest.mark.parametrize(
    ("root", "more", "verdict"),
    [("map", (), "holds"), ("camera", (), "unknown"), ("camera", ("--world", "camera"), "holds")],
)
def test_a_scenex_places_what_the_log_lacks_if_the_frame_is_the_worlds(
    root: str, more: tuple[str, ...], verdict: str, tmp_path: Path
) -> None:
    folder = shutil.copytree(EXAMPLES / "ownrobot", tmp_path / "models")
    # The bin stands at (0.4, 0.5, 0.1) m.
    seen = [transform("cube0", (0.4, 0.5, 0.14), stamp=tick / 10, parent=root) for tick in range(101)]
    bag = write(tmp_path / "drive", [*seen, text("place-end", 5.0)])
    out = tmp_path / "log.json"
    chosen = ("--scenario", "by-catalog", "--where", "thing=cube0")
    done = robbdd(folder, "judge", str(bag), "tidy.bddx", "--no-store", "--json", str(out), *chosen, *more)
    assert done.returncode in (0, 1), done.stderr
    found = {one["name"].rpartition(".")[2]: one for one in clauses(out)}
    assert found["at-goal"]["verdict"] == verdict, (found["at-goal"], done.stderr)
    placed = "is not in the log, so it stands where the .scenex places it"
    asked = "is not in the log, and the .scenex places it in the world: name the frame of the world with --world FRAME"
    assert f"env:bin {placed if verdict == 'holds' else asked}" in done.stderr
    assert "the log has no frame for env:cube0" not in done.stderr


HALL = """ns h = 'https://example.org/h/'
obj set (ns=h) things { object cube0, object dock_table, object shelf_table }
ws set (ns=h) places { workspace dock_ws, workspace shelf_ws }
agn set (ns=h) arms { agent panda }
comp (ns=h) dock of ws <places.dock_ws> { obj <things.dock_table> }
comp (ns=h) shelf of ws <places.shelf_ws> { obj <things.shelf_table> }
scene (ns=h) hall { obj set <things> ws comp <dock> ws comp <shelf> agn set <arms> }
"""
LIFT = """import "hall.scene"
ns c = 'https://example.org/c/'
Task (ns=c) task
Event (ns=c) begin
Event (ns=c) end
Event (ns=c) start
Event (ns=c) done
Scenario Template (ns=c) lift {
    duration: from <begin> until <end>
    task: <task>
    var thing
    When: Behaviour (ns=c) take { duration: from <start> until <done>  <arms.panda> picks <thing> }
    Then: at-dock: holds(<thing> is located at <places.dock_ws>, before <start>)
}
User Story (ns=c) lifting {
    As A "x"  I Want "y"  So That "z"
    Scenarios: Scenario one { template: <lift> scene: <hall> variation: var <lift.thing>: { <things.cube0> } }
}
"""


def test_a_missing_carrier_of_another_workspace_is_named(tmp_path: Path) -> None:
    """Whether a thing is at the dock depends on the shelf, which could be inside it, although no clause is about it."""
    (tmp_path / "hall.scene").write_text(HALL, encoding="utf-8")
    (tmp_path / "lift.bdd").write_text(LIFT, encoding="utf-8")
    rows = [f"{t},{name},0,0,{z}," for t in (0, 0.4, 0.8) for name, z in (("cube0", 0.1), ("dock_table", 0))]
    table = "\n".join(["time,frame,x,y,z,event", *rows, "0.8,,,,,pick-start"])
    (tmp_path / "log.csv").write_text(table + "\n", encoding="utf-8")
    done = robbdd(tmp_path, "judge", "log.csv", "lift.bdd", "--no-store")
    assert "the trace has no record of 'shelf_table'" in done.stdout
    assert "the log has no frame for h:shelf_table; " in done.stderr
    assert "name it with --frame shelf_table=FRAME" in done.stderr
