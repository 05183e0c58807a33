"""Syntax trees of executions: behaviour implementations, observations, policies, scenario executions.

Numbers are kept as written, together with their units if the language allows several units.
"""

from __future__ import annotations

from dataclasses import dataclass

from robbdd_tools.syntax.scene_tree import (
    CatalogEntry,
    Link,
    Name,
    NamespaceArgument,
    Node,
    Number,
    PythonAttribute,
    Quantity,
    Ref,
    Text,
)


@dataclass(frozen=True, slots=True)
class RosAction(Node):
    """``bhv action: "/name"``."""

    action: Text


@dataclass(frozen=True, slots=True)
class ProcessSystem(Node):
    """``process "command"``, with the time within which the process must answer."""

    command: Text
    limit: Number | None


@dataclass(frozen=True, slots=True)
class EndpointSystem(Node):
    """``endpoint "ws://…"``, with the time within which the endpoint must answer."""

    address: Text
    limit: Number | None


@dataclass(frozen=True, slots=True)
class Implementation(Node):
    """``bhv impl (ns=…) name { … }``."""

    namespace: NamespaceArgument
    name: Name
    source: RosAction | PythonAttribute | CatalogEntry | ProcessSystem | EndpointSystem


@dataclass(frozen=True, slots=True)
class RosTopic(Node):
    """``ros topic: "/name" type: "pkg/msg/Type" [noise: … unit]``; ``noise`` as in ``GroundTruth``."""

    topic: Text
    type: Text
    noise: Number | None
    noise_unit: str | None


@dataclass(frozen=True, slots=True)
class SimulatedStates(Node):
    """``ros simulation entity state update-rate: … Hz``."""

    rate: Number


@dataclass(frozen=True, slots=True)
class Transforms(Node):
    """``ros transform listener reference-frame: "…" update-rate: … Hz [noise: … unit]``."""

    frame: Text
    rate: Number
    noise: Number | None
    noise_unit: str | None


@dataclass(frozen=True, slots=True)
class SensorView(Node):
    """``range: … to … from target [field of view: … deg]``."""

    nearest: Distance
    farthest: Distance
    sensor: Link
    angle: Number | None


@dataclass(frozen=True, slots=True)
class GroundTruth(Node):
    """``simulation ground truth update-rate: … Hz [noise: … unit] [latency: … s] [range: …] [misses: … %]``.

    ``noise`` is the standard deviation of a position along each axis.
    """

    rate: Number
    noise: Number | None
    noise_unit: str | None
    latency: Number | None
    view: SensorView | None
    misses: Number | None


@dataclass(frozen=True, slots=True)
class Provider(Node):
    """``obs provider (ns=…) name { … }``."""

    namespace: NamespaceArgument
    name: Name
    source: RosTopic | SimulatedStates | Transforms | GroundTruth


@dataclass(frozen=True, slots=True)
class StringMapping(Node):
    """``"name in the message" to obj <…>``."""

    text: Text
    target: Link


@dataclass(frozen=True, slots=True)
class StringMapper(Node):
    """``string { … }``."""

    entries: tuple[StringMapping, ...]


@dataclass(frozen=True, slots=True)
class Observation(Node):
    """``observation (ns=…) name { provider: <…> observes … time extractor: … entity mapper: … }``."""

    namespace: NamespaceArgument
    name: Name
    provider: Ref
    targets: tuple[Link, ...]
    time_extractor: PythonAttribute | None
    entity_mapper: PythonAttribute | StringMapper | None


@dataclass(frozen=True, slots=True)
class Distance(Node):
    """A length with its unit: ``mm``, ``cm`` or ``m``."""

    value: Number
    unit: str


@dataclass(frozen=True, slots=True)
class LessThan(Node):
    """``less-than: d``."""

    bound: Distance


@dataclass(frozen=True, slots=True)
class GreaterThan(Node):
    """``greater-than: d``."""

    bound: Distance


@dataclass(frozen=True, slots=True)
class Between(Node):
    """``between: d and d``."""

    lower: Distance
    upper: Distance


@dataclass(frozen=True, slots=True)
class Equals(Node):
    """``equals: d tolerance: d``."""

    value: Distance
    tolerance: Distance


@dataclass(frozen=True, slots=True)
class LinearDistance(Node):
    """``linear distance { condition [max time offset: … s] }``."""

    condition: LessThan | GreaterThan | Between | Equals
    max_time_offset: Number | None


@dataclass(frozen=True, slots=True)
class TrinaryTopic(Node):
    """``trinary topic: "/name"``."""

    topic: Text


@dataclass(frozen=True, slots=True)
class Evaluation(Node):
    """``observations: { … } evaluator: …``."""

    observations: tuple[Ref, ...]
    evaluator: LinearDistance | PythonAttribute


@dataclass(frozen=True, slots=True)
class Policy(Node):
    """``obs policy (ns=…) name for <fluent> [horizon: … seconds] [certain beyond: … sigma] { … }``."""

    namespace: NamespaceArgument
    name: Name
    fluent: Ref
    horizon: Number | None
    sigma: Number | None
    rule: TrinaryTopic | Evaluation


@dataclass(frozen=True, slots=True)
class LogCondition(Node):
    """``<template.variable> = value``: the value with which the robot executed the scenario."""

    variable: Ref
    value: Ref | Quantity | Number | Text


@dataclass(frozen=True, slots=True)
class LogEvent(Node):
    """``<event> when "/topic becomes 2"``."""

    event: Ref
    signal: Text


@dataclass(frozen=True, slots=True)
class LogGrip(Node):
    """``<agent> while "/topic"``: the agent holds something while the signal is true."""

    agent: Ref
    signal: Text


@dataclass(frozen=True, slots=True)
class LogError(Node):
    """``3 mm of obj <…>``: the largest error of a measured position, angle or speed; without an element, of all."""

    size: Quantity
    target: Link | None


@dataclass(frozen=True, slots=True)
class RobotLog(Node):
    """``robot log (ns=…) name { path: "…" … }``: a recording of a real robot, and the meaning of the names in it.

    ``frames``, ``bases`` and ``joints`` map frames of things, frames of the bases of arms, and topics of joint states
    to elements.
    """

    namespace: NamespaceArgument
    name: Name
    path: Text
    conditions: tuple[LogCondition, ...]
    frames: tuple[StringMapping, ...]
    bases: tuple[StringMapping, ...]
    world: Text | None
    joints: tuple[StringMapping, ...]
    events: tuple[LogEvent, ...]
    grips: tuple[LogGrip, ...]
    annotations: Text | None
    errors: tuple[LogError, ...]


@dataclass(frozen=True, slots=True)
class Execution(Node):
    """``Scenario Exec (ns=…) name { … }``; ``timeout`` in seconds of simulated time.

    ``log`` is the recording on which ``robbdd judge`` judges the execution.
    """

    namespace: NamespaceArgument
    name: Name
    variant: Ref
    scene: Ref
    behaviour: Ref
    policies: tuple[Ref, ...]
    repeat: Number | None
    seed: Number | None
    timeout: Number | None
    log: Ref | None
