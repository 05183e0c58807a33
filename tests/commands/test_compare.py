"""``robbdd compare``: what it prints and writes, and its exit codes."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest

from kit import ROOT
from robbdd_tools.cli import main
from robbdd_tools.run.store import RunStore
from run.recorded import CLAUSES, record_run

SCHEMA = json.loads((ROOT / "docs/schemas/comparison.schema.json").read_text(encoding="utf-8"))


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> RunStore:
    monkeypatch.chdir(tmp_path)
    return RunStore(tmp_path / ".robbdd" / "runs")


def test_equal_runs_are_identical(store: RunStore, capsys: pytest.CaptureFixture[str]) -> None:
    record_run(store, [0.3, 0.2])
    record_run(store, [0.3, 0.2])
    assert main(["compare", "1", "latest"]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "run 1 (m.bdd, seed 1) → run 2 (m.bdd, seed 1)",
        "2 shared executions, compared in pairs: all seeds are equal",
        "",
        "clause        before  after  change of pass rate        change of margin            result",
        "every clause  2/2     2/2    0.0 points [−65.8, +65.8]                              identical",
        "c5            2/2     2/2    0.0 points [−65.8, +65.8]  +0.0 mm [+0.0 mm, +0.0 mm]  identical",
        "",
        "identical: every verdict and every margin is the same",
    ]


def test_a_worse_run_fails_and_names_its_clause_and_executions(
    store: RunStore, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    record_run(store, [0.3] * 30)
    record_run(store, [-0.1] * 25 + [0.3] * 5)
    arguments = ["--json", "c.json", "--markdown", "c.md", "--gate", "no clause worse than 2 points"]
    assert main(["compare", "1", "2", *arguments]) == 1
    printed = capsys.readouterr().out
    assert "c5            30/30   5/30   −83.3 points" in printed
    assert "25 executions with other verdicts:\n  e:v -- 1  x = 0  (execution 1)\n" in printed
    assert "      c5  ✔ +300 mm → ✗ −100 mm: -0.1\n" in printed
    assert "  … and 5 more" in printed
    assert printed.splitlines()[-1].startswith("worse: c5 (−83.3 points [")
    document = json.loads((tmp_path / "c.json").read_text(encoding="utf-8"))
    jsonschema.validate(document, SCHEMA)
    assert (document["decision"], [one["change"] for one in document["clauses"]]) == ("worse", ["worse", "worse"])
    text = (tmp_path / "c.md").read_text(encoding="utf-8")
    assert "\n| c5 | 30/30 | 5/30 | −83.3 points \\[" in text


def test_only_the_violated_clauses_of_an_execution_are_listed(
    store: RunStore, capsys: pytest.CaptureFixture[str]
) -> None:
    record_run(store, [0.3], clauses=CLAUSES)
    record_run(store, [-0.1], clauses=CLAUSES)
    main(["compare", "1", "2"])
    assert "      c5  ✔ +300 mm → ✗ −100 mm: -0.1\n      c6  ✔ +300 mm → ✗ −100 mm: -0.1\n\n" in capsys.readouterr().out
    record_run(store, [None], clauses=CLAUSES)
    main(["compare", "1", "3"])
    assert "      c5  ✔ +300 mm → ?: None\n      c6  ✔ +300 mm → ?: None\n\n" in capsys.readouterr().out


def test_few_executions_do_not_tell_and_say_how_many_would(store: RunStore, capsys: pytest.CaptureFixture[str]) -> None:
    record_run(store, [0.3] * 5)
    record_run(store, [0.2] * 5)
    assert main(["compare", "1", "2"]) == 3
    assert capsys.readouterr().out.endswith(
        "state the change that you accept: --gate 'no clause worse than 2 points'\n"
    )
    assert main(["compare", "1", "2", "--gate", "no clause worse than 2 points"]) == 3
    lines = capsys.readouterr().out.splitlines()
    assert lines[-2] == "the executions do not show whether these are worse: c5"
    assert lines[-1] == "about 2801 executions with the same seeds show a drop of 2 points with a probability of 80%"


def test_what_is_not_compared_is_said(store: RunStore, capsys: pytest.CaptureFixture[str]) -> None:
    record_run(store, [0.3] * 5, clauses=CLAUSES, seed=1)
    record_run(store, [0.3] * 3, seed=2)
    assert main(["compare", "1", "2"]) == 3
    printed = capsys.readouterr().out
    assert "as two independent samples: the seeds differ" in printed
    assert "2 executions are of the earlier run alone and not compared\n" in printed
    assert "not compared: only the earlier run judges c6\n" in printed
    assert "seed 1 became 2\n" in printed


def test_results_files_are_compared_as_runs(
    store: RunStore, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name, margins in (("a", [0.3]), ("b", [0.4])):
        document = record_run(store, margins).results()
        (tmp_path / f"{name}.json").write_text(json.dumps(document), encoding="utf-8")
    assert main(["compare", "a.json", "b.json"]) == 3
    assert capsys.readouterr().out.startswith("a.json → b.json\n1 shared execution, compared in pairs")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "a.json:1:2: this is neither JSON nor XML"),
        ('{"scenarios": [{}]}', "a.json:1:1: scenarios[0].values: missing: is this what robbdd run --json wrote?"),
        ("<testsuites/>", "a.json"),
        (None, "a.json: "),
    ],
)
def test_what_cannot_be_compared_is_explained(
    store: RunStore, tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str | None, message: str
) -> None:
    record_run(store, [0.3])
    if text is not None:
        (tmp_path / "a.json").write_text(text, encoding="utf-8")
    assert main(["compare", "a.json", "1"]) == 2
    assert message in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["1", "9"], "there is no run '9'"),
        (["1", "1", "--gate", "worse than 2"], "'worse than 2' is not a gate: write 'no clause worse than 2 points'"),
    ],
)
def test_a_wrong_argument_is_explained(
    store: RunStore, capsys: pytest.CaptureFixture[str], arguments: list[str], message: str
) -> None:
    record_run(store, [0.3])
    assert main(["compare", *arguments]) == 2
    assert message in capsys.readouterr().err


def test_a_level_is_a_probability(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["compare", "1", "2", "--level", "95"])
    assert "'95' must be a number from 0.5 to less than 1" in capsys.readouterr().err


@pytest.mark.usefixtures("without_scipy")
def test_without_scipy_the_extra_is_named(store: RunStore, capsys: pytest.CaptureFixture[str]) -> None:
    record_run(store, [0.3, 0.1])
    assert main(["compare", "1", "1"]) == 2
    assert "pip install 'robbdd-tools[statistics]'" in capsys.readouterr().err
