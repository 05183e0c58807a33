"""The request to judge a log, as the process that judges it reads it from the run folder."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

LOG_REQUEST = "log.json"
"""Name of the file of the request in the run folder."""


@dataclass(frozen=True, slots=True)
class LogRequest:
    """A log and the way in which its names are read.

    - ``path``: the absolute path of the log.
    - ``frames``: maps an element (local name or CURIE) to its frame in the log. Other frames are found by name.
    - ``world``: the frame of the world; empty for the root of the used frames.
    - ``max_gap``: the largest time (s) between two observations of a frame for interpolation between them.
    - ``rate``: the largest number of samples of the trace per second.
    - ``uncertainty``: the largest error of the position of an element (local name or CURIE) or of ``OTHERS``, in m; of
      ``angle``, in rad; of ``speed``, in m/s.
    - ``bases``: maps an agent (local name or CURIE) to the frame of the base of its model.
    - ``joint_topics``: maps an agent to the topic of the states of its joints.
    - ``joints``: maps a joint of a model, or ``agent/joint``, to its name in the log.
    - ``columns``: maps the name of a column of a table to its title in the file.
    - ``grips``: signals that say when an agent holds something, as ``protocol/grip_signals`` reads them.
    - ``clocks``: maps a topic of a ROS bag to the time (s) by which the clock of its headers is ahead.
    - ``signals``: signals that report events, as ``protocol/event_signals`` reads them.
    - ``begin``, ``end``: the period that is judged, s since the start of the log; ``None`` if the user states none.
    - ``quiet``: the log is still being recorded; it ends when nothing was written for this time (s). ``None`` for a
      complete log.
    - ``annotations``: the absolute path of a table of further events; empty if there is none.
    """

    path: str
    frames: Mapping[str, str] = field(default_factory=dict[str, str])
    world: str = ""
    max_gap: float = 0.5
    rate: float = 200.0
    annotations: str = ""
    uncertainty: Mapping[str, float] = field(default_factory=dict[str, float])
    bases: Mapping[str, str] = field(default_factory=dict[str, str])
    joint_topics: Mapping[str, str] = field(default_factory=dict[str, str])
    joints: Mapping[str, str] = field(default_factory=dict[str, str])
    columns: Mapping[str, str] = field(default_factory=dict[str, str])
    grips: tuple[str, ...] = ()
    clocks: Mapping[str, float] = field(default_factory=dict[str, float])
    signals: tuple[str, ...] = ()
    begin: float | None = None
    end: float | None = None
    quiet: float | None = None
