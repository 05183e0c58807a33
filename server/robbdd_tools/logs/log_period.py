"""Cut a period out of a log, for a log that has more than one execution."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.logs.joint_tracks import JointTrack
from robbdd_tools.logs.log_contents import LogContents, Track, Truths, UnreadableLog

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def cut(contents: LogContents, begin: float, end: float | None) -> LogContents:
    """Return the contents of a log from ``begin`` to ``end`` (s since its begin); ``None`` for the end of the log.

    The new times count from ``begin``. Static transforms are kept, and so is the last truth value before the period.
    Raises ``UnreadableLog`` if the period is empty or begins after the end of the log.
    """
    until = contents.end if end is None else min(end, contents.end)
    if not begin < until:
        raise UnreadableLog(f"the log has nothing from {begin:g} s on: it ends at {contents.end:.2f} s")
    tracks = {frame: found for frame, one in contents.tracks.items() if (found := _track(one, begin, until))}
    joints = {
        topic: {name: _states(one, begin, until) for name, one in states.items()}
        for topic, states in contents.joints.items()
    }
    return replace(
        contents,
        tracks=tracks,
        texts=tuple(replace(one, time=one.time - begin) for one in contents.texts if begin <= one.time <= until),
        end=until - begin,
        unfinished=contents.unfinished and until == contents.end and end is None,
        truths={topic: _truths(one, begin, until) for topic, one in contents.truths.items()},
        joints={topic: {name: one for name, one in found.items() if len(one.times)} for topic, found in joints.items()},
        forces={
            topic: found for topic, one in contents.forces.items() if len((found := _states(one, begin, until)).times)
        },
    )


def _inside(times: FloatArray, begin: float, end: float) -> slice:
    """Return the rows from the last one before a period to the first one after it, which cover the whole period."""
    first = max(int(np.searchsorted(times, begin, side="right")) - 1, 0)
    last = int(np.searchsorted(times, end, side="left")) + 1
    return slice(first, last)


def _track(track: Track, begin: float, end: float) -> Track | None:
    """Return the part of a track in a period; ``None`` if it has none."""
    if track.static:
        return track
    parts = [_part(one, begin, end) for one in (track, *track.later)]
    known = [one for one in parts if len(one.times)]
    return replace(known[0], later=tuple(known[1:])) if known else None


def _part(track: Track, begin: float, end: float) -> Track:
    rows = _inside(track.times, begin, end)
    return Track(track.parent, track.times[rows] - begin, track.positions[rows], track.orientations[rows])


def _states(track: JointTrack, begin: float, end: float) -> JointTrack:
    rows = _inside(track.times, begin, end)
    return JointTrack(track.times[rows] - begin, track.positions[rows], track.efforts[rows])


def _truths(truths: Truths, begin: float, end: float) -> Truths:
    rows = _inside(truths.times, begin, end)
    return Truths(truths.times[rows] - begin, truths.values[rows])
