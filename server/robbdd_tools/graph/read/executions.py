"""Read executions into plain data. Incomplete executions are left out."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

from robbdd_tools.catalog.executable import Implementation
from robbdd_tools.graph.acceptance_model import Execution, Iri
from robbdd_tools.graph.rdf.records import Incomplete, Records
from robbdd_tools.graph.read.instances import InstanceReader, Places, number, python_name
from robbdd_tools.graph.read.robot_logs import read_log_of
from robbdd_tools.monitor.policy import Observation, Policy, Provider, Rule, View

if TYPE_CHECKING:
    from rdflib.term import Node

_PROVIDERS = {
    "rbw:GroundTruth": "ground-truth",
    "rbw:RosTopic": "topic",
    "rbw:RosTransforms": "transforms",
    "rbw:RosEntityStates": "entity-state",
}


def read_executions(records: Records, instances: InstanceReader, places: Places) -> tuple[Execution, ...]:
    """Return the executions of a graph, in written order if the graph records this order."""
    nodes = records.instances("bdd:ScenarioExecution")
    found = [execution for node in nodes for execution in _complete(records, node, instances, places)]
    return tuple(sorted(found, key=lambda one: (_position(records, one.iri), one.iri)))


def read_implementations(records: Records, places: Places) -> tuple[Implementation, ...]:
    """Return all implementations of behaviours in a graph, in the order of their IRIs."""
    found: list[Implementation] = []
    for node in sorted(records.instances("bdd:BehaviourImplementation")):
        with suppress(Incomplete):
            found.append(replace(_implementation(records, node), origin=places(node)))
    return tuple(found)


def _complete(records: Records, node: Iri, instances: InstanceReader, places: Places) -> Iterator[Execution]:
    try:
        variant = records.one(node, "bdd:of-variant")
        named = records.one(node, "bdd:has-behaviour-implementation")
        implementation = replace(_implementation(records, named), origin=places(named))
    except Incomplete:
        return
    scene = next(iter(records.iris(records.all(node, "rbw:scene-instance"))), None)
    policies = records.iris(records.ordered(node, "obs:has-policy", "rbw:policy-list"))
    repeat, seed = number(records, node, "rbw:repeat"), number(records, node, "rbw:seed")
    yield Execution(
        node,
        variant,
        implementation,
        None if scene is None else instances.instance(scene),
        tuple(policy for iri in policies for policy in _policy(records, iri, places)),
        1 if repeat is None else max(1, int(repeat)),
        None if seed is None else int(seed),
        number(records, node, "rbw:timeout-seconds"),
        read_log_of(records, node, places),
    )


def _position(records: Records, node: str) -> float:
    position = number(records, node, "rbw:position")
    return float("inf") if position is None else position


def _implementation(records: Records, node: Iri) -> Implementation:
    if records.is_a(node, "py:ModuleAttribute"):
        return Implementation(node, "python", python_name(records, node))
    if records.is_a(node, "rbw:RosAction"):
        return Implementation(node, "ros-action", records.text(node, "rbw:ros-name"))
    limit = number(records, node, "rbw:answer-seconds")
    if records.is_a(node, "rbw:ExternalProcess"):
        return Implementation(node, "process", records.text(node, "rbw:command"), limit=limit)
    if records.is_a(node, "rbw:ExternalEndpoint"):
        return Implementation(node, "endpoint", records.text(node, "rbw:address"), limit=limit)
    name = records.text(node, "rbw:catalog-name")
    if not name:
        raise Incomplete(f"{node} does not name its implementation")
    return Implementation(node, "catalog", name)


def _policy(records: Records, node: Iri, places: Places) -> Iterator[Policy]:
    try:
        clause, rule = records.one(node, "bdd:of-clause"), _rule(records, node)
    except Incomplete:
        return
    named = records.iris(records.ordered(node, "rbw:observation", "rbw:observation-list"))
    observations = tuple(observation for iri in named for observation in _observation(records, iri))
    horizon, origin = number(records, node, "time:horizon-seconds"), places(node)
    sigma = number(records, node, "rbw:certain-beyond-sigma")
    yield Policy(node, clause, rule, horizon, observations, "" if origin is None else str(origin), sigma)


def _rule(records: Records, node: Iri) -> Rule:
    if records.is_a(node, "rbw:TrinaryTopic"):
        return Rule("topic", records.text(node, "rbw:ros-name"))
    evaluator = records.one(node, "rbw:evaluator")
    if records.is_a(evaluator, "py:ModuleAttribute"):
        return Rule("python", python_name(records, evaluator))
    bounds = tuple(float(str(value)) for value in records.list_of(evaluator, "rbw:bounds-metres"))
    form = records.text(evaluator, "rbw:comparison")
    return Rule("distance", "", form, bounds, number(records, evaluator, "rbw:max-time-offset-seconds"))


def _observation(records: Records, node: Iri) -> Iterator[Observation]:
    try:
        provider = _provider(records, records.one(node, "rbw:provider"))
        targets = records.iris(records.ordered(node, "rbw:observes", "rbw:observed-list"))
        extractors = [python_name(records, part) for part in records.iris(records.all(node, "rbw:time-extractor"))]
        mapper, mapped = _mapper(records, node)
    except Incomplete:
        return
    yield Observation(node, provider, targets, "".join(extractors), mapper, mapped)


def _mapper(records: Records, node: Iri) -> tuple[str, tuple[tuple[str, str], ...]]:
    for part in records.iris(records.all(node, "rbw:entity-mapper")):
        if records.is_a(part, "py:ModuleAttribute"):
            return python_name(records, part), ()
        entries: tuple[Node, ...] = records.list_of(part, "rbw:mappings")
        named = records.iris(entries)
        return "", tuple((records.text(one, "rbw:name"), records.one(one, "rbw:stands-for")) for one in named)
    return "", ()


def _provider(records: Records, node: Iri) -> Provider:
    kind = next((kind for term, kind in _PROVIDERS.items() if records.is_a(node, term)), "")
    if not kind:
        raise Incomplete(f"{node} does not name the provider of its observations")
    return Provider(
        node,
        kind,
        number(records, node, "rbw:rate-hertz"),
        number(records, node, "rbw:noise-metres") or 0.0,
        number(records, node, "rbw:latency-seconds") or 0.0,
        records.text(node, "rbw:ros-name"),
        records.text(node, "rbw:message-type"),
        _view(records, node),
        number(records, node, "rbw:missed-share") or 0.0,
    )


def _view(records: Records, node: Iri) -> View | None:
    nearest, farthest = number(records, node, "rbw:nearest-metres"), number(records, node, "rbw:farthest-metres")
    if nearest is None or farthest is None:
        return None
    angle = number(records, node, "rbw:field-of-view-radians")
    return View(records.one(node, "rbw:seen-from"), nearest, farthest, angle)
