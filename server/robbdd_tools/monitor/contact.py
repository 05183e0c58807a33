"""Contacts of an agent with what it was not to touch, or what no clause speaks of."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Contact:
    """A contact of an agent, or of the ``part`` that it gripped (empty: of the agent itself), with something else.

    ``time`` (s) is that of the sample after it began, ``peak`` (N) its largest force and ``peak_time`` (s) the sample
    after that, ``impulse`` (N s) the force over all the time that it lasted.
    """

    agent: str
    part: str
    other: str
    time: float
    peak: float
    peak_time: float
    impulse: float
