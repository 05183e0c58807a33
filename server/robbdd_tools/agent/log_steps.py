"""Find steps of the frames above a robot: a localisation moves the odometry's frame when it corrects where it is."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from math import degrees, radians
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.logs.log_contents import Track

ODOMETRY = "odom"
SHIFT, TURN = 0.02, radians(1.0)
"""A step moves a frame at least this far (m) or turns it by at least this angle (rad)."""
REST = 0.1
"""In the reports just before and after a step, the frame moves by at most this share of it."""


def steps_of_frames(used: Iterable[str], tracks: Mapping[str, Track], world: str) -> Iterator[str]:
    """Yield a remark on each frame of an odometry that steps, above the frames of robots that are ``used``.

    The frame has ``odom`` in its name (REP 105); the joints of an arm may step, too, but these move the robot. Speeds
    in the world are wrong at a step of the odometry.
    """
    seen: set[str] = set()
    for below in used:
        frame = tracks[below].parent if below in tracks else world
        while frame != world and frame in tracks and frame not in seen:
            seen.add(frame)
            track = tracks[frame]
            if ODOMETRY in frame.casefold() and (steps := _steps(track)):
                more = f", and {len(steps) - 1} more" if len(steps) > 1 else ""
                yield (
                    f"the frame '{frame}' steps in '{track.parent}' ({steps[0]}{more}), as a localisation does when it "
                    f"corrects where a robot is: speeds across a step are not the robot's; --world {frame} leaves the "
                    "steps out"
                )
            frame = track.parent


def _steps(track: Track) -> list[str]:
    """Return the size and the time of each step of a frame in its parent."""
    if len(track.times) < 2:
        return []
    shifts = np.linalg.norm(np.diff(track.positions, axis=0), axis=1)
    products = np.abs(np.sum(track.orientations[1:] * track.orientations[:-1], axis=1))
    turns = 2.0 * np.arccos(np.clip(products, 0.0, 1.0))
    found = np.flatnonzero(_alone(shifts, SHIFT) | _alone(turns, TURN))
    return [f"{_size(float(shifts[row]), float(turns[row]))} at {track.times[row + 1]:.2f} s" for row in found]


def _size(shift: float, turn: float) -> str:
    parts = [f"{1000 * shift:.0f} mm"] if shift >= SHIFT else []
    parts += [f"{degrees(turn):.1f}°"] if turn >= TURN else []
    return f"by {' and '.join(parts)}"


def _alone(changes: FloatArray, least: float) -> NDArray[np.bool_]:
    """Return which of the changes (n,) are large, but neither of their neighbours is, shape (n,)."""
    padded = np.concatenate([[0.0], changes, [0.0]])
    return (changes >= least) & (np.maximum(padded[:-2], padded[2:]) <= REST * changes)
