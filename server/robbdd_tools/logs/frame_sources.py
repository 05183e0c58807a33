"""Frames that several topics publish: choose the topic that counts, and rename the frames of the others."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from robbdd_tools.logs.track_builder import TrackBuilder

if TYPE_CHECKING:
    from robbdd_tools.logs.log_contents import Track
    from robbdd_tools.logs.stored_rows import Nanoseconds

TRANSFORMS = "tf"
STATIC = "tf_static"
MAX_LISTED = 4


@dataclass
class FrameSources:
    """The poses of frames, kept apart by the topic that publishes them.

    Two robots may each have a ``base_link``, in transforms of their own (``/r1/tf``, ``/r2/tf``). Poses from another
    topic, such as wheel odometry, are never mixed with those of the transforms.
    """

    _transforms: dict[str, TrackBuilder] = field(default_factory=dict[str, TrackBuilder])
    _topics: dict[str, TrackBuilder] = field(default_factory=dict[str, TrackBuilder])

    def of_transforms(self, topic: str) -> TrackBuilder:
        """Return the builder of a topic of transforms. Static and moving ones of a namespace share a builder."""
        found = self._transforms.get(topic)
        if found is None:
            # Static transforms are few; other topics take this branch only once.
            found = self._transforms.setdefault(_group(topic), TrackBuilder())
        return found

    def of_topic(self, topic: str) -> TrackBuilder:
        """Return the builder of a topic that publishes poses."""
        found = self._topics.get(topic)
        if found is None:
            found = self._topics[topic] = TrackBuilder()
        return found

    def absorb(self, other: FrameSources) -> None:
        """Add the poses of another object."""
        for topic, builder in other._transforms.items():
            self.of_transforms(topic).absorb(builder)
        for topic, builder in other._topics.items():
            self.of_topic(topic).absorb(builder)

    def drop(self, topic: str, frame: str) -> None:
        """Forget the poses of a frame on a topic."""
        for builder in (self._transforms.get(_group(topic)), self._topics.get(topic)):
            if builder is not None:
                builder.drop(frame)

    def retime(self, convert: Callable[[Nanoseconds], Nanoseconds]) -> None:
        """Replace the times (ns) of all poses."""
        for builder in (*self._transforms.values(), *self._topics.values()):
            builder.retime(convert)

    def bounds(self) -> list[int]:
        """Return the times of the earliest and latest poses that are not static, ns."""
        return [time for one in (*self._transforms.values(), *self._topics.values()) for time in one.bounds()]

    def tracks(self, begin: int, remarks: list[str]) -> dict[str, Track]:
        """Return the tracks by their names, with times in s since ``begin`` (ns). Adds its decisions to ``remarks``."""
        moved = {topic: builder.tracks(begin, remarks) for topic, builder in self._transforms.items()}
        found = _joined(moved, remarks)
        others: dict[str, dict[str, Track]] = {}
        for topic, builder in self._topics.items():
            for frame, track in builder.tracks(begin, remarks).items():
                others.setdefault(frame, {})[topic] = track
        for frame, tracks in others.items():
            if frame in found:
                remarks += _outranked(frame, found[frame], tracks)
            elif len(tracks) == 1:
                found[frame] = next(iter(tracks.values()))
            else:
                found |= {topic.strip("/"): track for topic, track in tracks.items()}
                listed = ", ".join(f"'{topic.strip('/')}'" for topic in tracks)
                remarks.append(f"several topics have poses of '{frame}': they are called {listed}")
        return found


def _group(topic: str) -> str:
    """Return the topic of moving transforms that belongs to a topic of static ones."""
    space, _, name = topic.rpartition("/")
    return f"{space}/{TRANSFORMS}" if name == STATIC else topic


def _joined(groups: Mapping[str, dict[str, Track]], remarks: list[str]) -> dict[str, Track]:
    """Return the transforms of all namespaces. A frame that several namespaces have gets its namespace as prefix."""
    count: dict[str, int] = {}
    for tracks in groups.values():
        for frame in tracks:
            count[frame] = count.get(frame, 0) + 1
    found: dict[str, Track] = {}
    for topic, tracks in groups.items():
        space = topic.strip("/")
        space = space.removesuffix(TRANSFORMS).rstrip("/") if space.rpartition("/")[2] == TRANSFORMS else space
        names = {frame: f"{space}/{frame}" for frame in tracks if count[frame] > 1 and space}
        for frame, track in tracks.items():
            found[names.get(frame, frame)] = _renamed(track, names)
        if names:
            listed = ", ".join(f"'{name}'" for name in list(names.values())[:MAX_LISTED])
            listed += f" and {len(names) - MAX_LISTED} more" if len(names) > MAX_LISTED else ""
            remarks.append(f"several topics have frames of the same names: those of '{topic}' are called {listed}")
    return found


def _renamed(track: Track, names: Mapping[str, str]) -> Track:
    later = tuple(replace(one, parent=names.get(one.parent, one.parent)) for one in track.later)
    return replace(track, parent=names.get(track.parent, track.parent), later=later)


def _outranked(frame: str, used: Track, others: Mapping[str, Track]) -> list[str]:
    """Return sentences on topics whose poses are not used because the transforms give the frame another parent."""
    return [
        f"'{frame}' is in '{track.parent}' on '{topic}', but in '{used.parent}' by the transforms, which are used"
        for topic, track in others.items()
        if track.parent != used.parent
    ]
