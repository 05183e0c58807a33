"""Collect the poses of frames, and turn them into tracks."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.base.large_arrays import large_array
from robbdd_tools.logs.log_contents import Track
from robbdd_tools.logs.stored_rows import BLOCK, StoredRows

if TYPE_CHECKING:
    import numpy.typing as npt

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.logs.stored_rows import Nanoseconds

MIN_LENGTH = 0.5
"""Four numbers whose length is at least this are a quaternion that merely needs normalising."""
SAME = 1e-6
"""If positions (m) and quaternions differ by at most this, they are the same pose, published again."""
APART, OFTEN = 1e-3, 3
"""A frame has two places if its poses (m, quaternions) at one time differ by more than this, so many times."""
SHORTEST = 1.0
"""A frame that returns to a parent within this time (s) has both parents at once: nothing is grasped for less."""


@dataclass
class TrackBuilder:
    """Collects the poses of frames in any order of time. Times are in ns of the log's clock."""

    _frames: dict[str, dict[str, _Poses]] = field(default_factory=dict[str, "dict[str, _Poses]"])
    """Frame → each of its parents → its poses in this parent."""
    _lost: set[str] = field(default_factory=set[str])
    """Frames whose poses cannot be used; a sentence elsewhere names them."""

    def add(
        self,
        frame: str,
        parent: str,
        time: int,
        position: tuple[float, float, float],
        orientation: tuple[float, float, float, float],
        *,
        static: bool = False,
    ) -> None:
        """Add a pose: position in m, orientation as (w, x, y, z), four NaN if it was not recorded."""
        poses = self._poses(frame, parent)
        poses.static = poses.static and static
        poses.rows.append(time, (*position, *orientation))

    def extend(self, frame: str, parent: str, times: Nanoseconds, poses: FloatArray) -> None:
        """Add poses (n, 7) of a moving frame: position in m, orientation as (w, x, y, z)."""
        found = self._poses(frame, parent)
        found.static = False
        found.rows.extend(times, poses)

    def absorb(self, other: TrackBuilder) -> None:
        """Add the poses of another builder."""
        self._lost |= other._lost
        for frame, parents in other._frames.items():
            for parent, poses in parents.items():
                own = self._poses(frame, parent)
                own.static = own.static and poses.static
                own.rows.absorb(poses.rows)

    def drop(self, frame: str) -> None:
        """Forget the poses of a frame. The frame remains, but its place is unknown."""
        if frame in self._frames:
            self._lost.add(frame)

    def retime(self, convert: Callable[[Nanoseconds], Nanoseconds]) -> None:
        """Replace the times (ns) of all poses."""
        for poses in self._every():
            poses.rows = poses.rows.retimed(convert)

    def bounds(self) -> list[int]:
        """Return the times of the earliest and the latest pose that is not static, ns; empty if there is none."""
        known = (frame for frame, parents in self._frames.items() if not _problem(frame, [*parents.values()]))
        moving = (self._frames[frame].values() for frame in known if frame not in self._lost)
        times = [time for found in moving for one in found if not one.static for time in one.rows.bounds()]
        return [min(times), max(times)] if times else []

    def tracks(self, begin: int, remarks: list[str]) -> dict[str, Track]:
        """Return the tracks, with times in s since ``begin`` (ns).

        If a frame has several poses at one time, the last one is kept, unless they often differ: then two programs
        publish the frame, and its place is unknown. Poses that are not finite, or whose quaternion
        has no length, are left out. If a frame has no other poses, several parents at once, or different static poses,
        its place is unknown, and a sentence about it is added to ``remarks``.
        """
        found: dict[str, Track] = {}
        for frame, parents in self._frames.items():
            problem = (
                "" if frame in self._lost else _problem(frame, list(parents.values())) or _two_places(frame, parents)
            )
            remarks += [problem] if problem else []
            tracks = [poses.track(begin) for poses in parents.values()]
            known = [track for track in tracks if len(track.times)]
            if frame in self._lost or problem:
                found[frame] = _nowhere(next(iter(parents)))
            elif len(known) == 1:
                found[frame] = known[0]
            elif known:
                found |= _reparented(frame, known, remarks)
            else:
                remarks.append(_unusable(frame, parents.values()))
                found[frame] = _nowhere(next(iter(parents)))
        return found

    def _poses(self, frame: str, parent: str) -> _Poses:
        parents = self._frames.get(frame)
        if parents is None:
            parents = self._frames[frame] = {}
        found = parents.get(parent)
        if found is None:
            found = parents[parent] = _Poses(parent)
        return found

    def _every(self) -> Iterator[_Poses]:
        for parents in self._frames.values():
            yield from parents.values()


def _problem(frame: str, parents: list[_Poses]) -> str:
    """Return why the place of a frame is unknown; empty if it may be known."""
    if len(parents) > 1 and any(one.static for one in parents):
        return _two_parents(frame, parents[0].parent, parents[1].parent)
    if any(one.static and one.differ() for one in parents):
        return f"frame '{frame}' has several static poses: its place is not known"
    return _two_parents(frame, parents[0].parent, parents[1].parent) if _has_both(parents) else ""


def _unusable(frame: str, parents: Iterable[_Poses]) -> str:
    """Return why no pose of a frame can be used."""
    blocks = [values for one in parents for _, values in one.rows.blocks()]
    if any(np.isfinite(values).all(axis=1).any() for values in blocks):
        words = "the quaternions of its poses have no length: record an orientation, such as x = y = z = 0 and w = 1"
    else:
        words = "its poses have numbers that are not finite"
    return f"the place of '{frame}' is not known: {words}"


def _two_parents(frame: str, one: str, other: str) -> str:
    words = f"frame '{frame}' has two parents, '{one}' and '{other}': publish one of them only"
    return f"{words}; its place is not known"


def _two_places(frame: str, parents: Mapping[str, _Poses]) -> str:
    """Return that a frame has different poses at the same times; empty if it has not."""
    apart = [one for poses in parents.values() for one in poses.apart()]
    if len(apart) < OFTEN:
        return ""
    words = f"frame '{frame}' has two places at one time, {1000 * max(apart):.0f} mm apart, {len(apart)} times"
    return f"{words}: two programs publish it; its place is not known"


def _has_both(parents: list[_Poses]) -> bool:
    """Return whether a frame has two parents at once: it is in one for less than ``SHORTEST`` between two others."""
    if len(parents) == 1:
        return False
    times, parent, changes = _changes([np.concatenate([block for block, _ in one.rows.blocks()]) for one in parents])
    short = times[changes[1:]] - times[changes[:-1] - 1] < round(SHORTEST * 1e9)
    returns = parent[changes[1:]] == parent[changes[:-1] - 1]
    return bool((short & returns).any() or (times[changes] == times[changes - 1]).any())


def _changes(
    times: Sequence[npt.NDArray[Any]],
) -> tuple[npt.NDArray[Any], npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """Return the times of all poses in order, the number of the parent of each, and the rows with another parent."""
    every = np.concatenate(times)
    order = np.argsort(every, kind="stable")
    parent = np.concatenate([np.full(len(one), number) for number, one in enumerate(times)])[order]
    return every[order], parent, np.flatnonzero(parent[1:] != parent[:-1]) + 1


def _reparented(frame: str, tracks: list[Track], remarks: list[str]) -> dict[str, Track]:
    """Return the track of a frame with several parents, one after another."""
    times, parent, changes = _changes([track.times for track in tracks])
    begins, left = times[changes], parent[changes - 1]
    found = [_ended(track, begins[left == number]) for number, track in enumerate(tracks)]
    found.sort(key=lambda track: float(track.times[0]))
    listed = ", ".join(f"'{track.parent}'" for track in found)
    often = "once" if len(changes) == 1 else f"{len(changes)} times"
    remarks.append(f"frame '{frame}' changes its parent {often}: {listed}; it has no place between two of them")
    return {frame: replace(found[0], later=tuple(found[1:]))}


def _ended(track: Track, ends: FloatArray) -> Track:
    """Return a track that has no pose at the times ``ends`` (s), at which another parent follows."""
    rows = np.searchsorted(track.times, ends)
    return Track(
        track.parent,
        np.insert(track.times, rows, ends),
        np.insert(track.positions, rows, np.nan, axis=0),
        np.insert(track.orientations, rows, np.nan, axis=0),
    )


def _nowhere(parent: str) -> Track:
    """Return the track of a frame whose place is never known. Without it, its children would have no parent."""
    return Track(parent, np.zeros(1), np.full((1, 3), np.nan), np.full((1, 4), np.nan))


@dataclass
class _Poses:
    """The poses of one frame in one parent. Its rows have the position (m) and the orientation (w, x, y, z)."""

    parent: str
    static: bool = True
    rows: StoredRows = field(default_factory=lambda: StoredRows(7))

    def differ(self) -> bool:
        """Return whether the poses are not all the same."""
        known = [values for _, values in self.rows.blocks() if len(values)]
        low, high = (np.array([choose(values, axis=0) for values in known]) for choose in (np.min, np.max))
        return bool(len(known) and (high.max(axis=0) - low.min(axis=0)).max() > SAME)

    def apart(self) -> Iterator[float]:
        """Yield how far (m) two poses in a row with the same time are apart, if they differ."""
        for times, values in self.rows.blocks() if not self.static else ():
            again = np.flatnonzero(times[1:] == times[:-1])
            one, other = values[again], values[again + 1]
            away = np.linalg.norm(other[:, :3] - one[:, :3], axis=1)
            # A quaternion and its negative are the same turn.
            same, opposite = (np.abs(other[:, 3:] - sign * one[:, 3:]).max(axis=1, initial=0.0) for sign in (1, -1))
            turned = np.minimum(same, opposite)
            yield from away[(away > APART) | (turned > APART)].tolist()

    def track(self, begin: int) -> Track:
        stamps, values = self.rows.in_order(_is_pose, same=self.static)
        count = len(stamps)
        times, positions, turns = (large_array(shape) for shape in ((count,), (count, 3), (count, 4)))
        for first in range(0, count, BLOCK):
            rows = slice(first, first + BLOCK)
            times[rows] = (stamps[rows] - begin) / 1e9
            positions[rows] = values[rows, :3]
            turns[rows] = values[rows, 3:] / np.linalg.norm(values[rows, 3:], axis=1)[:, None]
        return Track(self.parent, times, positions, turns, self.static)


def _is_pose(values: FloatArray) -> npt.NDArray[np.bool_]:
    turns = values[:, 3:]
    turned = np.isfinite(turns).all(axis=1) & (np.linalg.norm(turns, axis=1) > MIN_LENGTH)
    return np.isfinite(values[:, :3]).all(axis=1) & (turned | np.isnan(turns).all(axis=1))
