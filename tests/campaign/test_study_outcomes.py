"""The outcomes of a study: counts by factors and first violated clauses, margins, and their pictures."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import pytest

from campaign.study_agents import QuickAgent, write_study
from robbdd_tools.campaign.study_outcomes import NoSuchFactor, Row, margins, outcome_table
from robbdd_tools.cli import main
from robbdd_tools.run import scheduler

ARMS = ("cell:panda", "cell:ur10")


def execution(seed: int, arm: str, scale: str, *verdicts: tuple[str, str, float | None]) -> Iterator[Row]:
    """The exported rows of one execution with clauses (name, verdict, margin)."""
    found = {verdict for _, verdict, _ in verdicts}
    whole = next(one for one in ("violated", "unknown", "holds") if one in found)
    for clause, verdict, margin in verdicts:
        levels = {"level.t:var-robot": arm, "level.t:var-scale": scale, "level.t:var-place": "cell:left"}
        place = {"scenario": f"s{arm}{scale}", "execution": "", "repetition": seed, "seed": seed}
        yield {**levels, **place, "scenario_verdict": whole, "clause": clause, "verdict": verdict, "margin": margin,
               "unit": "m"}  # fmt: skip


def study() -> list[Row]:
    """Three executions of the Panda, two of the UR10."""
    held, lost = ("held", "holds", 0.1), ("held", "violated", -0.1)
    inside, outside = ("inside", "holds", 0.2), ("inside", "violated", -0.3)
    return [
        *execution(1, ARMS[0], "0.8", held, inside),
        *execution(2, ARMS[0], "0.8", held, ("inside", "holds", 0.4)),
        *execution(3, ARMS[0], "1.0", lost, outside),
        *execution(4, ARMS[1], "0.8", held, outside),
        *execution(5, ARMS[1], "0.8", held, ("inside", "unknown", None)),
    ]


def test_an_execution_counts_at_its_first_violated_clause() -> None:
    table = outcome_table(study(), ["robot"])
    assert table.rows == (("panda",), ("ur10",))
    assert table.outcomes == ("holds", "held", "inside", "unknown")
    assert table.counts == ((2, 1, 0, 0), (0, 0, 1, 1))


def test_without_names_all_factors_with_several_levels_count() -> None:
    table = outcome_table(study())
    assert table.factors == ("robot", "scale")
    assert dict(zip(table.rows, table.counts, strict=True))["panda", "1.0"] == (0, 1, 0, 0)


def test_margins_are_those_of_executions_that_hold_as_a_whole() -> None:
    found = margins(study(), "inside", "robot")
    assert found.levels == {"panda": [0.2, 0.4]}
    assert margins(study(), "held", "scale").levels == {"0.8": [0.1, 0.1]}


def test_unknown_names_are_refused_with_the_known_ones() -> None:
    with pytest.raises(NoSuchFactor, match="no factor or variable 'arm'; it has robot, scale, place"):
        outcome_table(study(), ["arm"])
    with pytest.raises(NoSuchFactor, match="no clause 'outside'; it has held, inside"):
        margins(study(), "outside", "robot")


@pytest.fixture
def executed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Path:
    monkeypatch.setattr(scheduler, "Agent", QuickAgent)
    monkeypatch.chdir(tmp_path)
    path = write_study(tmp_path).relative_to(tmp_path)
    main(["study", "run", str(path)])
    capsys.readouterr()
    return path


def words(picture: Path) -> set[str]:
    """The texts of an SVG file."""
    elements = ElementTree.fromstring(picture.read_bytes()).iter("{http://www.w3.org/2000/svg}text")
    return {"".join(element.itertext()).strip() for element in elements}


def test_outcomes_are_printed_and_drawn(executed: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", "outcomes", str(executed), "--by", "part", "--plot", "outcomes.svg"]) == 0
    heading, *rows = (line.split() for line in capsys.readouterr().out.splitlines())
    assert heading == ["part", "holds", "on-bench"], "all clauses have one margin here"
    assert sum(int(count) for row in rows for count in row[1:]) == 40
    drawn = words(Path("outcomes.svg"))
    assert {"holds", "on-bench", "part", *(row[0] for row in rows), *(row[1] for row in rows)} <= drawn
    first = Path("outcomes.svg").read_bytes()
    assert main(["study", "outcomes", str(executed), "--by", "part", "--plot", "outcomes.svg"]) == 0
    assert Path("outcomes.svg").read_bytes() == first, "equal results give equal files"


def test_margins_are_printed_and_drawn(executed: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["study", "margins", str(executed), "--clause", "in-tray", "--by", "part"]
    assert main([*arguments, "--plot", "margins.svg"]) == 0
    heading, *rows = capsys.readouterr().out.splitlines()
    assert heading.split()[:3] == ["part", "executions", "0"]
    assert all("+" in row for row in rows)
    assert {"margin of in-tray, m", "part"} <= words(Path("margins.svg"))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["outcomes", "--by", "arm"], "no factor or variable 'arm'"),
        (["margins", "--clause", "x", "--by", "part"], "no clause 'x'"),
        (["outcomes", "--plot", "outcomes.gif"], "'outcomes.gif' must end in one of .svg, .png, .pdf"),
        (["outcomes", "--plot", "nowhere/outcomes.svg"], "nowhere"),
    ],
)
def test_what_cannot_be_shown_is_explained(
    arguments: list[str], message: str, executed: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["study", arguments[0], str(executed), *arguments[1:]]) == 2
    assert message in capsys.readouterr().err
