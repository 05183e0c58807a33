"""``robbdd judge LOG`` of a table that has positions only: what depends on an orientation is unknown, never assumed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from mcap.reader import make_reader

from logs.drives import clauses, robbdd

pytestmark = pytest.mark.physics
SCENE = """ns x = 'https://example.org/upright/'
obj set (ns=x) things { object table, object cube, object bottle }
ws set (ns=x) places { workspace table_ws }
agn set (ns=x) arms { agent panda }
comp (ns=x) on_table of ws <places.table_ws> { obj <things.table> }
scene (ns=x) cell { obj set <things> ws comp <on_table> agn set <arms> }
"""
MODEL = """import "stand.scene"
ns x = 'https://example.org/upright/'
Event (ns=x) begins
Event (ns=x) ends
Scenario Template (ns=x) stay {
    duration: from <begins> until <ends>
    var thing
    var robot
    When:
        Behaviour (ns=x) carry {
            duration: from <begins> until <ends>
            <robot> picks <thing> and places at <places.table_ws>
        }
    Then: (
        there: holds(<thing> is located at <places.table_ws>, after <begins>)
        and upright: holds(<thing> is tilted less than 5 deg, after <begins>)
        and still: holds(<thing> is at rest, after <begins>)
    )
}
User Story (ns=x) standing {
    As A "operator" I Want "things to stand" So That "nothing is spilled"
    Scenarios:
        Scenario stands {
            template: <stay>
            scene: <cell>
            variation:
                var <stay.thing>: { <things.cube>, <things.bottle> }
                var <stay.robot>: agn set <arms>
        }
}
"""
PLACES = "time,frame,x,y,z,qw,qx,qy,qz,event\n0,table,0.6,0,0.1,1,0,0,0,\n5,table,0.6,0,0.1,1,0,0,0,\n"


def judged(folder: Path, thing: str, turn: str) -> tuple[dict[str, tuple[str, str]], str]:
    (folder / "stand.scene").write_text(SCENE, encoding="utf-8")
    (folder / "stand.bdd").write_text(MODEL, encoding="utf-8")
    rows = [f"{tenth / 10},{thing},0.6,0,0.12,{turn}," for tenth in range(51)]
    table = PLACES + "\n".join([*rows, "1,,,,,,,,,begins", "4,,,,,,,,,ends"])
    (folder / "log.csv").write_text(table + "\n", encoding="utf-8")
    out = folder / "out.json"
    options = ("--where", f"thing={thing}", "--max-gap", "9", "--json", str(out))
    done = robbdd(folder, "judge", "log.csv", "stand.bdd", *options)
    assert done.returncode in (0, 1), done.stderr
    found = {one["name"].rpartition(".")[2]: (one["verdict"], one["reason"]) for one in clauses(out)}
    del found["when"]
    return found, done.stderr


def test_a_clause_about_the_orientation_of_a_thing_is_unknown_and_its_place_is_judged(tmp_path: Path) -> None:
    found, remarks = judged(tmp_path, "cube", ",,,")
    unknown = ("unknown", "the log does not say how x:cube is turned")
    assert found == {"there": ("holds", ""), "upright": unknown, "still": unknown}
    assert "the table has no orientation of 'cube': clauses that depend on it are unknown" in remarks
    with_turn, _ = judged(tmp_path, "cube", "1,0,0,0")
    assert {name: verdict for name, (verdict, _) in with_turn.items()} == dict.fromkeys(found, "holds")


def test_the_centre_of_a_thing_away_from_its_frame_is_unknown_with_the_distance(tmp_path: Path) -> None:
    found, remarks = judged(tmp_path, "bottle", ",,,")
    assert {verdict for verdict, _ in found.values()} == {"unknown"}
    assert "the log does not say how x:bottle, whose centre is" in remarks
    assert "from its frame, is turned: its place is unknown" in remarks


def test_a_thing_without_orientation_is_drawn_upright(tmp_path: Path) -> None:
    judged(tmp_path, "cube", ",,,")
    (stored,) = (tmp_path / ".robbdd").rglob("*.mcap")
    with stored.open("rb") as file:
        drawn = [json.loads(message.data) for _, _, message in make_reader(file).iter_messages(["/tf"])]
    turns = [one["rotation"] for view in drawn for one in view["transforms"] if "cube" in one["child_frame_id"]]
    assert turns
    assert all(turn == {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0} for turn in turns)
