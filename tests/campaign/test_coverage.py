"""What a campaign has exercised of what it could, and its goals."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from campaign.study_agents import STUDY, QuickAgent, write_study
from campaign.test_report import Page
from robbdd_tools.campaign.coverage import KindCoverage, coverage
from robbdd_tools.campaign.coverage_universe import (
    CoverableClause,
    CoverageUniverse,
    coverage_universe,
    level_of,
    universe_from,
    universe_text,
)
from robbdd_tools.campaign.study_file import load_study
from robbdd_tools.campaign.study_place import study_folder
from robbdd_tools.cli import main
from robbdd_tools.run import scheduler

UNIVERSE = CoverageUniverse(
    (level_of("x", 1), level_of("x", 2), level_of("y", ["a:b"])),
    ((0, 2), (1, 2)),
    (
        CoverableClause("v", "grip", ("start",), ("held-by",)),
        CoverableClause("v", "still", ("start", "end"), ("rest",)),
    ),
)


def row(number: int, x: int, grip: str, still: str) -> list[dict[str, Any]]:
    own = {"level.x": x, "level.y": ["a:b"], "number": number, "variant": "v"}
    return [{**own, "clause": name, "verdict": verdict} for name, verdict in (("grip", grip), ("still", still))]


def counted(*rows: list[dict[str, Any]]) -> dict[str, tuple[int, int]]:
    found = coverage(UNIVERSE, [one for several in rows for one in several], {})
    return {one.kind: (one.exercised, one.total) for one in found}


def test_what_an_execution_has_decided_is_exercised() -> None:
    assert counted(row(1, 1, "holds", "violated")) == {
        "levels": (2, 3),
        "pairs": (1, 2),
        "clauses": (2, 2),
        "events": (2, 2),
        "predicates": (2, 2),
    }


def test_an_unknown_clause_exercises_nothing() -> None:
    open_ = {"clauses": (1, 2), "events": (1, 2), "predicates": (1, 2)}
    assert counted(row(1, 1, "holds", "unknown")) == {"levels": (2, 3), "pairs": (1, 2), **open_}
    nothing = {"levels": (0, 3), "pairs": (0, 2), "clauses": (0, 2), "events": (0, 2), "predicates": (0, 2)}
    assert counted(row(1, 1, "unknown", "unknown")) == nothing
    assert counted(row(1, 1, "holds", "unknown"), row(2, 2, "unknown", "holds"))["pairs"] == (2, 2)


def test_what_is_missing_is_named_and_goals_are_compared() -> None:
    found = coverage(UNIVERSE, row(1, 1, "holds", "unknown"), {"pairs": 50, "clauses": 51})
    missing = {one.kind: one.missing for one in found}
    assert missing["levels"] == ("x = 2",)
    assert missing["pairs"] == ("x = 2, y = {b}",)
    assert missing["clauses"] == ("still",)
    assert [one.kind for one in found if not one.is_met] == ["clauses"]
    assert KindCoverage("pairs", 0, 0, (), 100).is_met


def test_the_universe_is_what_scenarios_and_where_select(tmp_path: Path) -> None:
    def universe(settings: str) -> CoverageUniverse:
        study = load_study(write_study(tmp_path, f'import "m.bdd"\nStudy s {{ {settings} }}'))
        assert study.findings == ()
        return coverage_universe(study)

    whole = universe("")
    # Two parts, one robot, two goals.
    assert (len(whole.levels), len(whole.pairs)) == (5, 2 * 1 + 2 * 2 + 1 * 2)
    assert [(one.name, one.events, one.predicates) for one in whole.clauses] == [
        ("on-bench", ("pick-start",), ("located-at",)),
        ("when-bhv-fetch.when", (), ()),
        ("in-tray", ("place-end",), ("located-at",)),
    ]
    assert universe("first: 1 seed: 3") == whole
    assert universe("pairwise: 2 seed: 3") == whole
    bolt = universe('where: "part=bolt"')
    assert (len(bolt.levels), len(bolt.pairs)) == (4, 5)
    assert universe_from(universe_text(whole)) == whole
    assert universe_from("{}") is None


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(scheduler, "Agent", QuickAgent)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def with_goals(goals: str, settings: str = "") -> str:
    return STUDY.replace("seed: 3", f"seed: 3 {settings} cover: {{ {goals} }}")


def test_goals_decide_the_exit_code_and_can_change_without_executing_again(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = write_study(folder, with_goals("levels 100 %, clauses 100 %", "first: 1"))
    main(["study", "run", str(study)])
    assert "levels: 3 of 5 exercised (60.0 %), goal 100 % not met" in capsys.readouterr().out
    assert main(["study", "status", str(study)]) == 1
    printed = capsys.readouterr().out
    assert "levels: 3 of 5 exercised (60.0 %), goal 100 % not met\nclauses: 3 of 3 exercised" in printed
    assert "pairs" not in printed
    assert main(["study", "show", str(study)]) == 1
    assert "pairs: 3 of 8 exercised (37.5 %)\n  not exercised: " in capsys.readouterr().out
    write_study(folder, with_goals("levels 60 %, clauses 100 %", "first: 1"))
    assert main(["study", "status", str(study)]) == 0
    assert main(["study", "show", str(study)]) == 0


def test_a_whole_study_exercises_everything_and_its_report_says_so(folder: Path) -> None:
    study = write_study(folder, with_goals("levels 100 %, pairs 100 %, clauses 100 %, events 100 %, predicates 100 %"))
    main(["study", "run", str(study)])
    assert main(["study", "status", str(study)]) == 0
    assert main(["report", str(study), "-o", "r.html"]) == 0
    assert main(["report", str(study), "-o", "r.md"]) == 0
    page = Page(Path("r.html").read_text(encoding="utf-8"))
    assert "levels 5 5 100.0 % ✔ 100 % met pairs 8 8 100.0 % ✔ 100 % met" in page.text
    assert page.open == []
    # A study stores no sentences, and all repetitions of a scenario have the same name.
    assert "clause share hold" in page.text
    assert "t:bench-to-tray -- 1 (repetition " in page.text
    assert "<summary>Coverage</summary>" in Path("r.md").read_text(encoding="utf-8")


def test_a_study_of_an_earlier_version_cannot_meet_a_goal(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    study = write_study(folder)
    main(["study", "run", str(study)])
    assert main(["study", "show", str(study)]) == 0
    with closing(sqlite3.connect(study_folder(study) / "study.sqlite")) as connection, connection:
        connection.execute("DELETE FROM fact WHERE name = 'coverable'")
    write_study(folder, with_goals("pairs 10 %"))
    assert main(["study", "status", str(study)]) == 1
    assert "coverage: unknown, as an earlier version" in capsys.readouterr().out
