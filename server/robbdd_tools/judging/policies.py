"""Judge clauses by the observation policies of a ``.bddx`` instead of the catalog's observation and evaluation."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from robbdd_tools.catalog.api import Predicate
from robbdd_tools.judging.observation_streams import Stream
from robbdd_tools.monitor.durations import NO_DURATION
from robbdd_tools.monitor.time import After, Before, TimeConstraint
from robbdd_tools.monitor.unobserved import Unobserved
from robbdd_tools.protocol.clauses import Fluent, Junction
from robbdd_tools.protocol.specs import plain_name
from robbdd_tools.user_code.calls import UserCodeError, call_user_code, definition_of, load_attribute, refused

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Arguments, Evidence, FloatArray
    from robbdd_tools.monitor.policy import Policy, Rule
    from robbdd_tools.protocol.clauses import Clause
    from robbdd_tools.protocol.specs import ScenarioSpec


def with_policies(clause: Clause, spec: ScenarioSpec) -> Clause:
    """Return a clause whose fluents are judged by the policies of the scenario's execution, if any policy applies."""
    policies = {} if spec.execution is None else {policy.clause: policy for policy in spec.execution.policies}
    return _attached(clause, policies, spec) if policies else clause


MEASURED: Mapping[str, Literal["length", "nothing", "otherwise"]] = {
    "distance": "length",
    "topic": "nothing",
    "python": "otherwise",
}
"""How errors of measured poses change the margin of a rule, by the rule's kind."""


def _attached(clause: Clause, policies: Mapping[str, Policy], spec: ScenarioSpec) -> Clause:
    if isinstance(clause, Junction):
        return replace(clause, operands=tuple(_attached(one, policies, spec) for one in clause.operands))
    policy = policies.get(clause.iri)
    if policy is None or clause.time is None:
        return clause
    time = _with_horizon(clause.time, policy.horizon)
    if isinstance(clause, Fluent) and clause.predicate.duration is not None:
        return Fluent(_of_durations(policy), {}, time, clause.iri, condition=clause.condition)
    return Fluent(_predicate(policy, spec, clause.named), {}, time, clause.iri, condition=clause.condition)


def _with_horizon(time: TimeConstraint, horizon: float | None) -> TimeConstraint:
    if horizon is None or not isinstance(time, Before | After):
        return time
    return replace(time, horizon=horizon)


def _predicate(policy: Policy, spec: ScenarioSpec, arguments: Mapping[str, Any]) -> Predicate:
    judge = Judge(policy, spec, arguments)
    unit = "m" if policy.rule.kind == "distance" else ""
    measured, error = MEASURED[policy.rule.kind], noise_of(policy)
    return Predicate(policy.iri, "", "", (), "", unit, "", judge.margins, measured=measured, error=error)


def _of_durations(policy: Policy) -> Predicate:
    """Return a predicate of which nothing is known, for a clause on the time between two events."""

    def refuse(_evidence: Evidence, _arguments: Arguments) -> FloatArray:
        raise Unobserved(NO_DURATION)

    return Predicate(policy.iri, "", "", (), "", "", "", refuse)


def noise_of(policy: Policy) -> float:
    """Return the error (m) that a distance between the observed elements exceeds only with a stated improbability.

    It is ``sigma`` times the standard deviation of the distance between two positions with independent noise on each
    axis: to first order, the root of the sum of both variances. It is 0 if the policy states no ``sigma``.
    """
    each = [one.provider.noise for one in policy.observations for _ in one.targets]
    return (policy.sigma or 0.0) * math.hypot(*each)


@dataclass(frozen=True, slots=True)
class Judge:
    """Judges the windows of one clause of one scenario by a policy.

    ``own`` are the values of the clause's slots and of the variables of its quantifiers.
    """

    policy: Policy
    spec: ScenarioSpec
    own: Mapping[str, Any]

    def margins(self, evidence: Evidence, _arguments: Arguments) -> FloatArray:
        """Return the margin at each sample of a window, shape (n,).

        Raises ``Unobserved`` if a simulation cannot provide the observations, and ``UserCodeError`` if users' code
        fails.
        """
        rule = self.policy.rule
        if rule.kind == "topic" and evidence.is_logged:
            return _reported(rule.name, evidence)
        if rule.kind == "topic":
            raise Unobserved(f"its verdicts come from the ROS topic '{rule.name}', which a simulation does not have")
        streams = self._streams(evidence)
        if rule.kind == "python":
            return self._by_code(rule.name, Observed(evidence, {stream.target: stream for stream in streams}))
        if len(streams) != 2:
            raise Unobserved(f"a distance is between two elements, but {len(streams)} are observed")
        return distance_margins(rule, *streams)

    def _streams(self, evidence: Evidence) -> list[Stream]:
        found: list[Stream] = []
        for observation in self.policy.observations:
            provider, view = observation.provider, observation.provider.view
            if view is not None:
                provider = replace(provider, view=replace(view, sensor=self._element(view.sensor)))
            seen = replace(observation, provider=provider)
            found += [Stream(seen, self._element(one), evidence, self.spec.seed) for one in observation.targets]
        return found

    def _element(self, target: str) -> str:
        """Return the element that a target stands for, if it is a variable. Raises ``Unobserved`` for a set."""
        value: object = self.spec.values.get(target, self.own.get(plain_name(target), target))
        if not isinstance(value, str):
            raise Unobserved(f"the observed target must be one element, but {target} is {value}")
        return value

    def _by_code(self, name: str, evidence: Observed) -> FloatArray:
        arguments = {**{plain_name(variable): value for variable, value in self.spec.values.items()}, **self.own}
        try:
            evaluate = load_attribute(name, self.spec.model)
            return _as_margins(name, evaluate, call_user_code(name, evaluate, evidence, arguments), len(evidence.times))
        except UserCodeError as error:
            raise UserCodeError(str(error), replace(error.fault, origin=self.policy.iri)) from error


class Observed:
    """The evidence of a window with observed positions instead of true ones. All arrays are copies."""

    def __init__(self, evidence: Evidence, streams: Mapping[str, Stream]) -> None:
        self._evidence = evidence
        self._streams = streams

    @property
    def times(self) -> FloatArray:
        """The simulated time of each sample, s, shape (n,)."""
        return self._evidence.times.copy()

    def position(self, name: str) -> FloatArray:
        """Return the last observed position of an element at each sample, m, shape (n, 3).

        Raises ``KeyError`` for an element that is not observed.
        """
        return self._streams[name].positions.copy()

    def stamps(self, name: str) -> FloatArray:
        """Return the time at which each position of an element was observed, s, shape (n,). Raises ``KeyError``."""
        return self._streams[name].stamps.copy()


def _reported(topic: str, evidence: Evidence) -> FloatArray:
    """Return the verdicts of a topic of a log as margins of ±1, shape (n,). Raises ``Unobserved``."""
    try:
        return evidence.truth(topic)
    except KeyError:
        raise Unobserved(f"its verdicts come from the ROS topic '{topic}', which the log does not have") from None


def distance_margins(rule: Rule, one: Stream, other: Stream) -> FloatArray:
    """Return the margin (m) of the distance between two elements at each sample, shape (n,).

    Raises ``Unobserved`` if the observations of the elements are too far apart in time.
    """
    apart = np.abs(one.stamps - other.stamps)
    if rule.max_time_offset is not None and (worst := float(apart.max())) > rule.max_time_offset + 1e-9:
        raise Unobserved(f"the observations are {worst:.3g} s apart, more than {rule.max_time_offset:g} s")
    distance = np.linalg.norm(one.positions - other.positions, axis=1)
    match rule.form, rule.bounds:
        case "less-than", (bound,):
            return bound - distance
        case "greater-than", (bound,):
            return distance - bound
        case "between", (lower, upper):
            return np.minimum(distance - lower, upper - distance)
        case "equals", (value, tolerance):
            return tolerance - np.abs(distance - value)
        case form, bounds:
            raise Unobserved(f"there is no comparison '{form}' of a distance with {len(bounds)} bounds")


def _as_margins(name: str, evaluate: object, answer: Any, count: int) -> FloatArray:
    """Return the answer of users' code as margins for all samples.

    Numbers do not change; true is 1, and false is -1.
    """
    values = np.asarray(answer)
    if values.dtype == bool:
        values = np.where(values, 1.0, -1.0)
    if values.dtype.kind not in "fiu" or values.shape not in ((), (count,)):
        message = f"{name} must return one number or truth value, or one for each of the {count} samples"
        raise refused(name, message, definition_of(evaluate))
    if not np.all(np.isfinite(values)):
        message = f"{name} must return finite numbers, but {np.count_nonzero(~np.isfinite(values))} are not"
        raise refused(name, message, definition_of(evaluate))
    return np.broadcast_to(values.astype(float), (count,))
