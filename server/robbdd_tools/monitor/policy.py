"""Policies, their observations and the sources of these, as plain data: how a clause is observed.

Names are IRIs in the graph's data and CURIEs in a run. Python code is named ``module:attribute``; nothing here imports
it.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Provider:
    """A source of observations.

    ``kind`` is ``ground-truth``, ``entity-state``, ``transforms`` or ``topic``; ``rate`` in Hz. ``noise`` (m) is the
    standard deviation of a position by axis and ``latency`` (s) the age of an observation; both apply to ground truth.
    ``source`` is the topic or the reference frame, ``type`` the topic's message type.
    """

    iri: str
    kind: str
    rate: float | None = None
    noise: float = 0.0
    latency: float = 0.0
    source: str = ""
    type: str = ""


@dataclass(frozen=True, slots=True)
class Observation:
    """The observed part of a scene: variables and elements, in written order.

    ``mapped`` maps names in a message to elements; ``entity_mapper`` and ``time_extractor`` are code.
    """

    iri: str
    provider: Provider
    targets: tuple[str, ...]
    time_extractor: str = ""
    entity_mapper: str = ""
    mapped: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Rule:
    """How observations are turned into a verdict.

    ``kind`` is ``distance`` (``form`` is ``less-than``, ``greater-than``, ``between`` or ``equals``; ``bounds`` in m:
    one bound, two, or value and tolerance; ``max_time_offset`` in s between two observations), ``python`` (``name`` is
    the code) or ``topic`` (``name`` is the topic of verdicts).
    """

    kind: str
    name: str = ""
    form: str = ""
    bounds: tuple[float, ...] = ()
    max_time_offset: float | None = None


@dataclass(frozen=True, slots=True)
class Policy:
    """The rule that judges a clause, and its observations; ``horizon`` in s, ``None`` if not given.

    ``origin`` is the policy's source position, ``file:line:column``; empty for a graph without source text.
    """

    iri: str
    clause: str
    rule: Rule
    horizon: float | None = None
    observations: tuple[Observation, ...] = ()
    origin: str = ""
