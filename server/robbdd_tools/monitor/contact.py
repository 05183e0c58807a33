"""Contacts of an agent that a clause forbids, or that no clause mentions."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Contact:
    """A contact of an agent with something else.

    If ``part`` is not empty, the object ``part`` in its grip has the contact.

    - ``time``: the first sample after the contact began (s).
    - ``peak``: the largest force (N).
    - ``peak_time``: the first sample after the largest force (s).
    - ``impulse``: the force integrated over the whole contact (N s).
    """

    agent: str
    part: str
    other: str
    time: float
    peak: float
    peak_time: float
    impulse: float
