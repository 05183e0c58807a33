"""Pictures and replays in a report: of runs that have traces, and of studies whose executions are executed again."""

from __future__ import annotations

import json
import re
import shutil
import struct
from base64 import b64decode
from pathlib import Path
from typing import Any

import pytest

from campaign.test_report import Page
from commands.test_gherkin import robbdd
from kit import EXAMPLES
from robbdd_tools.campaign import report_moments
from robbdd_tools.campaign.report_data import worst
from robbdd_tools.campaign.report_moments import AFTER, BEFORE, Moments
from robbdd_tools.workbench.stored import PastRun, find_run

STUDY = """import "study.bddx"
Study two {
    where: "robot=panda and scale=1.0 and range=normal and bin=left_ws and part=~ball[01]"
    factor bhv <tested>: { timed-pick-place, pick-place }
    repeat: 1
    seed: 1
}
"""


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> Path:
    """A folder with a run of two executions, one of which hits a bin, and with a study of the same ones."""
    request.getfixturevalue("forks")
    folder = shutil.copytree(EXAMPLES / "study", tmp_path_factory.mktemp("bench") / "bench")
    (folder / "two.study").write_text(STUDY, encoding="utf-8")
    where = "robot=panda and scale=1.0 and range=normal and bin=left_ws and part=ball0"
    robbdd("run", "study.bddx", "--where", where, folder=folder)
    robbdd("study", "run", "two.study", folder=folder)
    return folder


def replays(text: str) -> dict[str, Any]:
    found = re.search(r'<script type="application/json" id="moments">(.*?)</script>', text)
    assert found is not None
    return json.loads(found[1])


def numbers(packed: dict[str, Any]) -> tuple[float, ...]:
    data = b64decode(packed["data"])
    return struct.unpack(f"<{len(data) // 4}f", data)


@pytest.mark.physics
def test_the_worst_executions_have_a_picture_and_a_replay_of_the_violation(bench: Path) -> None:
    made = robbdd("report", "latest", "-o", "run.html", folder=bench)
    assert made.returncode == 0, made.stderr
    text = (bench / "run.html").read_text(encoding="utf-8")
    (moment,) = replays(text)["moments"]
    run = find_run("latest", bench)
    clause = next(one for one in run.results[0].clauses if one.verdict == "violated")
    assert moment["at"] == clause.at
    times = numbers(moment["times"])
    assert times[0] >= moment["at"] - BEFORE - 1e-3
    assert times[-1] <= moment["at"] + AFTER + 1e-3
    assert times[-1] - times[0] > 2.0
    count, moving, size = moment["poses"]["shape"]
    assert (count, moving, size) == (len(times), len(moment["moving"]), 7)
    # The poses are those of the trace at these times.
    trace = run.trace(0)
    number, ball = next((i, one["name"]) for i, one in enumerate(moment["bodies"]) if one["name"].endswith(":ball0"))
    column = moment["moving"].index(number)
    shown = numbers(moment["poses"])[7 * column : 7 * column + 3]
    row = min(range(len(trace.times)), key=lambda one: abs(trace.times[one] - times[0]))
    assert shown == pytest.approx(trace.positions[row, trace.column(ball)], abs=1e-3)
    page = Page(text)
    pictures = [attributes for tag, attributes in page.tags if tag == "img"]
    if "there are no pictures" not in made.stderr:
        assert [one["alt"] for one in pictures] == [
            f"{run.results[0].name}: the moment at which bin-untouched is violated at {clause.at:.2f} s"
        ]
    assert page.open == []


@pytest.mark.physics
def test_a_study_is_reported_and_its_worst_executions_are_executed_again(bench: Path) -> None:
    made = robbdd("report", "two.study", "--again", "1", "-o", "study.html", folder=bench)
    assert made.returncode == 0, made.stderr
    text = (bench / "study.html").read_text(encoding="utf-8")
    page = Page(text)
    assert "2 of 4 executions hold" in page.text
    assert len(replays(text)["moments"]) == 1
    assert "the behaviour" in page.text
    again = re.search(r"simulate it again: robbdd study replay two.study (\d+)", page.text)
    assert again is not None
    replayed = robbdd("study", "replay", "two.study", again[1], folder=bench)
    assert "1 of 1 executions have the verdicts and margins of the study" in replayed.stdout

    # Which executions flipped between two levels of a factor, with both replays.
    sides = "two.study:tested=timed-pick-place", "two.study:tested=pick-place"
    compared = robbdd("compare", *sides, "--html", "compared.html", "--again", "1", folder=bench)
    assert compared.returncode == 3, compared.stdout
    assert "2 shared executions, compared in pairs" in compared.stdout
    assert "2 executions with other verdicts:" in compared.stdout
    shown = (bench / "compared.html").read_text(encoding="utf-8")
    before, after = replays(shown)["moments"]
    assert [one["name"].partition(":")[0] for one in (before, after)] == ["before", "after"]
    assert before["at"] == after["at"]
    assert 'data-moments="0,1"' in shown
    assert Page(shown).open == []

    (bench / "study.bddx").write_text((bench / "study.bddx").read_text(encoding="utf-8").replace("tested", "changed"))
    (bench / "two.study").write_text(STUDY.replace("tested", "changed"), encoding="utf-8")
    refused = robbdd("report", "two.study", "--again", "1", "-o", "study.html", folder=bench)
    assert refused.returncode == 2
    assert "the study or one of its models was changed since it began" in refused.stderr
    # The results alone are still there, also by the folder that they are in.
    assert robbdd("report", "two.study", "-o", "study.html", folder=bench).returncode == 0
    stored = robbdd("report", ".robbdd/studies/two.study", "-o", "study.html", folder=bench)
    assert stored.returncode == 0, stored.stderr
    wrong = robbdd("report", ".robbdd/studies/two.study", "--again", "1", "-o", "study.html", folder=bench)
    assert (wrong.returncode, "name its file" in wrong.stderr) == (2, True)


@pytest.mark.physics
def test_a_page_that_is_full_has_no_further_replays(bench: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run = PastRun(find_run("latest", bench).place)
    monkeypatch.setattr(report_moments, "MOST_BYTES", 1000)
    moments = Moments()
    (moment,) = moments.add(run.place, worst(run.results)).values()
    assert (moment.picture, moment.replay, moments.document()) == ("", None, "")
    assert moment.words.startswith("bin-untouched is violated at ")
