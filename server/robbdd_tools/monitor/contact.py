"""Contacts of an agent that a clause forbids, or that no clause mentions."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Contact:
    """A contact of an agent (or of ``part``, the object in its grip, if not empty) with something else.

    ``time`` (s) is the first sample after it began, ``peak`` (N) its largest force, ``peak_time`` (s) the first sample
    after the peak, ``impulse`` (N s) the force integrated over the whole contact.
    """

    agent: str
    part: str
    other: str
    time: float
    peak: float
    peak_time: float
    impulse: float
