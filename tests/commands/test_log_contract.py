"""The contract of logs: the trace of a run, written as a log of any kind, gives the verdicts and margins of the run.

A log that is handled in small parts gives the same bytes.
"""

from __future__ import annotations

import json
import shutil
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from kit import EXAMPLES
from logs.converted import KINDS, converted
from logs.drives import robbdd
from robbdd_tools.agent import log_evidence
from robbdd_tools.agent.judge_log import verdict_on
from robbdd_tools.agent.log_evidence import evidence_of
from robbdd_tools.base import large_arrays
from robbdd_tools.logs import joint_tracks, stored_rows, track_builder, transform_batches
from robbdd_tools.logs.open_log import read_log
from robbdd_tools.monitor import judge
from robbdd_tools.monitor.verdict import Cause, Outcome
from robbdd_tools.protocol.log_request import LogRequest
from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.traces.codec import Evidence, pack

pytestmark = pytest.mark.physics
ROUNDED = 1e-6
"""Stamps are rounded to nanoseconds, so positions between two samples differ by less than this (m)."""
ROUNDED_JOINTS = 1e-3
"""Joint states of a trace are rounded to 1e-5 rad, which is less than 1e-3 % of the range of a joint."""
CAMERA = 0.02
"""The simulated camera of a policy adds noise of 2 mm (standard deviation) to each axis, which a log does not have."""
NOT_IN_A_LOG = ("can reach", "has config", "collide")
"""Words of predicates on what a log does not contain; others say themselves that the trace has no record."""
HELD = ("held by", "does not drop")
"""Words of predicates on what is held, which a table cannot report without a signal."""
EVERY = (
    ("pickplace", "pickplace.bddx"),
    ("deadlines", "deadlines.bdd"),
    *(
        pytest.param(*one, marks=pytest.mark.nightly)
        for one in (
            ("conditions", "conditions.bdd"),
            ("conveyor", "conveyor.bdd"),
            ("limits", "limits.bdd"),
            ("ownrobot", "tidy.bddx"),
            ("relatedstories", "stories.bdd"),
            ("shelf", "shelf.bdd"),
            ("sorting", "sorting.bdd"),
            ("study", "study.bddx"),
            ("tworobots", "heights.bdd"),
        )
    ),
)


PARTS = (
    (transform_batches, "MOST"),
    (stored_rows, "BLOCK"),
    (track_builder, "BLOCK"),
    (joint_tracks, "BLOCK"),
    (log_evidence, "BLOCK"),
    (judge, "PART"),
)
"""Where the sizes of the parts are stated in which a long log is handled."""


@pytest.mark.parametrize(("example", "model"), EVERY)
def test_a_log_of_any_kind_gives_the_verdicts_and_margins_of_the_run(
    example: str, model: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = shutil.copytree(EXAMPLES / example, tmp_path / "models")
    # Code that judges clauses is imported from the folder of the model.
    monkeypatch.setattr(sys, "path", [str(folder), *sys.path])
    done = robbdd(folder, "run", model, "--first", "1", "--json", "run.json", "-o", "run")
    assert done.returncode in (0, 1), done.stderr
    simulated = json.loads((folder / "run.json").read_text(encoding="utf-8"))["scenarios"][0]["clauses"]
    spec = read_manifest(folder / "run").scenarios[0]
    judged = 0
    for storage in ((), ("--mcap",)):
        done = robbdd(folder, "export", "run", "--ros2", "-o", f"bag{len(storage)}", *storage)
        assert done.returncode == 0, done.stderr
        bag = folder / f"bag{len(storage)}"
        judged += compared(spec, bag if (bag / "metadata.yaml").exists() else bag / "1", simulated, "ros2", example)
    bag = folder / "bag0" if (folder / "bag0" / "metadata.yaml").exists() else folder / "bag0" / "1"
    for kind in KINDS:
        judged += compared(spec, converted(bag, kind, tmp_path), simulated, kind, example)
    assert judged >= 5, "no clause of this example is judged by a log"


def assert_same_in_parts(spec: ScenarioSpec, log: Path, expected: Evidence) -> None:
    """Assert that a log that is read and judged in small parts gives the same trace, verdicts and curves."""
    random = np.random.default_rng(len(expected.trace.times))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(large_arrays, "IN_MEMORY", 0)
        for module, name in PARTS:
            patch.setattr(module, name, int(random.integers(2, 400)))
        found = evidence_of(spec, read_log(log), LogRequest(str(log))).evidence
        assert pack(found) == pack(expected)
        assert [verdict_on(clause, found, spec) for clause in spec.clauses] == [
            verdict_on(clause, expected, spec) for clause in spec.clauses
        ]


def compared(spec: ScenarioSpec, log: Path, simulated: list[dict[str, Any]], kind: str, example: str) -> int:
    """Compare the verdicts of a log with those of the run, and return the number of those that are known."""
    known = 0
    evidence = evidence_of(spec, read_log(log), LogRequest(str(log))).evidence
    assert_same_in_parts(spec, log, evidence)
    for clause, expected in zip(spec.clauses, simulated, strict=True):
        found = verdict_on(clause, evidence, spec)
        place = (kind, expected["sentence"], found.reason)
        if found.outcome is Outcome.UNKNOWN and expected["verdict"] != "unknown":
            missing = NOT_IN_A_LOG + (HELD if kind == "csv" else ())
            assert found.cause is Cause.NO_RECORD or any(words in expected["sentence"] for words in missing), place
            continue
        assert found.outcome == expected["verdict"], place
        known += found.outcome is not Outcome.UNKNOWN
        if found.robustness is not None and expected["robustness"] is not None:
            error = CAMERA if example == "pickplace" else ROUNDED_JOINTS if found.unit == "%" else ROUNDED
            assert found.robustness == pytest.approx(expected["robustness"], abs=error), place
    return known
