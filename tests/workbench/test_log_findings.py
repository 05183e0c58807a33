"""What a log does not contain is reported where the ``.bddx`` names it."""

from __future__ import annotations

from pathlib import Path

import pytest

from logs.named_drive import cell, named, opened
from robbdd_tools.logs.summary_cache import known_summary
from robbdd_tools.workbench.log_findings import log_findings


def found(path: Path) -> list[tuple[str, str]]:
    """Return the marked text and the message of each finding."""
    snapshot, uri = opened(path)
    text = snapshot.document(uri).text
    return [(text[one.span.start : one.span.end], one.message) for one in log_findings(snapshot, uri)]


@pytest.mark.parametrize(
    ("entries", "marked", "message"),
    [
        (
            'frames: { "cube_0" to obj <cubes.cube0> }',
            '"cube_0"',
            "the log has no frame 'cube_0'; nearest: cube0",
        ),
        (
            'base frames: { "link9" to agn <arms.panda> }',
            '"link9"',
            "the log has no frame 'link9'; it has: bin_left, bin_right, cube0, map, panda, table",
        ),
        ('world frame: "maps"', '"maps"', "the log has no frame 'maps'; nearest: map"),
        (
            'joint topics: { "/js" to agn <arms.panda> }',
            '"/js"',
            "the log has no topic of joint states '/js': it has none",
        ),
        (
            'events: { <evt-pick-end> when "/event is x" }',
            '"/event is x"',
            "the log has no topic '/event'; nearest: /events",
        ),
        (
            'events: { <evt-pick-end> when "/events.date is x" }',
            '"/events.date is x"',
            "the log has no field of /events 'date'; nearest: data",
        ),
        (
            'grips: { <arms.panda> while "/panda/hold" }',
            '"/panda/hold"',
            "the log has no topic '/panda/hold'; nearest: /panda/holds",
        ),
        (
            'grips: { <arms.panda> while "joint finger above 5 mm" }',
            '"joint finger above 5 mm"',
            "the log has no joint 'finger': it has none",
        ),
        (
            "uncertainty: { 3 kg }",
            "3 kg",
            "'3 kg' is no largest error of a measurement: write a length, an angle or a speed, such as '3 mm'",
        ),
        (
            "uncertainty: { 2 deg of obj <cubes.cube0> }",
            "2 deg",
            "'2 deg' is no largest error of a measurement: write a length, such as '3 mm'",
        ),
    ],
)
def test_a_name_that_the_log_lacks_is_reported_at_its_place(
    entries: str, marked: str, message: str, tmp_path: Path
) -> None:
    assert found(cell(tmp_path, named(entries))) == [(marked, message)]


def test_a_log_with_all_names_has_no_finding(tmp_path: Path) -> None:
    assert found(cell(tmp_path, named('frames: { "cube0" to obj <cubes.cube0> } world frame: "map"'))) == []


def test_a_fix_writes_a_similar_name_and_keeps_the_condition(tmp_path: Path) -> None:
    path = cell(tmp_path, named('events: { <evt-pick-end> when "/event becomes x" }'))
    snapshot, uri = opened(path)
    (one,) = log_findings(snapshot, uri)
    (fix,) = one.fixes
    assert (fix.title, fix.edits[0].text) == ("Change to '/events'", '"/events becomes x"')


@pytest.mark.parametrize(
    ("where", "words"),
    [("", "a log is of one execution, but 4 scenarios fit: state the values that the robot executed")],
)
def test_a_log_of_several_scenarios_is_reported_at_the_execution(where: str, words: str, tmp_path: Path) -> None:
    ((marked, message),) = found(cell(tmp_path, named(where=where)))
    assert marked == "monday"
    assert message.startswith(words)


def test_things_and_events_that_the_log_lacks_are_reported_at_the_execution(tmp_path: Path) -> None:
    path = cell(tmp_path, named(), cube="object_7")
    model = path.with_name("pickplace.bdd")
    model.write_text(
        model.read_text(encoding="utf-8")
        .replace("Event (ns=crit) evt-end\n", "Event (ns=crit) evt-end\nEvent (ns=crit) evt-inspected\n")
        .replace("after <evt-pick-end>)", "after <evt-inspected>)"),
        encoding="utf-8",
    )
    messages = [message for _, message in found(path)]
    assert messages[0].startswith("the log has no frame for env:cube0")
    assert messages[0].endswith("write frames: { \"FRAME\" to obj <cube0> } in 'robot log monday'")


def test_a_missing_log_is_reported_at_its_path(tmp_path: Path) -> None:
    ((marked, message),) = found(cell(tmp_path, named(path="sunday")))
    assert marked == '"sunday"'
    assert message.startswith(f"there is no log at {tmp_path}")


def test_names_are_read_again_when_the_log_has_changed(tmp_path: Path) -> None:
    path = cell(tmp_path, named('frames: { "cube0" to obj <cubes.cube0> }', path="drive.csv"))
    table = path.with_name("drive.csv")
    table.write_text("time,frame,x,y,z,event\n0,cube1,0,0,0,\n1,cube1,0,0,0,\n", encoding="utf-8")
    assert ('"cube0"', "the log has no frame 'cube0'; nearest: cube1") in found(path)
    assert known_summary(table) is not None
    table.write_text("time,frame,x,y,z,event\n0,cube0,0,0,0,\n1.5,cube0,0,0,0,\n", encoding="utf-8")
    assert known_summary(table) is None
    assert '"cube0"' not in [marked for marked, _ in found(path)]
    summary = known_summary(table)
    assert summary is not None
    assert (summary.end, summary.frames["cube0"].rate) == (1.5, pytest.approx(1 / 1.5))
