"""Poses of several things in one message: name their frames, and find names that are ambiguous."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robbdd_tools.catalog.api import FloatArray

SHORTER = 0.005
"""The least way (m) that two things save by an exchange of their indices, if this is not due to noise."""
Pose = tuple[tuple[float, float, float], tuple[float, float, float, float]]
"""Position (m) and orientation (w, x, y, z)."""


def frame_in(topic: str, name: str) -> str:
    """Return the frame of a thing in a list: ``objects/cup`` on ``/objects``, ``states/arm/tool`` for ``arm::tool``."""
    return f"{topic.strip('/')}/{name.replace('::', '/').strip('/')}"


@dataclass
class PoseLists:
    """The names of things in the lists of each topic.

    A name identifies a thing only if it never has two places at one time. A thing without a name is named by its index.
    The index identifies the thing only if all lists of the topic have the same length and the things keep their order:
    between two lists, no two of them would have moved less with exchanged indices.
    """

    nameless: set[str] = field(default_factory=set[str])
    """Topics on which a thing has neither an identity nor a class."""
    _places: dict[str, FloatArray] = field(default_factory=dict[str, "FloatArray"])
    _reordered: dict[str, tuple[int, int]] = field(default_factory=dict[str, tuple[int, int]])
    _lengths: dict[str, set[int]] = field(default_factory=dict[str, set[int]])
    _twice: dict[str, str] = field(default_factory=dict[str, str])
    _last: dict[str, tuple[int, tuple[float, float, float]]] = field(
        default_factory=dict[str, tuple[int, tuple[float, float, float]]]
    )

    def unnamed(self, topic: str, poses: Sequence[Pose]) -> list[str]:
        """Return the frames of the things in a list without names."""
        name, count = topic.strip("/"), len(poses)
        self._lengths.setdefault(name, set()).add(count)
        places = np.array([place for place, _ in poses], dtype=float).reshape(count, 3)
        before = self._places.get(name)
        if name not in self._reordered and before is not None and len(before) == count:
            exchanged = _exchanged(before, places)
            if exchanged is not None:
                self._reordered[name] = exchanged
        self._places[name] = places
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
        is_disordered = topic in self._reordered or len(self._lengths.get(topic, ())) > 1
        return frame in self._twice or (name.isdigit() and is_disordered)

    def remarks(self) -> list[str]:
        """Return a sentence on each topic with ambiguous frames. It says how to record the topic."""
        words = "poses, so an index is not always the same thing: they are not used"
        found = [
            f"the lists on '/{topic}' have from {min(lengths)} to {max(lengths)} {words}; record names with them"
            for topic, lengths in self._lengths.items()
            if len(lengths) > 1
        ]
        for topic, (one, other) in self._reordered.items():
            named = f"the poses on '/{topic}' (such as {one} and {other}) change their order"
            found.append(
                f"{named}, so an index is not always the same thing: they are not used; record names with them"
            )
        for frame, topic in self._twice.items():
            words = "is at two places at one time, so it is not used; record an id for each thing"
            found.append(f"'{frame}' on '{topic}' {words}")
        for topic in sorted(self.nameless):
            found.append(f"things on '{topic}' have neither an id nor a class, so they are not used")
        return found


def _exchanged(before: FloatArray, after: FloatArray) -> tuple[int, int] | None:
    """Return two indices of places (n, 3) in m whose exchange makes the ways of both things shorter together."""
    ways = np.linalg.norm(after[:, None] - before[None], axis=2)
    own = np.diag(ways)
    saved = own[:, None] + own[None] - ways - ways.T
    if not saved.size or not np.nanmax(saved, initial=0.0) > SHORTER:
        return None
    one, other = divmod(int(np.nanargmax(saved)), len(after))
    return min(one, other), max(one, other)
