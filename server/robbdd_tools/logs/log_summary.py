"""The names in a log, with rates and times: what an editor needs to know of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Topic:
    """A topic: the type of its messages, their number, and the paths of the type's fields with their types."""

    type: str
    count: int
    fields: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class FrameSummary:
    """The poses of a frame in a log: how many there are, and the times of the first and the last one, s.

    ``static`` is true if the frame never moves relative to its ``parent``.
    """

    parent: str
    count: int
    first: float
    last: float
    static: bool = False

    @property
    def rate(self) -> float:
        """The mean rate in Hz; 0 for fewer than two poses."""
        span = self.last - self.first
        return (self.count - 1) / span if span > 0 else 0.0


@dataclass(frozen=True, slots=True)
class LogSummary:
    """The names in a log.

    - ``topics``: maps a topic to its type, fields and number of messages.
    - ``frames``: maps a frame to its poses.
    - ``joints``: maps a topic of joint states to the names of its joints.
    - ``texts``: the different texts, in alphabetical order.
    - ``end``: the time of the last message, s since the first.
    - ``problem``: why the log cannot be judged; else empty.
    """

    topics: Mapping[str, Topic] = field(default_factory=dict[str, Topic])
    frames: Mapping[str, FrameSummary] = field(default_factory=dict[str, FrameSummary])
    joints: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    texts: tuple[str, ...] = ()
    end: float = 0.0
    problem: str = ""

    def rate(self, topic: str) -> float:
        """Return the mean rate of a topic's messages over the whole log, Hz."""
        return self.topics[topic].count / self.end if self.end > 0 else 0.0

    def names_of_frames(self) -> frozenset[str]:
        """Return the names of all frames, also of those that are only parents of others."""
        return frozenset((*self.frames, *(one.parent for one in self.frames.values() if one.parent)))
