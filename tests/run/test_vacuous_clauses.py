"""Clauses of a run that could not have failed."""

from __future__ import annotations

from dataclasses import replace

import pytest

from kit import schema_errors
from robbdd_tools.monitor.verdict import NEVER_APPLIED
from robbdd_tools.protocol.messages import ClauseJudged, MarginRanges, RunMessage, decode, encode
from robbdd_tools.protocol.specs import ClauseSpec, Manifest, ScenarioSpec, SceneSpec
from robbdd_tools.run.results import RunResults
from robbdd_tools.run.vacuous_clauses import HELD_BEFORE

IRI = "https://x/c"
SPEC = ScenarioSpec(
    "features/s.feature", 3, "e:v -- 1", "https://x/s", "https://x/v", 1, {}, 7, SceneSpec(), {},
    (ClauseSpec(5, IRI, "c", "then", "it holds"),),
)  # fmt: skip


def of_run(*messages: RunMessage) -> RunResults:
    found = RunResults(Manifest("m.bdd", 1, (SPEC, replace(SPEC, variation=2))))
    for message in messages:
        found.apply(decode(encode(message)))
    return found


@pytest.mark.parametrize(
    ("one", "other", "reason"),
    [
        (((0.05, 0.05),), ((0.05, 0.05),), "its predicate had the same margin (0.05) throughout all 2 executions"),
        (((0.05, 0.05),), ((0.04, 0.04),), None),
        (((0.05, 0.05),), ((-0.1, 0.05),), None),
        (((1.0, 1.0), (2.0, 2.0)), ((1.0, 1.0), (2.0, 2.0)), "(1 and 2) throughout all 2 executions"),
        (((1.0, 1.0), (2.0, 2.0)), ((1.0, 1.0), (2.0, 3.0)), None),
        (((1.0, 1.0),), ((1.0, 1.0), (1.0, 1.0)), "(1) throughout all 2 executions"),
        (((1.0, 1.0),), ((1.0, 1.0), (2.0, 2.0)), None),
    ],
)
def test_a_predicate_that_never_varied_in_any_execution_could_not_have_failed(
    one: tuple[tuple[float, float], ...], other: tuple[tuple[float, float], ...], reason: str | None
) -> None:
    found = of_run(MarginRanges(0, 5, one), MarginRanges(1, 5, other)).vacuous()
    if reason is None:
        assert not found
    else:
        assert found[IRI].endswith(reason)


def test_an_empty_window_is_told_in_the_results_of_every_scenario() -> None:
    said = "its window contains no sample"
    found = of_run(ClauseJudged(0, 5, "unknown", None, "", None, "no sample was taken in the window", None, said))
    document = found.as_json()
    assert not schema_errors("run.schema.json", document)
    assert [scenario["clauses"][0]["vacuous"] for scenario in document["scenarios"]] == [said, said]


@pytest.mark.parametrize(
    ("one", "other", "marked"), [(True, True, True), (True, False, False), (True, None, True), (None, None, False)]
)
def test_what_held_before_the_behaviour_in_every_execution_is_marked(
    one: bool | None, other: bool | None, marked: bool
) -> None:
    varied = ((-0.1, 0.1),)
    found = of_run(MarginRanges(0, 5, varied, one), MarginRanges(1, 5, varied, other)).vacuous()
    assert found == ({IRI: HELD_BEFORE} if marked else {})


@pytest.mark.parametrize("applied", [True, False])
def test_a_condition_that_holds_in_no_execution_is_marked(applied: bool) -> None:
    never = ClauseJudged(0, 5, "holds", None, "", None, NEVER_APPLIED, None, NEVER_APPLIED)
    other = ClauseJudged(1, 5, "holds", 0.1, "m", 0.5, "") if applied else replace(never, index=1)
    assert of_run(never, other).vacuous() == ({} if applied else {IRI: NEVER_APPLIED})
    assert of_run(replace(other, index=0), replace(never, index=1)).vacuous() == (
        {} if applied else {IRI: NEVER_APPLIED}
    )
