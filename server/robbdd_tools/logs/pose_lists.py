"""Poses of several things in one message: name their frames, and find names that are ambiguous."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

Pose = tuple[tuple[float, float, float], tuple[float, float, float, float]]
"""Position (m) and orientation (w, x, y, z)."""


def frame_in(topic: str, name: str) -> str:
    """Return the frame of a thing in a list: ``objects/cup`` on ``/objects``, ``states/arm/tool`` for ``arm::tool``."""
    return f"{topic.strip('/')}/{name.replace('::', '/').strip('/')}"


@dataclass
class PoseLists:
    """The names of things in the lists of each topic.

    A name identifies a thing only if it never has two places at one time. A thing without a name is named by its index.
    The index identifies the thing only if all lists of the topic have the same length.
    """

    nameless: set[str] = field(default_factory=set[str])
    """Topics on which a thing has neither an identity nor a class."""
    _lengths: dict[str, set[int]] = field(default_factory=dict[str, set[int]])
    _twice: dict[str, str] = field(default_factory=dict[str, str])
    _last: dict[str, tuple[int, tuple[float, float, float]]] = field(
        default_factory=dict[str, tuple[int, tuple[float, float, float]]]
    )

    def unnamed(self, topic: str, count: int) -> list[str]:
        """Return the frames of the things in a list without names."""
        self._lengths.setdefault(topic.strip("/"), set()).add(count)
        return [frame_in(topic, str(index)) for index in range(count)]

    def named(self, topic: str, names: Sequence[str]) -> list[str]:
        """Return the frames of the things in a list with names."""
        frames = [frame_in(topic, name) for name in names]
        self._twice |= {frame: topic for frame, count in Counter(frames).items() if count > 1}
        return frames

    def seen(self, topic: str, frame: str, time: int, place: tuple[float, float, float]) -> None:
        """Record the place (m) of a thing that is published alone, at a ``time`` in ns."""
        before = self._last.get(frame)
        if before is not None and before[0] == time and before[1] != place:
            self._twice[frame] = topic
        self._last[frame] = time, place

    def ambiguous(self, frame: str) -> bool:
        """Return whether a frame may stand for different things."""
        topic, _, name = frame.rpartition("/")
        return frame in self._twice or (name.isdigit() and len(self._lengths.get(topic, ())) > 1)

    def remarks(self) -> list[str]:
        """Return a sentence on each topic with ambiguous frames. It says how to record the topic."""
        words = "poses, so an index is not always the same thing: they are not used"
        found = [
            f"the lists on '/{topic}' have from {min(lengths)} to {max(lengths)} {words}; record names with them"
            for topic, lengths in self._lengths.items()
            if len(lengths) > 1
        ]
        for frame, topic in self._twice.items():
            words = "is at two places at one time, so it is not used; record an id for each thing"
            found.append(f"'{frame}' on '{topic}' {words}")
        for topic in sorted(self.nameless):
            found.append(f"things on '{topic}' have neither an id nor a class, so they are not used")
        return found
