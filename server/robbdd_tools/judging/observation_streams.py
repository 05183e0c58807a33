"""Simulate the observations of an element's position, with the rate, latency and noise of a provider."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.catalog.geometry import out_of_frame
from robbdd_tools.judging.detection import failures, last_seen, words_of
from robbdd_tools.monitor.unobserved import Unobserved

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Evidence, FloatArray
    from robbdd_tools.judging.detection import Codes
    from robbdd_tools.monitor.policy import Observation, Provider

LONGEST_GAP = 0.5
"""Nothing is known of an element that was not seen for longer than this (s), as in a log by default."""
SOURCES = {"topic": "a ROS topic", "entity-state": "ROS entity states", "transforms": "ROS transforms"}


class Stream:
    """The observations of one element that are known at each sample of a window.

    The provider observes at the times k / rate, if its sensor sees the element then. An observation is known after the
    latency. Each axis has noise that depends only on the seed, the observation and k. ``positions`` (n, 3) m are the
    last known positions, and ``stamps`` (n,) s are the times at which they were observed. The samples of a log are
    already observations and are used unchanged. Raises ``Unobserved`` if the simulation does not have the provider, if
    no observation is known yet, or if the last one is ``LONGEST_GAP`` older than usual.
    """

    def __init__(self, observation: Observation, target: str, evidence: Evidence, seed: int) -> None:
        self.target = target
        provider = observation.provider
        if evidence.is_logged:
            self.stamps: FloatArray = evidence.times
            self.positions: FloatArray = _truth(evidence, target, evidence.times)
            return
        if provider.kind != "ground-truth":
            where = SOURCES.get(provider.kind, provider.kind) + (f" '{provider.source}'" if provider.source else "")
            raise Unobserved(f"{target} is observed by {where}, which a simulation does not have")
        rate = provider.rate
        if rate is None or rate <= 0:
            raise Unobserved(f"the update rate of the provider of {target} must be above 0 Hz")
        looks = np.floor((evidence.times - provider.latency) * rate + 1e-6).astype(int)
        if looks.min(initial=0) < 0:
            first = float(evidence.times[int(np.argmin(looks))])
            raise Unobserved(f"nothing was known of {target} at {first:.2f} s: it is seen {provider.latency:g} s later")
        ticks = np.arange(int(looks.max(initial=0)) + 1)
        name = f"{observation.iri} {target}"
        codes = _failures(provider, target, evidence, ticks / rate, _random(seed, f"{name} misses"))
        latest = last_seen(codes)
        unseen = np.flatnonzero((latest[looks] < 0) | (looks - latest[looks] > LONGEST_GAP * rate))
        if unseen.size:
            look = int(looks[unseen[0]])
            raise Unobserved(_gap(target, latest[look] / rate, look / rate, words_of(int(codes[look]), provider.view)))
        self.stamps = latest[looks] / rate
        noise = _random(seed, name).standard_normal((len(ticks), 3)) * provider.noise
        self.positions = _truth(evidence, target, self.stamps) + noise[latest[looks]]


def _failures(
    provider: Provider, target: str, evidence: Evidence, times: FloatArray, random: np.random.Generator
) -> Codes:
    chances = random.random(len(times))
    places = _truth(evidence, target, times)
    if provider.view is None:
        return failures(provider, places, None, chances)
    carrier = provider.view.sensor
    sensor = evidence.position_at(carrier, times), evidence.orientation_at(carrier, times)
    return failures(provider, places, sensor, chances)


def _gap(target: str, start: float, end: float, why: str) -> str:
    if start < 0:
        return f"nothing was known of {target} at {end:.2f} s: {why}"
    return f"{target} was not observed between {start:.2f} s and {end:.2f} s: {why}"


def _truth(evidence: Evidence, target: str, stamps: FloatArray) -> FloatArray:
    """Return the true positions (n, 3) m at the last samples at or before some times.

    The position of a workspace is the position of its first region.
    """
    if target not in evidence.workspaces:
        return evidence.position_at(target, stamps)
    carrier, region = evidence.regions(target)[0]
    return out_of_frame(region.center, evidence.position_at(carrier, stamps), evidence.orientation_at(carrier, stamps))


def _random(seed: int, name: str) -> np.random.Generator:
    """Return a generator for an observation. A longer array of its numbers begins with those of a shorter one."""
    digest = hashlib.sha256(f"{seed} {name}".encode()).digest()
    return np.random.default_rng(int.from_bytes(digest[:8], "big"))
