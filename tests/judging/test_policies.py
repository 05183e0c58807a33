"""Observation policies: on constructed traces and in physics, both ways."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from judging.judged_policies import CLAUSE, NEAR, SENTENCE, STATED, TRUTH, as_judged, judged, moving, spec_of
from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.api import Region
from robbdd_tools.judging.decisions import decide
from robbdd_tools.judging.policies import noise_of
from robbdd_tools.monitor.durations import NO_DURATION
from robbdd_tools.monitor.policy import Observation, Policy, Provider, Rule
from robbdd_tools.monitor.time import After, During
from robbdd_tools.monitor.verdict import Cause, Outcome
from robbdd_tools.protocol.clauses import Fluent, Junction, fluents_of
from robbdd_tools.protocol.specs import ScenarioSpec
from world.worlds import BIN_WS, CUBE, PANDA, execution, pick_place


@pytest.mark.parametrize(
    ("form", "bounds", "margin"),
    [
        ("less-than", (0.5,), 0.1),
        ("less-than", (0.3,), -0.1),
        ("greater-than", (0.1,), 0.1),
        ("greater-than", (0.3,), -0.1),
        ("between", (0.1, 0.5), 0.1),
        ("between", (0.25, 0.5), -0.05),
        ("equals", (0.3, 0.15), 0.05),
        ("equals", (0.2, 0.15), -0.05),
    ],
)
def test_every_form_of_a_distance_has_its_margin(form: str, bounds: tuple[float, ...], margin: float) -> None:
    found = judged(spec_of(Rule("distance", form=form, bounds=bounds)), moving([0.2, 0.3, 0.4]))
    assert (found.robustness, found.unit) == (pytest.approx(margin), "m")
    assert found.outcome is (Outcome.HOLDS if margin >= 0 else Outcome.VIOLATED)


def test_a_policy_replaces_the_evaluator_of_its_clause_and_of_no_other() -> None:
    spec = spec_of()
    assert judged(spec, moving([0.2])).outcome is Outcome.HOLDS
    other = as_judged(SENTENCE, replace(STATED, iri="https://x/other"), spec)
    assert decide(other, moving([0.2]), {}, {"t:a", "t:b"}).outcome is Outcome.UNKNOWN


def test_a_policy_does_not_judge_how_long_something_takes() -> None:
    found = judged(spec_of(), moving([0.2, 0.2]), 'it takes less than "5 s" from "t:a" until "t:b"')
    assert found.outcome is Outcome.UNKNOWN
    assert found.reason == NO_DURATION


def test_a_part_of_a_group_has_its_policy() -> None:
    group = f"( {SENTENCE} or not ( {SENTENCE} ) )"
    found = as_judged(group, replace(STATED, parts=("https://x/other", CLAUSE)), spec_of())
    assert isinstance(found, Junction)
    assert [fluent.predicate.name for fluent in fluents_of(found)] == ["located-at", "x:policy"]


def test_free_text_is_judged_by_a_policy() -> None:
    text = 'the cube is near the bin from "t:a" until "t:b"'
    assert judged(spec_of(), moving([0.2]), text).outcome is Outcome.HOLDS
    assert judged(spec_of(), moving([0.6]), text).outcome is Outcome.VIOLATED


def test_a_text_keeps_its_horizon_when_a_policy_judges_it() -> None:
    text = 'the cube is near for 0.15 seconds after event "t:a"'
    assert judged(spec_of(), moving([0.2, 0.9, 0.2]), text).outcome is Outcome.VIOLATED
    assert judged(spec_of(), moving([0.2, 0.2, 0.9]), text).outcome is Outcome.HOLDS


def test_the_horizon_of_a_policy_takes_the_place_of_that_of_the_clause() -> None:
    clause = as_judged('the cube is near after event "t:a"', STATED, spec_of(horizon=2.0))
    assert isinstance(clause, Fluent)
    assert clause.time == After("t:a", 2.0)
    interval = as_judged(SENTENCE, STATED, spec_of(horizon=2.0))
    assert isinstance(interval, Fluent)
    assert interval.time == During("t:a", "t:b")


def test_a_slow_provider_sees_nothing_between_its_looks() -> None:
    trace = moving([0.2, 0.2, 0.2, 0.9, 0.2, 0.2])
    assert judged(spec_of(), trace).outcome is Outcome.VIOLATED
    assert judged(spec_of(provider=replace(TRUTH, rate=5.0)), trace).outcome is Outcome.HOLDS


def test_latency_makes_what_is_seen_older() -> None:
    trace = moving([0.9, 0.2, 0.2, 0.2])
    later = replace(trace, events=tuple(replace(s, time=0.2) if s.name == "t:a" else s for s in trace.events))
    assert judged(spec_of(), later).outcome is Outcome.HOLDS
    assert judged(spec_of(provider=replace(TRUTH, latency=0.2)), later).outcome is Outcome.VIOLATED
    found = judged(spec_of(provider=replace(TRUTH, latency=0.2)), trace)
    assert found.reason == "nothing was known of env:cube1 at 0.00 s: it is seen 0.2 s later"


def test_noise_follows_from_the_seed_and_has_its_deviation() -> None:
    noisy = replace(TRUTH, noise=0.01)
    far = Rule("distance", form="equals", bounds=(0.0, 1.0))
    trace = moving([0.0] * 2000)
    one, again = (judged(spec_of(far, noisy), trace).robustness for _ in range(2))
    assert one == again
    assert one != judged(spec_of(far, noisy, seed=2), trace).robustness
    assert one is not None
    # The largest of 2000 differences of two noisy points in space, with a deviation of 0.014 m on each axis.
    assert 0.03 < 1.0 - one < 0.1


def test_noise_of_a_longer_trace_begins_as_that_of_a_shorter_one() -> None:
    far = Rule("distance", form="equals", bounds=(0.0, 1.0))
    short, long = moving([0.0] * 5), moving([0.0] * 50)
    noisy = spec_of(far, replace(TRUTH, noise=0.01))
    cut = replace(long, events=short.events)
    assert judged(noisy, short).robustness == judged(noisy, cut).robustness


def test_observations_too_far_apart_in_time_are_no_evidence() -> None:
    slow = Observation("x:slow", replace(TRUTH, rate=1.0), ("env:bin",))
    fast = Observation("x:fast", TRUTH, (CUBE,))
    for offset, outcome in ((0.1, Outcome.UNKNOWN), (1.0, Outcome.HOLDS)):
        spec = spec_of(replace(NEAR, max_time_offset=offset))
        assert spec.execution is not None
        policy = replace(spec.execution.policies[0], observations=(slow, fast))
        found = judged(replace(spec, execution=replace(spec.execution, policies=(policy,))), moving([0.2] * 6))
        assert found.outcome is outcome
        assert (found.reason == "the observations are 0.5 s apart, more than 0.1 s") is (outcome is Outcome.UNKNOWN)


@pytest.mark.parametrize(
    ("spec", "reason"),
    [
        (
            spec_of(Rule("topic", "/seen")),
            "its verdicts come from the ROS topic '/seen', which a simulation does not have",
        ),
        (
            spec_of(provider=Provider("x:p", "topic", source="/poses")),
            "env:cube1 is observed by a ROS topic '/poses', which a simulation does not have",
        ),
        (
            spec_of(provider=Provider("x:p", "camera")),
            "env:cube1 is observed by camera, which a simulation does not have",
        ),
        (spec_of(targets=("t:var-thing",)), "a distance is between two elements, but 1 are observed"),
        (spec_of(targets=("t:var-thing", "env:void")), "the trace has no record of 'env:void'"),
        (spec_of(provider=replace(TRUTH, rate=0.0)), "the update rate of the provider of env:cube1 must be above 0 Hz"),
    ],
)
def test_what_cannot_be_observed_is_unknown_and_says_why(spec: ScenarioSpec, reason: str) -> None:
    found = judged(spec, moving([0.2, 0.2]))
    assert (found.outcome, found.reason) == (Outcome.UNKNOWN, reason)


@pytest.fixture(scope="module")
def carried() -> Execution:
    run = execution([pick_place()])
    run.advance_until(lambda _: False)
    return run


@pytest.mark.physics
@pytest.mark.parametrize(("bound", "outcome"), [(0.15, Outcome.HOLDS), (0.001, Outcome.VIOLATED)])
def test_in_physics_a_distance_to_the_goal_is_observed(carried: Execution, bound: float, outcome: Outcome) -> None:
    spec = spec_of(Rule("distance", form="less-than", bounds=(bound,)), targets=("t:var-thing", BIN_WS))
    clause = as_judged('it is near after event "t:place-end"', STATED, spec)
    assert decide(clause, carried.trace, carried.regions, {"t:place-end"}).outcome is outcome


@pytest.mark.physics
def test_in_physics_latency_and_noise_are_seen(carried: Execution) -> None:
    window = 'the tool is slow from "t:pick-start" until "t:place-end"'
    tool = (CUBE, PANDA)
    within = Rule("distance", form="less-than", bounds=(2.0,))
    margins: list[float] = []
    for provider in (TRUTH, replace(TRUTH, noise=0.02), replace(TRUTH, latency=0.2)):
        clause = as_judged(window, STATED, spec_of(within, provider, tool))
        found = decide(clause, carried.trace, carried.regions, {"t:pick-start", "t:place-end"})
        assert found.robustness is not None
        margins.append(found.robustness)
    assert np.ptp(margins[:2]) > 1e-4
    assert len(set(margins)) == 3


def test_a_workspace_is_observed_at_its_first_region_which_turns_with_its_carrier() -> None:
    quarter = [0.5**0.5, 0.0, 0.0, 0.5**0.5]
    trace = moving([0.2, 0.2])
    trace = replace(trace, orientations=np.array([[[1.0, 0, 0, 0], quarter]] * 2))
    regions = {
        "env:other_ws": (),
        "env:bin_ws": (
            ("env:bin", Region((0.0, -0.1, 0.0), (0.1, 0.1, 0.1))),
            ("env:bin", Region((9.0, 0, 0), (1, 1, 1))),
        ),
    }
    clause = as_judged(SENTENCE, STATED, spec_of(targets=("t:var-thing", "env:bin_ws")))
    found = decide(clause, trace, regions, {"t:a", "t:b"})
    # The region lies 0.1 m ahead of the turned bin, and so 0.1 m from the cube.
    assert found.robustness == pytest.approx(0.4)


def test_what_is_observed_must_be_one_element() -> None:
    spec = replace(spec_of(), values={"t:var-thing": [CUBE, "env:bin"]})
    found = judged(spec, moving([0.2]))
    assert found.cause is Cause.UNOBSERVED
    assert "t:var-thing is ['env:cube1', 'env:bin']" in found.reason


def test_a_provider_without_a_rate_or_of_another_kind_sees_nothing() -> None:
    for provider, words in (
        (replace(TRUTH, rate=None), "env:cube1"),
        (replace(TRUTH, rate=-1.0), "env:cube1"),
        (Provider("x:p", "entity-state"), "ROS entity states"),
        (Provider("x:p", "transforms", source="map"), "ROS transforms 'map'"),
    ):
        found = judged(spec_of(provider=provider), moving([0.2]))
        assert found.cause is Cause.UNOBSERVED
        assert words in found.reason


def test_a_comparison_that_does_not_exist_is_unobserved() -> None:
    for rule in (Rule("distance", form="near", bounds=(0.5,)), Rule("distance", form="between", bounds=(0.5,))):
        found = judged(spec_of(rule), moving([0.2]))
        assert (found.outcome, found.cause) == (Outcome.UNKNOWN, Cause.UNOBSERVED)
        assert f"'{rule.form}'" in found.reason


def test_observations_as_far_apart_as_allowed_are_evidence() -> None:
    slow = Observation("x:slow", replace(TRUTH, rate=2.0), ("env:bin",))
    fast = Observation("x:fast", TRUTH, (CUBE,))
    spec = spec_of(replace(NEAR, max_time_offset=0.4))
    assert spec.execution is not None
    policy = replace(spec.execution.policies[0], observations=(slow, fast))
    found = judged(replace(spec, execution=replace(spec.execution, policies=(policy,))), moving([0.2] * 5))
    assert found.outcome is Outcome.HOLDS


def test_the_samples_of_a_log_are_the_observations() -> None:
    elsewhere = Provider("x:p", "topic", rate=1.0, source="/poses")
    logged = replace(moving([0.2, 0.3, 0.4]), log="drive.mcap")
    found = judged(spec_of(provider=elsewhere), logged)
    assert (found.outcome, found.robustness) == (Outcome.HOLDS, pytest.approx(0.1))
    assert (
        judged(spec_of(provider=elsewhere), replace(moving([0.2, 0.6]), log="drive.mcap")).outcome is Outcome.VIOLATED
    )


MM = 0.001
NOISY = replace(TRUTH, noise=2 * MM)


@pytest.mark.parametrize(
    ("sigma", "bound", "outcome"),
    [
        # The distance is 0.3 m; its standard deviation is 2 mm · √2 = 2.83 mm.
        (None, 0.3001, Outcome.HOLDS),
        (3.0, 0.3001, Outcome.UNKNOWN),
        (3.0, 0.3084, Outcome.UNKNOWN),
        (3.0, 0.3086, Outcome.HOLDS),
        (3.0, 0.2999, Outcome.UNKNOWN),
        (3.0, 0.2916, Outcome.UNKNOWN),
        (3.0, 0.2914, Outcome.VIOLATED),
        (1.0, 0.3027, Outcome.UNKNOWN),
        (1.0, 0.3029, Outcome.HOLDS),
    ],
)
def test_a_margin_within_the_stated_noise_decides_nothing(sigma: float | None, bound: float, outcome: Outcome) -> None:
    spec = spec_of(Rule("distance", form="less-than", bounds=(bound,)), NOISY)
    # A log's positions are the measured ones: no noise is added to them.
    found = judged(with_sigma(spec, sigma), replace(moving([0.3, 0.3]), log="drive"))
    assert found.outcome is outcome, found.reason
    assert ("is within the uncertainty of the measurements, ±" in found.reason) == (outcome is Outcome.UNKNOWN)


def with_sigma(spec: ScenarioSpec, sigma: float | None) -> ScenarioSpec:
    assert spec.execution is not None
    (policy,) = spec.execution.policies
    return replace(spec, execution=replace(spec.execution, policies=(replace(policy, sigma=sigma),)))


def test_certain_verdicts_are_as_rarely_wrong_as_the_number_of_deviations_says() -> None:
    """A Monte Carlo oracle of its own: measured distances of noisy points, and the share of wrong certain verdicts."""
    draws = np.random.default_rng(7).normal(0.0, 2 * MM, (200_000, 2, 3))
    measured = np.linalg.norm(np.array([0.3, 0.0, 0.0]) + draws[:, 0] - draws[:, 1], axis=1)
    for sigma, wrong in ((1.0, 0.1587), (2.0, 0.0228), (3.0, 0.00135)):
        limit = noise_of(policy_of(with_sigma(spec_of(provider=NOISY), sigma)))
        assert limit == pytest.approx(sigma * float(measured.std()), rel=0.01)
        # A true margin of zero: the verdict is certain, and wrong, if the measured one exceeds the limit.
        assert np.mean(measured - 0.3 > limit) == pytest.approx(wrong, rel=0.15, abs=2e-4)


def policy_of(spec: ScenarioSpec) -> Policy:
    assert spec.execution is not None
    return spec.execution.policies[0]


def test_simulated_sensors_decide_as_often_as_the_noise_allows() -> None:
    """The simulated noise is that of the limit: of many seeds, the share of undecided verdicts is the oracle's."""
    margin, sigma = 4 * MM, 2.0
    spec = with_sigma(spec_of(Rule("distance", form="less-than", bounds=(0.3 + margin,)), NOISY), sigma)
    outcomes = [judged(replace(spec, seed=seed), moving([0.3])).outcome for seed in range(400)]
    draws = np.random.default_rng(3).normal(0.0, 2 * MM, (100_000, 2, 3))
    measured = margin + 0.3 - np.linalg.norm(np.array([0.3, 0.0, 0.0]) + draws[:, 0] - draws[:, 1], axis=1)
    limit = sigma * 2 * MM * 2**0.5
    expected = float(np.count_nonzero(np.abs(measured) < limit)) / len(measured)
    undecided = outcomes.count(Outcome.UNKNOWN) / len(outcomes)
    # Four standard deviations of a share of 400.
    assert abs(undecided - expected) < 4 * (expected * (1 - expected) / 400) ** 0.5


def test_users_code_on_noisy_observations_has_an_unknown_error(tmp_path: Path) -> None:
    (tmp_path / "noisy_rules.py").write_text("def near(evidence, arguments):\n    return 1.0\n", encoding="utf-8")
    spec = spec_of(Rule("python", "noisy_rules:near"), NOISY, model=str(tmp_path / "a.bddx"))
    assert judged(spec, moving([0.3])).outcome is Outcome.HOLDS
    found = judged(with_sigma(spec, 3.0), moving([0.3]))
    assert found.outcome is Outcome.UNKNOWN
    assert "cannot be computed from the uncertainty of the measurements" in found.reason
