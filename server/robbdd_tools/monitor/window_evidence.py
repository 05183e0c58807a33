"""The samples of one window of a trace, as evaluators read them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from robbdd_tools.monitor.paths import length_beyond_errors, path_length
from robbdd_tools.monitor.time import TOLERANCE, Window
from robbdd_tools.monitor.unobserved import Unobserved, Unplaced, gap_around, no_grip, path_of_errors
from robbdd_tools.monitor.without_physics import need_contacts

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from robbdd_tools.base.articulation import OpeningRecord
    from robbdd_tools.catalog.api import FloatArray, Outline, Region
    from robbdd_tools.monitor.trace import Trace

T = TypeVar("T")
Regions = Mapping[str, Sequence[tuple[str, "Region"]]]
"""Workspace → its regions, each with the object in whose frame the region is given."""


@dataclass(frozen=True)
class WindowEvidence:
    """The samples of one window, in the form of ``catalog.api.Evidence``."""

    trace: Trace
    window: Window
    regions_of: Regions

    @property
    def _rows(self) -> slice:
        return slice(self.window.first, self.window.last + 1)

    @property
    def times(self) -> FloatArray:
        """The times of the samples, s, shape (n,)."""
        return self.trace.times[self._rows]

    def position(self, name: str) -> FloatArray:
        """Return the positions of an element, m, world frame, shape (n, 3).

        Raises ``KeyError``, and ``Unobserved`` if the element was not observed throughout the window.
        """
        return self._observed(name, self.trace.positions[self._rows, self.trace.column(name)], self.times)

    def orientation(self, name: str) -> FloatArray:
        """Return the orientations of an element as unit quaternions (w, x, y, z), shape (n, 4).

        Raises ``KeyError`` and ``Unobserved``, like ``position``.
        """
        return self._observed(name, self._turns(name, self._rows), self.times)

    def velocity(self, name: str) -> FloatArray:
        """Return the mean velocity of an element since the previous sample, m/s, shape (n, 3). Raises ``KeyError``.

        At the first sample, it is the mean velocity until the next sample. In a trace of one sample, it is NaN.
        """
        self._need_motion(name)
        rows, extra = self._with_neighbour()
        path, times = self.trace.positions[rows, self.trace.column(name)], self.trace.times[rows]
        if len(times) < 2:
            return np.full((1, 3), np.nan)
        steps = np.diff(path, axis=0) / np.diff(times)[:, None]
        steps = steps if extra else np.concatenate([steps[:1], steps])
        return self._observed(name, steps[: len(self.times)], self.times)

    def turning(self, name: str) -> FloatArray:
        """Return the mean angular speed of an element since the previous sample, rad/s, shape (n,).

        At the first sample, it is the mean speed until the next sample. In a trace of one sample, it is NaN. Raises
        ``KeyError`` and ``Unobserved``.
        """
        need_contacts(self.trace.settings)
        self._need_motion(name)
        rows, extra = self._with_neighbour()
        turns, times = self._turns(name, rows), self.trace.times[rows]
        if len(times) < 2:
            return np.full(1, np.nan)
        # The distance of two unit quaternions is twice the sine of a quarter of the angle; q and -q are the same turn.
        chords = np.minimum(
            np.linalg.norm(turns[1:] - turns[:-1], axis=1), np.linalg.norm(turns[1:] + turns[:-1], axis=1)
        )
        steps = 4.0 * np.arcsin(np.clip(chords / 2.0, 0.0, 1.0)) / np.diff(times)
        speeds = steps if extra else np.concatenate([steps[:1], steps])
        return self._observed(name, speeds[: len(self.times), None], self.times)[:, 0]

    def travelled(self, name: str, limit: float) -> FloatArray:
        """Return the length of an element's path since the window began, m, shape (n,).

        In a log with stated errors, they do not lengthen the path (``length_beyond_errors``). Raises ``KeyError`` and
        ``Unobserved``, also if no errors are stated and the path is longer than ``limit`` although the element was
        never farther than ``limit`` from where it began: errors of the measurements add up along a path.
        """
        self._need_motion(name)
        positions = self.position(name)
        if error := self.trace.position_error(name):
            return length_beyond_errors(positions, error)
        found, away = path_length(positions), float(np.linalg.norm(positions - positions[0], axis=1).max())
        if self.trace.log and found[-1] > limit >= away:
            raise Unobserved(path_of_errors(name, float(found[-1]), away))
        return found

    def _with_neighbour(self) -> tuple[slice, bool]:
        """Return the window's rows and a row before them or, at the begin of the trace, after them; true if before."""
        first, after = self.window.first, self.window.last + 1
        return (slice(first - 1, after), True) if first else (slice(0, max(after, 2)), False)

    def position_at(self, name: str, times: FloatArray) -> FloatArray:
        """Return the positions at the last sample at or before each of ``times``, m, shape (n, 3).

        Raises ``KeyError`` and ``Unobserved``.
        """
        return self._observed(name, self.trace.positions[self._rows_at(times), self.trace.column(name)], times)

    def orientation_at(self, name: str, times: FloatArray) -> FloatArray:
        """Return the orientations at the last sample at or before each of ``times``, shape (n, 4).

        Raises ``KeyError`` and ``Unobserved``.
        """
        return self._observed(name, self._turns(name, self._rows_at(times)), times)

    def _turns(self, name: str, rows: slice | NDArray[np.intp]) -> FloatArray:
        """Return the orientations at some rows, NaN where the element was not observed at all.

        Raises ``Unobserved`` if a log has only the position at one of them.
        """
        column = self.trace.column(name)
        turns = self.trace.orientations[rows, column]
        if self.trace.log and (np.isnan(turns).any(axis=1) & ~np.isnan(self.trace.positions[rows, column, 0])).any():
            raise Unobserved(f"the log does not say how {name} is turned")
        return turns

    def _observed(self, name: str, values: FloatArray, times: FloatArray) -> FloatArray:
        """Return the values (n, k) of an element at some times (n,). Raises ``Unobserved`` if a value is missing.

        Only the trace of a log can lack values. A comparison with a missing value would silently be false.
        """
        if self.trace.log and (missing := np.isnan(values).any(axis=1)).any():
            unseen = np.isnan(self.trace.positions[:, self.trace.column(name)].sum(axis=1))
            time = float(times[int(np.argmax(missing))])
            raise Unobserved(f"{name} was not observed {gap_around(self.trace.times, unseen, time)}")
        return values

    def _rows_at(self, times: FloatArray) -> NDArray[np.intp]:
        return np.maximum(np.searchsorted(self.trace.times, times + TOLERANCE, side="right") - 1, 0)

    def outline(self, name: str) -> Outline:
        """Return the extent of an object around its position. Raises ``KeyError``."""
        return self.trace.outlines[name]

    def force(self, agent: str, name: str) -> FloatArray:
        """Return the largest contact force since the previous sample, N, shape (n,). Raises ``KeyError``."""
        need_contacts(self.trace.settings)
        trace, pair = self.trace, (agent, name)
        if pair in trace.forces:
            return trace.forces[pair][self._rows]
        if agent in trace.watched and name in trace.names:
            return np.zeros(self.window.last + 1 - self.window.first)
        raise KeyError(f"contact forces of {agent} on {name}")

    def touch(self, one: str, other: str) -> FloatArray:
        """Return the largest contact force since the previous sample, N, shape (n,). Raises ``KeyError``."""
        need_contacts(self.trace.settings)
        trace = self.trace
        for first, second in ((one, other), (other, one)):
            if (first, second) in trace.touches:
                return trace.touches[first, second][self._rows]
            if first in trace.touch_watched and second in trace.names:
                return np.zeros(self.window.last + 1 - self.window.first)
        raise KeyError(f"contact forces between {one} and {other}")

    def gap(self, one: str, other: str) -> FloatArray:
        """Return the distance of two surfaces, m, shape (n,), NaN where it was not measured. Raises ``KeyError``."""
        gaps = self.trace.gaps
        known = gaps.get((one, other), gaps.get((other, one)))
        if known is None:
            raise KeyError(f"distance between the surfaces of {one} and {other}")
        return known[self._rows]

    def joint_clearance(self, agent: str) -> FloatArray:
        """Return the smallest share of a joint's range to its nearest limit, shape (n,).

        Raises ``KeyError``, and ``Unobserved`` if a joint was not observed throughout the window.
        """
        if agent not in self.trace.joint_clearances:
            raise KeyError(f"joint limits of {agent}")
        every = self.trace.joint_clearances[agent]
        shares = every[self._rows]
        if self.trace.log and (missing := np.isnan(shares)).any():
            gap = gap_around(self.trace.times, np.isnan(every), float(self.times[int(np.argmax(missing))]))
            raise Unobserved(f"the joints of {agent} were not observed {gap}")
        return shares

    def opening(self, name: str) -> OpeningRecord:
        """Return how far a thing is open at each sample. Raises ``KeyError``, and ``Unobserved`` for several joints."""
        record = self.trace.openings.get(name)
        if record is None:
            raise KeyError(f"a joint with which {name} opens")
        if isinstance(record, str):
            raise Unobserved(record)
        return replace(record, positions=record.positions[self._rows])

    def _need_motion(self, name: str) -> None:
        """Raise ``Unobserved`` if a log states the place of an element instead of observing it."""
        if name in self.trace.stated:
            words = f"the log does not observe {name}: its place is that of a static transform or of the .scenex"
            raise Unobserved(f"{words}, so whether it moved is not known")

    def is_immovable(self, name: str) -> bool:
        """Return whether an element does not move when it is hit. Fixed objects and agents are immovable."""
        need_contacts(self.trace.settings)
        return name in self.trace.immovable

    def regions(self, workspace: str) -> Sequence[tuple[str, Region]]:
        """Return the regions of a workspace.

        Raises ``KeyError`` if the workspace has none in the scene, and ``Unplaced`` if only its carriers are known.
        """
        found = self.regions_of[workspace]
        if not found:
            raise Unplaced(workspace)
        return found

    def contents(self, workspace: str) -> Sequence[str]:
        """Return the names of the workspaces inside a workspace, at any depth."""
        return self.trace.contents.get(workspace, ())

    def correct_places(self, name: str) -> Sequence[str]:
        """Return the workspaces that are stated to be correct for an object. Raises ``Unobserved`` if none is."""
        places = self.trace.correct_places.get(name, ())
        if not places:
            raise Unobserved(f"the scene states no workspace that is correct for {name}")
        return places

    @property
    def workspaces(self) -> Sequence[str]:
        """Return the names of the workspaces that have regions."""
        return tuple(self.regions_of)

    @property
    def grippers(self) -> Sequence[str]:
        """The agents whose grips are recorded."""
        return tuple(self.trace.grips)

    def gripped(self, agent: str, name: str) -> FloatArray:
        """Return 1.0 at each sample where ``agent`` grips ``name``, else 0.0, shape (n,).

        Raises ``KeyError``, and ``Unobserved`` if it was not observed throughout the window.
        """
        need_contacts(self.trace.settings)
        trace = self.trace
        if trace.log and (agent not in trace.grips or name not in trace.names):
            raise Unobserved(no_grip(agent, name if agent in trace.grips else ""))
        grips = trace.grips[agent][self._rows, trace.column(name)]
        missing = np.isnan(grips)
        if missing.any():
            row = int(np.argmax(missing))
            unseen = np.isnan(trace.positions[self._rows, trace.column(name), 0])[row]
            also = f", nor where {name} was" if unseen else ""
            raise Unobserved(f"it was not observed what {agent} held at {self.times[row]:.2f} s{also}")
        return grips

    def reach(self, agent: str, name: str) -> FloatArray:
        """Return the reach margins, rad, shape (n,), with NaN where none was sampled. Raises ``KeyError``."""
        return self._of_pair(self.trace.reaches, agent, name)[self._rows]

    def setting(self, target: str, name: str) -> str:
        """Return the value of a configuration as it was read from the simulated world. Raises ``KeyError``."""
        return self._of_pair(self.trace.settings, target, name)

    def truth(self, topic: str) -> FloatArray:
        """Return 1 where the last message on a topic of the log is true, -1 where it is false, shape (n,).

        Raises ``KeyError``, and ``Unobserved`` if the truth is not known throughout the window.
        """
        values = self.trace.truths[topic][self._rows]
        missing = np.isnan(values)
        if missing.any():
            raise Unobserved(
                f"the topic '{topic}' reports nothing known at {self.times[int(np.argmax(missing))]:.2f} s"
            )
        return values

    @property
    def is_logged(self) -> bool:
        """Whether the samples are observations of a log."""
        return bool(self.trace.log)

    @staticmethod
    def _of_pair(record: Mapping[tuple[str, str], T], first: str, second: str) -> T:
        try:
            return record[first, second]
        except KeyError:
            raise KeyError(f"{first} {second}") from None
