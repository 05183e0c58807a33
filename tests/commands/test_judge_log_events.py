"""``robbdd judge LOG``: which messages of a log report an event."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest

from kit import EXAMPLES
from logs.bags import text
from logs.drives import drive, judged, verdicts

pytestmark = pytest.mark.physics


@pytest.fixture
def models(tmp_path: Path) -> Path:
    return shutil.copytree(EXAMPLES / "pickplace", tmp_path / "models")


def named(found: list[dict[str, Any]], name: str) -> dict[str, Any]:
    (clause,) = (one for one in found if one["name"].rpartition(".")[2] == name)
    return clause


def edit(models: Path, old: str, new: str) -> None:
    path = models / "pickplace.bdd"
    model = path.read_text(encoding="utf-8")
    assert old in model
    path.write_text(model.replace(old, new), encoding="utf-8")


def test_a_declared_signal_takes_the_place_of_texts(models: Path, tmp_path: Path) -> None:
    """The cube is at its goal from 7 s on; the text says 8 s, the declared signal 5 s."""
    messages = [*drive(), text("DONE", 5.0, "/state")]
    by_text, _ = judged(models, tmp_path, messages)
    assert named(by_text, "at-goal")["verdict"] == "holds"
    by_signal, _ = judged(models, tmp_path, messages, "--event", "evt-place-end=/state is DONE")
    assert named(by_signal, "at-goal")["verdict"] == "violated"
    never, _ = judged(models, tmp_path, messages, "--event", "evt-place-end=/state is GONE")
    assert named(never, "at-goal")["verdict"] == "unknown"


def test_an_event_on_several_topics_is_remarked(models: Path, tmp_path: Path) -> None:
    _, remarks = judged(models, tmp_path, [*drive(), text("place_end", 9.0, "/station2/state")])
    assert "crit:evt-place-end is reported on '/events' and '/station2/state': --event 'evt-place-end=" in remarks
    _, remarks = judged(models, tmp_path, [*drive(), text("place_end", 9.0)])
    assert "is reported on" not in remarks


def test_the_end_of_the_log_does_not_count_if_a_signal_is_declared_for_the_end(models: Path, tmp_path: Path) -> None:
    edit(models, "until <evt-place-end>)\n        )", "until <evt-end>)\n        )")
    messages = [*drive(), text("no", 5.0, "/state")]
    _, remarks = judged(models, tmp_path, messages)
    assert "the log does not report crit:evt-end: the end of the log counts" in remarks
    found, remarks = judged(models, tmp_path, messages, "--event", "evt-end=/state is over")
    assert "the log does not report crit:evt-end by its signal: when it was is not known" in remarks
    assert named(found, "goal-untouched")["verdict"] == "unknown"


def test_a_log_reports_an_event_that_nothing_in_the_scenario_emits(models: Path, tmp_path: Path) -> None:
    edit(models, "Event (ns=crit) evt-end\n", "Event (ns=crit) evt-end\nEvent (ns=crit) inspected\n")
    edit(models, "at <goal>, after <evt-place-end>", "at <goal>, after <inspected>")
    found, _ = judged(models, tmp_path, [*drive(), text("inspected", 9.0)])
    assert verdicts(found)["at-goal"] == "holds"
    found, _ = judged(models, tmp_path, [*drive(), text("ok", 9.0, "/check")], "--event", "inspected=/check is ok")
    assert verdicts(found)["at-goal"] == "holds"
    found, _ = judged(models, tmp_path, drive())
    assert named(found, "at-goal")["reason"] == "event crit:inspected never occurred"


def test_one_of_several_behaviours_is_reported_by_its_own_event(models: Path, tmp_path: Path) -> None:
    edit(
        models,
        "        Behaviour (ns=crit) carry {\n            duration: from <evt-pick-start> until <evt-place-end>\n"
        "            <robot> picks <thing> and places at <goal>\n        }\n",
        "        Behaviour (ns=crit) take {\n            duration: from <evt-pick-start> until <evt-pick-end>\n"
        "            <robot> picks <thing>\n        }\n"
        "        then Behaviour (ns=crit) put {\n            duration: from <evt-start> until <evt-place-end>\n"
        "            <robot> places <thing> at <goal>\n        }\n",
    )
    messages = [one for one in drive() if one.topic != "/events"]
    messages += [text("pick-start", 1.0), text("pick-end", 3.0), text("place-end", 8.0)]
    found, _ = judged(models, tmp_path, messages)
    assert set(verdicts(found).values()) == {"holds"}, found


def test_observations_that_are_not_judged_are_remarked(models: Path, tmp_path: Path) -> None:
    words = (
        "poses were recorded up to 50 times a second, and at most 20 of these are judged: shorter peaks are not seen"
    )
    assert f"{words}; --rate 50 judges all" in judged(models, tmp_path, drive(), "--rate", "20")[1]
    assert words not in judged(models, tmp_path, drive(), "--rate", "50")[1]


def test_a_hole_in_a_recording_is_remarked_even_if_it_is_interpolated(models: Path, tmp_path: Path) -> None:
    words = "the frame 'cube0' is recorded every 20 ms, but not for 0.40 s from 4.00 s on"
    assert words in judged(models, tmp_path, drive(lost=(4.0, 4.4)))[1]
    assert "is recorded every" not in judged(models, tmp_path, drive(lost=(4.0, 4.1)))[1]
    assert "is recorded every" not in judged(models, tmp_path, drive(lost=(4.0, 6.0)))[1]
