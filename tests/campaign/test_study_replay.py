"""Executions of a study that are executed again: the same scenarios, seeds and values, and a comparison of verdicts."""

from __future__ import annotations

import csv
import shutil
from collections.abc import Mapping
from pathlib import Path

import pytest

from campaign import study_agents
from campaign.study_agents import QuickAgent, write_study
from robbdd_tools.campaign.study_place import study_folder
from robbdd_tools.cli import main
from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.run import scheduler

EXAMPLE = Path(__file__).parents[2] / "examples" / "study"


@pytest.fixture(autouse=True)
def quick(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scheduler, "Agent", QuickAgent)
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def study(tmp_path: Path) -> Path:
    path = write_study(tmp_path).relative_to(tmp_path)
    assert main(["study", "run", str(path)]) == 1
    return path


def executions(path: Path) -> Mapping[int, dict[str, str]]:
    """Return the first exported row of each execution by its number."""
    assert main(["study", "export", str(path), "-o", "x.csv"]) == 0
    rows = list(csv.DictReader(Path("x.csv").read_text(encoding="utf-8").splitlines()))
    return {int(row["number"]): row for row in reversed(rows)}


def replayed(path: Path, number: int = 1) -> list[ScenarioSpec]:
    return list(read_manifest(study_folder(path) / "runs" / str(number)).scenarios)


def test_executions_are_replayed_by_number(study: Path, capsys: pytest.CaptureFixture[str]) -> None:
    known = executions(study)
    assert list(known) == [*reversed(range(1, 41))]
    assert main(["study", "replay", str(study), "17", "3"]) == 0
    printed = capsys.readouterr()
    assert "2 of 2 executions have the verdicts and margins of the study" in printed.out
    assert f"kept in {study_folder(study) / 'runs' / '1'}, with traces" in printed.err
    assert {spec.seed for spec in replayed(study)} == {int(known[number]["seed"]) for number in (3, 17)}
    main(["study", "status", str(study)])
    assert capsys.readouterr().out.startswith("fetching: 40 of 40 executions, not in progress")


def test_failures_are_replayed(study: Path, capsys: pytest.CaptureFixture[str]) -> None:
    failing = sorted(int(row["seed"]) for row in executions(study).values() if row["scenario_verdict"] != "holds")
    assert main(["study", "replay", str(study), "--failures"]) == 0
    assert sorted(spec.seed for spec in replayed(study)) == failing
    assert main(["study", "replay", str(study), "--clause", "in-tray", "--first", "2"]) == 0
    assert len(replayed(study, 2)) == 2
    assert {spec.seed for spec in replayed(study, 2)} < set(failing)
    capsys.readouterr()


def test_other_verdicts_are_reported(
    study: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    known = executions(study)
    failed = next(number for number, row in sorted(known.items()) if row["scenario_verdict"] == "violated")
    held = next(number for number, row in sorted(known.items()) if row["scenario_verdict"] == "holds")

    def other(_: ScenarioSpec) -> float:
        return 0.25

    monkeypatch.setattr(study_agents, "margin", other)
    assert main(["study", "replay", str(study), str(failed), str(held)]) == 1
    printed = capsys.readouterr().out
    assert f"execution {failed} differs from the study: on-bench was violated, and is holds" in printed
    assert f"execution {held} differs from the study: the margin of on-bench was " in printed


def test_a_changed_study_is_replayed_only_on_request(study: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = Path("m.bdd").read_text(encoding="utf-8")
    Path("m.bdd").write_text(text.replace("0.5 seconds after", "0.6 seconds after"), encoding="utf-8")
    assert main(["study", "replay", str(study), "1"]) == 2
    assert "was changed since it began: undo that, or execute the changed files with --force" in capsys.readouterr().err
    assert main(["study", "replay", str(study), "1", "--force"]) == 0


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([], "name executions by their numbers in the export"),
        (["41"], "41 is not the number of a stored execution"),
        (["--clause", "nothing"], "there is no clause 'nothing'; the study has on-bench, "),
    ],
)
def test_a_wrong_choice_is_explained(
    study: Path, capsys: pytest.CaptureFixture[str], words: list[str], message: str
) -> None:
    assert main(["study", "replay", str(study), *words]) == 2
    assert message in capsys.readouterr().err
    assert not (study_folder(study) / "runs").exists()


def test_a_point_of_a_range_is_replayed_with_its_values(tmp_path: Path) -> None:
    for name in ("bench.scene", "bench.scenex", "sensitivity.bdd", "sensitivity.bddx", "study.bdd"):
        shutil.copy(EXAMPLE / name, tmp_path)
    text = (EXAMPLE / "ranges.study").read_text(encoding="utf-8")
    Path("robbdd.toml").touch()
    Path("ranges.study").write_text(text.replace("latin-hypercube 64", "latin-hypercube 8"), encoding="utf-8")
    main(["study", "run", "ranges.study"])
    known = executions(Path("ranges.study"))
    assert main(["study", "replay", "ranges.study", "5"]) == 0
    (spec,) = replayed(Path("ranges.study"))
    assert spec.seed == int(known[5]["seed"])
    values = {f"level.{name}": str(value) for name, value in spec.values.items()}
    assert values == {name: value for name, value in known[5].items() if name in values}
    assert sum("speed" in name or "friction" in name for name in values) == 2


def test_a_study_with_files_of_its_own_is_executed_again_in_another_folder(capsys: pytest.CaptureFixture[str]) -> None:
    shutil.copytree(EXAMPLE.parent / "nearperson", "cell")
    study = Path("cell") / "near.study"
    study.write_text('import "nearperson.bddx"\nStudy near { repeat: 10 }\n', encoding="utf-8")
    assert main(["study", "run", str(study)]) == 1
    again = ["report", str(study), "--again", "2", "--no-pictures", "-o", "r.html"]
    assert main(again) == 0
    person = study.with_name("person.xml")
    person.write_text(f"{person.read_text(encoding='utf-8')}<!-- -->\n", encoding="utf-8")
    capsys.readouterr()
    assert main(again) == 2
    assert "person.xml changed since the study began" in capsys.readouterr().err
