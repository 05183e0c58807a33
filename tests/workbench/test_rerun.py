"""Failed scenarios are executed again with the same seeds, from whatever source."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

import robbdd_tools as robbdd
from kit import EXAMPLES
from robbdd_tools.cli import main

STRICT = """
obs policy (ns=exec) on-the-spot for <pick-place.at-goal> horizon: 0.5 seconds {
    observations: { <thing-pose>, <goal-pose> }
    evaluator: linear distance { less-than: 0.0001 m max time offset: 0.02 s }
}

Scenario Exec (ns=exec) far-too-strict {
    variant: <tidy-bench.part-to-bin>
    scene inst: <bench_sim>
    bhv: <built-in>
    policies: { <on-the-spot> }
    seed: 7
}
"""


@pytest.mark.physics
@pytest.mark.parametrize("seed", [[], ["--seed", "9"]])
def test_failures_of_an_execution_keep_its_own_seed_unless_the_user_gave_one(seed: list[str], tmp_path: Path) -> None:
    model = shutil.copytree(EXAMPLES / "pickplace", tmp_path / "cell") / "pickplace.bddx"
    model.write_text(model.read_text(encoding="utf-8") + STRICT, encoding="utf-8")
    assert main(["run", str(model), "--scenario", "far-too-strict", "--first", "1", *seed]) == 1
    assert main(["run", str(model), "--rerun-failed"]) == 1
    assert main(["run", str(model), "--rerun-failed"]) == 1
    first, *again = (run.results for run in robbdd.runs(model))
    assert [results == first for results in again] == [True, True]
