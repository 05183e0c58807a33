"""Poses of frames in a common frame, at any times, from the transforms of a log."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.logs.log_contents import Track

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

OFTEN = 0.02
"""If a frame is recorded at intervals of at most this (s), it does not matter in which frame it is interpolated."""


class Unconnected(Exception):
    """Two frames are not connected by transforms; the message says where the chain ends."""


def root_of(frame: str, tracks: Mapping[str, Track]) -> str:
    """Return the root of a frame: the end of its chain of parents. Raises ``Unconnected`` if the chain is a circle.

    If a frame changes its parent, its first parent counts.
    """
    return _chain(frame, tracks)[-1]


def poses_at(
    frame: str, reference: str, tracks: Mapping[str, Track], times: FloatArray, max_gap: float
) -> tuple[FloatArray, FloatArray]:
    """Return the poses of ``frame`` in ``reference`` at ``times`` (n,) s.

    The result has the positions (n, 3) m and the orientations (n, 4) as (w, x, y, z). A pose is interpolated between
    two recorded ones in the same parent that are at most ``max_gap`` (s) apart. It is NaN where they are further apart,
    and before the first and after the last recorded pose. Where an orientation was not recorded, the orientation is NaN
    and so is the position of a frame that depends on it. Raises ``Unconnected``.
    """
    changed = next((one for one in reached((frame, reference), tracks) if tracks[one].later), None)
    if changed is not None:
        return _in_each_parent(changed, (frame, reference), tracks, times, max_gap)
    down, up = _chain(frame, tracks), _chain(reference, tracks)
    common = next((name for name in down if name in up), None)
    if common is None:
        raise Unconnected(f"'{frame}' is connected to '{down[-1]}', but not to '{reference}'")
    position, turn = _along(down[: down.index(common)], tracks, times, max_gap)
    origin, base = _along(up[: up.index(common)], tracks, times, max_gap)
    back = base * (1.0, -1.0, -1.0, -1.0)
    return rotated(back, position - origin), product(back, turn)


def steadier_poses_at(
    frame: str, reference: str, tracks: Mapping[str, Track], times: FloatArray, max_gap: float
) -> tuple[FloatArray, FloatArray]:
    """Return poses like ``poses_at``, interpolated in the parent or in ``reference``, wherever the frame moved less.

    A camera on a wrist sees a part that lies still: between two detections, the part stays where it is in the world,
    not where it is in the picture. A part in a gripper stays where it is in the hand. Frames that are recorded often
    are interpolated in their parents.
    """
    found = poses_at(frame, reference, tracks, times, max_gap)
    track = tracks.get(frame)
    if track is None or track.static or track.later or len(track.times) < 2:
        return found
    if float(np.median(np.diff(track.times))) <= OFTEN or _is_fixed(track.parent, reference, tracks):
        return found
    places, turns = poses_at(frame, reference, tracks, track.times, max_gap)
    seen = Track(reference, track.times, places, turns)
    rows = np.clip(np.searchsorted(track.times, times, side="right") - 1, 0, len(track.times) - 2)
    moved, moved_in_parent = (np.linalg.norm(np.diff(one.positions, axis=0), axis=1)[rows] for one in (seen, track))
    steadier = moved < moved_in_parent
    for own, other in zip(found, _interpolated(seen, times, max_gap), strict=True):
        own[steadier] = other[steadier]
    return found


def _is_fixed(frame: str, reference: str, tracks: Mapping[str, Track]) -> bool:
    """Return whether a frame never moves relative to ``reference``."""
    return all(tracks[one].static for one in reached((frame, reference), tracks))


def _in_each_parent(
    changed: str, frames: tuple[str, str], tracks: Mapping[str, Track], times: FloatArray, max_gap: float
) -> tuple[FloatArray, FloatArray]:
    """Return the poses of ``poses_at`` where a frame changes its parent: at each time, those in its parent then."""
    position, turn = np.full((len(times), 3), np.nan), np.full((len(times), 4), np.nan)
    problems: list[Unconnected] = []
    alternatives = [replace(one, later=()) for one in (tracks[changed], *tracks[changed].later)]
    for one in alternatives:
        try:
            place, rotation = poses_at(*frames, {**tracks, changed: one}, times, max_gap)
        except Unconnected as problem:
            problems.append(problem)
            continue
        missing = np.isnan(position).any(axis=1)
        position[missing], turn[missing] = place[missing], rotation[missing]
    if len(problems) == len(alternatives):
        raise problems[0]
    return position, turn


def reached(frames: Iterable[str], tracks: Mapping[str, Track]) -> Iterator[str]:
    """Yield the frames with a track on all ways from some frames to their roots."""
    found: set[str] = set()
    left = list(frames)
    while left:
        frame = left.pop(0)
        if frame in tracks and frame not in found:
            found.add(frame)
            yield frame
            left += tracks[frame].parents


def product(first: FloatArray, second: FloatArray) -> FloatArray:
    """Return the products of quaternions (n, 4), w first: the rotation ``second`` and then ``first``."""
    a, b = first.T, second.T
    return np.stack(
        [
            a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
            a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
            a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
            a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
        ],
        axis=1,
    )


def rotated(turn: FloatArray, vectors: FloatArray) -> FloatArray:
    """Return vectors (n, 3) rotated by unit quaternions (n, 4), w first."""
    axis, w = turn[:, 1:], turn[:, :1]
    across = 2.0 * np.cross(axis, vectors)
    return vectors + w * across + np.cross(axis, across)


def _chain(frame: str, tracks: Mapping[str, Track]) -> list[str]:
    """Return the chain of a frame: the frame, its parent, and so on."""
    found = [frame]
    while found[-1] in tracks:
        parent = tracks[found[-1]].parent
        if parent in found:
            raise Unconnected(f"the transforms of '{frame}' form a circle: {' → '.join([*found, parent])}")
        found.append(parent)
    return found


def _along(
    frames: list[str], tracks: Mapping[str, Track], times: FloatArray, max_gap: float
) -> tuple[FloatArray, FloatArray]:
    """Return the poses of a chain's first frame relative to the parent of its last frame."""
    if not frames:
        return np.zeros((len(times), 3)), np.tile((1.0, 0.0, 0.0, 0.0), (len(times), 1))
    position, turn = _interpolated(tracks[frames[0]], times, max_gap)
    for frame in frames[1:]:
        step, rotation = _interpolated(tracks[frame], times, max_gap)
        position, turn = step + rotated(rotation, position), product(rotation, turn)
    return position, turn


def _interpolated(track: Track, times: FloatArray, max_gap: float) -> tuple[FloatArray, FloatArray]:
    count = len(track.times)
    if track.static:
        return np.repeat(track.positions, len(times), axis=0), np.repeat(track.orientations, len(times), axis=0)
    after = np.searchsorted(track.times, times, side="left")
    exact = (after < count) & (track.times[np.minimum(after, count - 1)] == times)
    before = np.where(exact, after, after - 1)
    outside = (before < 0) | (after >= count)
    first, second = np.clip(before, 0, count - 1), np.clip(after, 0, count - 1)
    gap = track.times[second] - track.times[first]
    share = np.divide(times - track.times[first], gap, out=np.zeros(len(times)), where=gap > 0)[:, None]
    positions = track.positions[first] * (1 - share) + track.positions[second] * share
    turns = _slerp(track.orientations[first], track.orientations[second], share)
    missing = outside | (gap > max_gap)
    positions[missing], turns[missing] = np.nan, np.nan
    return positions, turns


def _slerp(first: FloatArray, second: FloatArray, share: FloatArray) -> FloatArray:
    """Interpolate quaternions (n, 4) spherically along the shorter arc; ``share`` (n, 1) is from 0 to 1."""
    cosine = np.sum(first * second, axis=1, keepdims=True)
    second = np.where(cosine < 0, -second, second)
    angle = np.arccos(np.clip(np.abs(cosine), 0.0, 1.0))
    sine = np.sin(angle)
    close = sine < 1e-6
    safe = np.where(close, 1.0, sine)
    one = np.where(close, 1 - share, np.sin((1 - share) * angle) / safe)
    other = np.where(close, share, np.sin(share * angle) / safe)
    found = one * first + other * second
    return found / np.linalg.norm(found, axis=1, keepdims=True)
