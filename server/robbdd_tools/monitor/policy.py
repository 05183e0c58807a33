"""Observation policies as plain data: the observations that a clause is judged by, and their sources.

Names are IRIs in the data of the graph and CURIEs in a run. Python code is named ``module:attribute``, and this module
never imports it.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class View:
    """The limits of a sensor: it sees elements from ``nearest`` to ``farthest`` (m) away from its carrier ``sensor``.

    With an ``angle`` (rad), only those in the cone with this opening angle around the carrier's z axis.
    """

    sensor: str
    nearest: float
    farthest: float
    angle: float | None = None


@dataclass(frozen=True, slots=True)
class Provider:
    """A source of observations.

    - ``kind``: ``ground-truth``, ``entity-state``, ``transforms`` or ``topic``.
    - ``rate``: the rate of observations in Hz.
    - ``noise``: the standard deviation of a position on each axis in m.
    - ``latency``: the age of an observation in s, for ground truth.
    - ``source``: the topic or the reference frame.
    - ``type``: the message type of the topic.
    - ``view``: what the sensor can see; ``None`` if it sees everything.
    - ``misses``: the probability that an observation of a visible element fails.
    """

    iri: str
    kind: str
    rate: float | None = None
    noise: float = 0.0
    latency: float = 0.0
    source: str = ""
    type: str = ""
    view: View | None = None
    misses: float = 0.0


@dataclass(frozen=True, slots=True)
class Observation:
    """The observed part of a scene: its variables and elements, in written order.

    ``mapped`` maps names in a message to elements. ``entity_mapper`` and ``time_extractor`` are names of Python code.
    """

    iri: str
    provider: Provider
    targets: tuple[str, ...]
    time_extractor: str = ""
    entity_mapper: str = ""
    mapped: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Rule:
    """The rule that turns observations into a verdict.

    - ``kind``: ``distance``, ``python`` or ``topic``.
    - ``name``: the Python code, or the topic of verdicts.
    - ``form``: how a distance is compared: ``less-than``, ``greater-than``, ``between`` or ``equals``.
    - ``bounds``: the bounds of the distance in m: one bound, two bounds, or a value and a tolerance.
    - ``max_time_offset``: the largest permitted time between two observations in s.
    """

    kind: str
    name: str = ""
    form: str = ""
    bounds: tuple[float, ...] = ()
    max_time_offset: float | None = None


@dataclass(frozen=True, slots=True)
class Policy:
    """The rule that judges a clause, and its observations. ``horizon`` is in s; ``None`` if not given.

    A verdict is only certain if its margin exceeds the noise of the observations ``sigma`` times; ``None`` if
    observations count as exact.

    ``origin`` is the source position of the policy, ``file:line:column``; empty for a graph without source text.
    """

    iri: str
    clause: str
    rule: Rule
    horizon: float | None = None
    observations: tuple[Observation, ...] = ()
    origin: str = ""
    sigma: float | None = None
