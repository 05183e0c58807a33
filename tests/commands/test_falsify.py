"""``robbdd falsify`` on agents that need no time: what it prints, writes and refuses."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import ClassVar

import jsonschema
import pytest

from campaign.study_agents import QuickAgent, write_study
from campaign.test_designs import HEAD, QUANTITIES, RANGES, VARIED
from kit import ROOT
from robbdd_tools.cli import main
from robbdd_tools.protocol.messages import ClauseJudged, RunMessage, ScenarioFinished, ScenarioStarted
from robbdd_tools.protocol.specs import ScenarioSpec, plain_name
from robbdd_tools.run import scheduler

SCHEMA = json.loads((ROOT / "docs/schemas/falsify.schema.json").read_text(encoding="utf-8"))
STUDY = f"{HEAD}{RANGES} design: grid 2\n}}\n"


class LowDrops(QuickAgent):
    """Fails if the height is below 0.24 m, whatever the friction."""

    seeds: ClassVar[set[int]] = set()

    def limit(self, seed: int) -> float:
        """The height (m) below which an execution with this seed fails."""
        del seed
        return 0.24

    def executed(self, index: int, spec: ScenarioSpec) -> Iterator[RunMessage]:
        values = {plain_name(name): value for name, value in spec.values.items()}
        LowDrops.seeds.add(spec.seed)
        margin = float(str(values["drop"]).split()[0]) - self.limit(spec.seed)
        outcome = "holds" if margin >= 0 else "violated"
        yield ScenarioStarted(index)
        for clause in spec.clauses:
            yield ClauseJudged(index, clause.line, outcome, margin, "m", 1.0, "" if margin >= 0 else "too low")
        yield ScenarioFinished(index, 1.0, 0.0, 0.0)


class SometimesLow(LowDrops):
    """Fails below 0.22 m with every seed, and with some seeds already below up to 0.24 m."""

    def limit(self, seed: int) -> float:
        return 0.22 + 0.02 * (seed % 5) / 4


class LowInCentimetres(LowDrops):
    """The same for heights in centimetres."""

    def limit(self, seed: int) -> float:
        return 100 * super().limit(seed)


class Unjudged(LowDrops):
    """Judges nothing."""

    def executed(self, index: int, spec: ScenarioSpec) -> Iterator[RunMessage]:
        yield ScenarioStarted(index)
        for clause in spec.clauses:
            yield ClauseJudged(index, clause.line, "unknown", None, "", None, "there is no model for 'rim'")
        yield ScenarioFinished(index, 1.0, 0.0, 0.0)


@pytest.fixture
def study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(scheduler, "Agent", LowDrops)
    monkeypatch.chdir(tmp_path)
    LowDrops.seeds.clear()
    return write_study(tmp_path, STUDY, VARIED).relative_to(tmp_path)


def test_the_nearest_failure_is_printed_written_and_repeated(study: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["falsify", str(study), "--json", "found.json"]) == 1
    printed = capsys.readouterr().out
    head, _, names, drop, rubs, *_ = printed.splitlines()
    assert head.startswith("a failure after ")
    assert names.split("  ")[-1].strip() == "first failure"
    nominal, holding, nearest, _ = (float(word) for word in drop.split() if word not in ("drop", "m"))
    assert nominal == 0.3
    assert 0.24 <= holding < 0.2405
    assert 0.2395 < nearest < 0.24
    assert rubs.split()[:4] == ["fetch.rubs", "0.75", "=", "="]
    assert "    var <fetch.rubs>: { 0.75 }  // as nominal\n" in printed
    assert "with other seeds, 40 of 40 executions fail there" in printed
    document = json.loads(Path("found.json").read_text(encoding="utf-8"))
    jsonschema.validate(document, SCHEMA)
    assert document["nearest"]["drop"] == pytest.approx(nearest, abs=1e-6)
    # Four scenarios have one seed each at all points, and ten others each at the end.
    assert len(LowDrops.seeds) == 44
    before = Path("found.json").read_bytes()
    assert main(["falsify", str(study), "--json", "found.json", "--jobs", "1"]) == 1
    assert Path("found.json").read_bytes() == before
    assert capsys.readouterr().out == printed


def test_the_values_to_keep_fail_with_all_seeds(
    study: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scheduler, "Agent", SometimesLow)
    assert main(["falsify", str(study), "--json", "found.json"]) == 1
    printed = capsys.readouterr().out
    document = json.loads(Path("found.json").read_text(encoding="utf-8"))
    jsonschema.validate(document, SCHEMA)
    assert 0.22 < document["nearest"]["drop"] < 0.24
    assert document["first"]["drop"] < document["sure"]["drop"] < 0.22
    assert document["sure"]["drop"] == pytest.approx(0.22, abs=0.003)
    assert "all 40 fail at the values below: for any seed, the boundary is between both\n" in printed
    assert f"    var <drop>: {{ {document['sure']['drop']!r} }}\n" in printed


def test_values_of_a_model_with_quantities_are_printed_as_quantities(
    study: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scheduler, "Agent", LowInCentimetres)
    text = f"{HEAD} factor var <drop>: from 20 cm to 40 cm design: grid 2\n}}\n"
    write_study(study.parent, text, QUANTITIES)
    assert main(["falsify", str(study)]) == 1
    (row,) = (line for line in capsys.readouterr().out.splitlines() if line.startswith("    var "))
    assert row.startswith("    var <drop>: { 23.9")
    assert row.endswith(" cm }")


def test_a_model_that_cannot_be_judged_is_not_searched(
    study: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scheduler, "Agent", Unjudged)
    assert main(["falsify", str(study)]) == 2
    error = capsys.readouterr().err
    assert "no execution can be judged at the nominal values: " in error
    assert "there is no model for 'rim'" in error


def test_nominal_values_that_fail_end_the_search(study: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["falsify", str(study), "--nominal", "drop=0.22"]) == 1
    assert capsys.readouterr().out.startswith("the nominal values fail already:\n")


def test_without_a_failure_nothing_is_claimed(study: Path, capsys: pytest.CaptureFixture[str]) -> None:
    study.write_text(STUDY.replace("from 0.2 m", "from 0.25 m"), encoding="utf-8")
    assert main(["falsify", str(study), "--budget", "20", "--method", "uniform"]) == 0
    assert capsys.readouterr().out == ("no failure at 20 points (84 executions); this proves nothing beyond them\n")


def test_wrong_input_is_refused_with_the_right_one(study: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["falsify", str(study), "--nominal", "dorp=0.3"]) == 2
    assert "the study has no range of 'dorp'; it has drop, fetch.rubs" in capsys.readouterr().err
    assert main(["falsify", str(study), "--nominal", "drop=3"]) == 2
    assert "the nominal value 3 of 'drop' is not from 0.2 to 0.4" in capsys.readouterr().err
    study.write_text(f"{HEAD}repeat: 2\n}}\n", encoding="utf-8")
    assert main(["falsify", str(study)]) == 2
    assert "has no range to search: write 'factor var <NAME>: from 0.1 to 0.5'" in capsys.readouterr().err
    assert main(["falsify", "none.study"]) == 2
