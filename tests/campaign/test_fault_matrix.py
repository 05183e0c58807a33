"""Which faults count as noticed, and which clauses are proposed for the others."""

from __future__ import annotations

from dataclasses import replace

import pytest

from robbdd_tools.campaign.fault_matrix import FaultMatrix, FaultRow, FaultStatus, fault_matrices, is_sound
from robbdd_tools.campaign.fault_probes import PROBES, ProbedTemplate, separating, with_probes
from robbdd_tools.campaign.fault_text import matrix_lines, survivor_lines
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.catalog.robot_faults import robot_fault
from robbdd_tools.monitor.verdict import Cause, Outcome, Verdict
from robbdd_tools.protocol.clauses import BehaviourCall
from robbdd_tools.protocol.messages import ClauseJudged, judged
from robbdd_tools.protocol.specs import PROBE, ClauseSpec, ScenarioSpec
from robbdd_tools.run.results import ScenarioResult
from world.worlds import BIN_WS, CUBE, PANDA, scenario

CALL = BehaviourCall(load_catalog().behaviours["pick-place"], {"agent": PANDA, "object": CUBE, "workspace": BIN_WS})
CLAUSES = (
    ClauseSpec(3, "x:carry", "carry", "when", "", CALL),
    ClauseSpec(4, "x:there", "there", "then", ""),
    ClauseSpec(5, "x:whole", "whole", "then", ""),
)
TEMPLATE = ProbedTemplate("tidy", None, tuple((name, name) for name in ("agent", "object", "start", "end")))


def executed(seed: int, there: float, fault: str = "", whole: float | None = 1.0, cause: str = "") -> ScenarioResult:
    """An execution whose clauses have these margins: below 0 violated, ``None`` unknown."""
    spec = replace(scenario(seed=seed, clauses=CLAUSES), values={"n": seed})
    found = ScenarioResult(replace(spec, fault=robot_fault(fault) if fault else None))
    for clause, margin in zip(CLAUSES, (1.0, there, whole), strict=True):
        known = "violated" if margin is not None and margin < 0 else "holds"
        verdict = "unknown" if margin is None or cause else known
        found.judged[clause.line] = ClauseJudged(
            0, clause.line, verdict, margin, "m", None, cause and "no", cause=cause
        )
    return found


def rows(*with_fault: ScenarioResult) -> tuple[FaultMatrix, tuple[FaultRow, ...]]:
    sound = [executed(seed, 0.02) for seed in (1, 2)]
    (matrix,) = fault_matrices(sound, with_fault, {"t:fetch": "x:tidy"})
    return matrix, matrix.rows


@pytest.mark.parametrize(
    ("margins", "status"),
    [
        ((-0.1, -0.1), FaultStatus.NOTICED),
        ((-0.1, 0.01), FaultStatus.SOMETIMES),
        ((0.01, 0.02), FaultStatus.SURVIVES),
        ((0.02, 0.02), FaultStatus.UNSEEN),
    ],
)
def test_a_fault_is_noticed_if_some_clause_is_violated_in_each_execution(
    margins: tuple[float, float], status: FaultStatus
) -> None:
    matrix, (row,) = rows(*(executed(seed, one, "no-grip") for seed, one in zip((1, 2), margins, strict=True)))
    assert row.status is status
    assert (row in matrix.survivors) == (status is not FaultStatus.NOTICED)
    assert row.cells[1].violated == sum(one < 0 for one in margins)


def test_an_unknown_verdict_is_no_notice() -> None:
    _, (row,) = rows(executed(1, 0.02, "no-grip", whole=None), executed(2, 0.02, "no-grip"))
    assert (row.status, row.noticed, row.cells[2].unknown) == (FaultStatus.UNCLEAR, 0, 1)
    assert not is_sound(executed(1, 0.02, whole=None))


def test_a_fault_that_cannot_occur_counts_in_no_execution() -> None:
    _, (row,) = rows(executed(1, 0.02, "swapped-goal", cause=str(Cause.SCENE)), executed(2, -0.1, "swapped-goal"))
    assert (row.status, row.executions, row.reason) == (FaultStatus.NOTICED, 1, "no")
    _, (row,) = rows(executed(1, 0.02, "swapped-goal", cause=str(Cause.SCENE)))
    assert (row.status, row.executions) == (FaultStatus.ABSENT, 0)


def test_the_table_counts_violated_and_unknown_executions() -> None:
    matrix, _ = rows(
        executed(1, -0.1, "no-grip", whole=None),
        executed(2, -0.1, "no-grip"),
        executed(1, 0.01, "high-release"),
        executed(2, 0.02, "high-release"),
    )
    assert "\n".join(matrix_lines(matrix)) == (
        "fault               noticed  carry  there  whole\n"
        "no-grip             2/2      ·      2      1?\n"
        "high-release=50 mm  0/2      ·      ·      ·      not noticed"
    )
    assert list(survivor_lines(matrix, TEMPLATE, "m.bdd:3")) == [
        "m.bdd:3: template tidy: nothing notices that places to put down are seen 50 mm too high (high-release)",
        "    there: margin +20 mm → +10 mm",
        "    no clause is known that notices it in all executions",
    ]


def test_probes_are_judged_besides_the_clauses_and_decide_no_verdict() -> None:
    spec = with_probes(scenario(clauses=CLAUSES))
    probes = [clause for clause in spec.clauses if clause.role == PROBE]
    assert [clause.name for clause in probes] == [probe.predicate for probe in PROBES]
    assert len({clause.line for clause in spec.clauses}) == len(spec.clauses)
    found = executed(1, 0.02)
    failing = ScenarioResult(spec, {**found.judged, -1: ClauseJudged(0, -1, "violated", -1.0, "m", None, "")})
    assert is_sound(failing)


def test_a_scenario_without_the_events_has_only_the_probes_that_need_none() -> None:
    bare = replace(scenario(clauses=CLAUSES), events={"t:start": "scenario-start", "t:end": "scenario-end"})
    names = [clause.name for clause in with_probes(bare).clauses if clause.role == PROBE]
    assert names == ["does-not-drop", "does-not-collide"]
    without: ScenarioSpec = scenario(clauses=CLAUSES[1:])
    assert with_probes(without) is without


def measured(*margins: float) -> list[ClauseJudged]:
    return [judged(0, -1, Verdict(Outcome.HOLDS if one >= 0 else Outcome.VIOLATED, one)) for one in margins]


def test_a_probe_is_proposed_only_if_it_tells_all_executions_apart() -> None:
    probe = {one.predicate: one for one in PROBES}
    drop, time, far = probe["does-not-drop"], probe["takes-less-than"], probe["is-farther-than"]
    assert separating(drop, measured(0.1, 0.2), measured(-0.1, -0.2)) == ""
    assert separating(drop, measured(0.1, 0.2), measured(-0.1, 0.2)) is None
    assert separating(drop, measured(0.1, -0.2), measured(-0.1, -0.2)) is None
    slow = "10.0 s without the fault, 12.0 s with it"
    assert separating(time, measured(9990.0, 9991.0), measured(9988.0, 9980.0)) == slow
    assert separating(time, measured(9990.0, 9991.0), measured(9988.0, 9990.5)) is None
    assert separating(far, measured(0.2, 0.3), measured(0.1, 0.05)) is not None
    assert separating(far, measured(0.2, 0.3), measured(0.25, 0.05)) is None
    unknown = replace(measured(0.1)[0], verdict="unknown", robustness=None)
    assert separating(drop, [unknown], measured(-0.1)) is None
