"""Ranges of a study: the points of designs, what a study executes at them, and errors at their places."""

from __future__ import annotations

import csv
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from campaign.study_agents import QuickAgent, write_study
from kit import MODEL
from robbdd_tools.base.document import Span
from robbdd_tools.campaign.designs import design_points
from robbdd_tools.campaign.study_batches import batches
from robbdd_tools.campaign.study_file import Study, load_study
from robbdd_tools.campaign.value_bins import Bins, bins_of
from robbdd_tools.cli import main
from robbdd_tools.run import scheduler
from robbdd_tools.syntax.study_content import DESIGNS, Design, Range, Word

HERE = Span(0, 0)
VARIED = (
    MODEL.replace("    var goal\n", "    var goal\n    var drop\n    var rubs\n")
    .replace(
        "on-bench: holds(<part> is located at <goal>, before <pick-start>)",
        "(\n        on-bench: holds(<part> is located at <goal>, before <pick-start>)\n        and\n"
        "        dropped: holds(<robot> has config travel_height = <drop>, before <pick-start>)\n        and\n"
        "        rough: holds(<part> has config friction = <rubs>, before <pick-start>)\n        )",
    )
    .replace(
        "var <fetch.goal>:",
        "var <fetch.drop>: { 0.2, 0.3 }\n                var <fetch.rubs>: { 1, 2 }\nvar <fetch.goal>:",
    )
)
"""Two parts and two goals; the height and the friction have two values each."""
HEAD = 'import "m.bdd"\nStudy s {\n'
RANGES = "factor var <drop>: from 0.2 m to 0.4 m factor var <fetch.rubs>: from 0.5 to 1"


def ranges(*bounds: tuple[float, float]) -> list[Range]:
    return [Range(Word(f"v{place}", HERE), *one, "", HERE) for place, one in enumerate(bounds)]


def loaded(folder: Path, settings: str) -> Study:
    study = load_study(write_study(folder, f"{HEAD}{settings}\n}}\n", VARIED))
    assert [one.message for one in study.findings] == []
    return study


def values(study: Study) -> list[tuple[Any, ...]]:
    return [tuple(spec.values.values()) for spec in study.cells[0].plan.specs()]


def test_a_latin_hypercube_has_one_point_in_each_part_of_each_range() -> None:
    rows = design_points(Design("latin-hypercube", 20, HERE), ranges((0.7, 1.0), (-5, 5)), 3).rows
    assert sorted(int((row[0] - 0.7) / 0.3 * 20) for row in rows) == list(range(20))
    assert sorted(int((row[1] + 5) / 10 * 20) for row in rows) == list(range(20))


def test_a_sobol_design_is_balanced_in_each_plane() -> None:
    rows = design_points(Design("sobol", 64, HERE), ranges((0, 1), (0, 1), (0, 1)), 3).rows
    for one, other in ((0, 1), (0, 2), (1, 2)):
        quarters = sorted((row[one] >= 0.5, row[other] >= 0.5) for row in rows)
        assert [quarters.count(part) for part in dict.fromkeys(quarters)] == [16] * 4


def test_a_grid_has_equally_distant_levels_with_both_bounds() -> None:
    assert design_points(Design("grid", 4, HERE), ranges((0.2, 0.5)), 3).levels == ((0.2, 0.3, 0.4, 0.5),)


@pytest.mark.parametrize("kind", DESIGNS)
def test_the_seed_determines_the_points(kind: str) -> None:
    first, again, other = (design_points(Design(kind, 8, HERE), ranges((0, 1e-3), (1, 2)), seed) for seed in (1, 1, 2))
    assert first == again
    assert (first == other) is (kind == "grid")


def test_points_replace_the_values_of_the_model_in_each_scenario(tmp_path: Path) -> None:
    study = loaded(tmp_path, f"{RANGES} design: sobol 8 repeat: 3")
    found = values(study)
    points = [(row[2], row[3]) for row in found]
    assert len(found) == len(set(found)) == 8 * len({(row[0], row[4]) for row in found})
    assert set(points[:8]) == set(points)
    assert all(0.2 <= first <= 0.4 and 0.5 <= second <= 1 for first, second in points)
    assert sum(batch.size for batch in batches(study)) == 3 * len(found)
    seeds = [spec.seed for spec in study.cells[0].plan.specs(repeat=3)]
    assert len(set(seeds)) == len(seeds)


QUANTITIES = (
    VARIED.replace("var <fetch.drop>: { 0.2, 0.3 }", "var <fetch.drop>: { 20 cm, 0.3 m }")
    .replace("<robot> has config travel_height = <drop>", "<robot> moves slower than 1 m/s")
    .replace(
        "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)",
        "apart: holds(<part> is nearer than <drop> to <robot>, from <pick-start> until <place-end>)",
    )
)


@pytest.mark.parametrize("design", ["latin-hypercube 12", "grid 12"])
def test_quantities_stay_quantities_in_the_unit_of_the_range(tmp_path: Path, design: str) -> None:
    settings = f"factor var <drop>: from 15 cm to 30 cm design: {design}"
    study = load_study(write_study(tmp_path, f"{HEAD}{settings}\n}}\n", QUANTITIES))
    assert [one.message for one in study.findings] == []
    drops = {row[2] for row in values(study)}
    assert all(15 <= float(one.removesuffix(" cm")) <= 30 for one in drops)
    assert (len(drops), {bins.unit for bins in bins_of([{"a": one} for one in drops]).values()}) == (12, {"cm"})
    for wrong in ("from 0.15 to 0.3", "from 1 N to 2 N"):
        text = f"{HEAD}factor var <drop>: {wrong} design: {design}\n}}\n"
        (found,) = load_study(write_study(tmp_path, text, QUANTITIES)).findings
        assert found.message == "the values of 'drop' are quantities: write both bounds with a unit, m or cm or mm"


def test_a_variable_without_a_range_keeps_its_values(tmp_path: Path) -> None:
    found = values(loaded(tmp_path, "factor var <drop>: from 0.2 to 0.4 design: latin-hypercube 3"))
    assert {row[3] for row in found} == {1, 2}
    assert len({row[2] for row in found}) == 3
    assert len(found) == 3 * len({(row[0], row[3], row[4]) for row in found})


def test_a_grid_can_be_covered_in_pairs(tmp_path: Path) -> None:
    whole = values(loaded(tmp_path, f"{RANGES} design: grid 5"))
    assert len(whole) == 25 * len({(row[0], row[4]) for row in whole})
    covered = values(loaded(tmp_path, f"{RANGES} design: grid 5 pairwise: 2"))
    assert len(covered) < len(whole) / 2
    assert len({(row[2], row[3]) for row in covered}) == 25


def test_points_can_be_selected_by_their_values(tmp_path: Path) -> None:
    drops = {row[2] for row in values(loaded(tmp_path, f"{RANGES} design: sobol 16"))}
    found = values(loaded(tmp_path, f'{RANGES} design: sobol 16 where: "drop<0.3"'))
    assert {row[2] for row in found} == {drop for drop in drops if drop < 0.3} != drops


def test_the_points_belong_to_what_defines_the_executions(tmp_path: Path) -> None:
    digests = {
        loaded(tmp_path, text).digest
        for text in (
            f"{RANGES} design: sobol 8",
            f"{RANGES} design: sobol 16",
            f"{RANGES} design: latin-hypercube 8",
            f"{RANGES} design: sobol 8".replace("0.4 m", "0.5 m"),
        )
    }
    assert len(digests) == 4


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ("factor var <drop>: from 0.2 to 0.3", "3:20 a range needs a design: write 'design: latin-hypercube 20'"),
        ("design: sobol 8", "3:9 a design needs a range: write 'factor var <NAME>: from 0.1 to 0.5'"),
        ("design: sobol 12", "3:15 a Sobol design has a power of two of points: write 8 or 16"),
        ("design: grid 1", "3:14 expected a whole number from 2 to 100000, not 1"),
        ("design: random 8", "3:9 a design is latin-hypercube, sobol, grid"),
        ("factor var <drop>: from 0.3 to 0.2", "3:20 a range goes from its lower to its upper bound, not from 0.3"),
        ("factor var <drop>: from 0.2 m to 0.3", "3:20 both bounds have one unit: write 'm' after both of them"),
        ("factor var <drop>: from 0.2 repeat: 3", "3:29 expected 'to', not 'repeat'"),
        ("factor var <drop>: { 0.2 }", "3:20 expected 'from', not '{'"),
        ("D factor var <dorp>: from 1 to 2", "3:32 there is no variable 'dorp'; the scenarios have part, robot, drop,"),
        ("D factor var <part>: from 1 to 2", "3:32 the values of 'part' are not numbers: the model gives it env:bolt"),
        ("D factor var <drop>: from 0.2 to 30", "3:40 'travel_height' cannot be '30': it must be a number from"),
        ("D factor var <drop>: from 2 mm to 3 mm", "3:40 the values of 'drop' are in m: write the bounds in m"),
        ("D factor var <rubs>: from 0.5 m to 1 m", "3:40 the values of 'rubs' have no unit: write none"),
        (f"D sample: 2 {RANGES}", "3:21 'sample' would take points out of the design"),
        ("D factor var <drop>: from 0.2 to 0.3 factor var <fetch.drop>: from 0.2 to 0.3", "3:67 'fetch.drop' is the"),
        ("factor var <drop>: from 0.2 to 0.3 factor var <drop>: from 0.2 to 0.3", "3:47 this variable has a range"),
        (f"design: grid 400 {RANGES}", "3:9 400 levels of 2 ranges are more than 100,000 points: take fewer levels"),
    ],
)  # fmt: skip
def test_an_error_is_reported_at_its_place(tmp_path: Path, settings: str, expected: str) -> None:
    text = settings.replace("D ", "design: sobol 8 ".ljust(20), 1) if settings.startswith("D ") else settings
    study = load_study(write_study(tmp_path, f"{HEAD}{text}\n}}\n", VARIED))
    (found,) = study.findings
    assert f"{found.place.line}:{found.place.column} {found.message}".startswith(expected)


def test_an_executed_study_records_the_values_of_each_execution(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(scheduler, "Agent", QuickAgent)
    monkeypatch.chdir(tmp_path)
    study = write_study(tmp_path, f"{HEAD}{RANGES} design: sobol 16 repeat: 2 batch: 40\n}}\n", VARIED)
    assert main(["study", "run", str(study)]) == 1
    shown = [line.strip() for line in capsys.readouterr().out.splitlines()]
    groups = [line.partition(":")[0] for line in shown if line.startswith("drop ")]
    assert len(groups) == 4
    assert groups == sorted(groups)
    assert main(["study", "export", str(study), "-o", "x.csv"]) == 0
    rows = list(csv.DictReader(Path("x.csv").read_text(encoding="utf-8").splitlines()))
    planned = {
        (spec.seed, str(list(spec.values.values())[2])) for spec in load_study(study).cells[0].plan.specs(repeat=2)
    }
    assert {(int(row["seed"]), row["level.t:var-drop"]) for row in rows} == planned
    assert main(["study", "outcomes", str(study), "--by", "drop"]) == 0
    bounds = [line.split("  ")[0] for line in capsys.readouterr().out.splitlines()[1:]]
    assert [f"drop {one}" for one in bounds] == groups


def test_many_numbers_are_grouped_and_few_are_not() -> None:
    many = [{"a": number / 10, "b": number % 3, "c": str(number)} for number in range(12)]
    assert bins_of(many) == {"a": Bins(0.0, 1.1)}
    words = [Bins(0.0, 1.1).word(number / 10) for number in range(12)]
    assert [words.count(word) for word in dict.fromkeys(words)] == [3, 3, 3, 3]
    assert all(float(one.split()[0]) <= float(other.split()[0]) for one, other in pairwise(words))
