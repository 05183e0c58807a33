"""Read the grips of agents from a log: from its reports, or from declared signals. Unobserved grips are NaN."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.logs.joint_tracks import JointTrack, positions_at
from robbdd_tools.logs.log_names import elements_of, local_name
from robbdd_tools.protocol.grip_signals import EFFORT, GripSignal, NoGripSignal, read_grip_signal
from robbdd_tools.world.extent import outline_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray, Outline
    from robbdd_tools.logs.log_contents import LogContents, TextStamp
    from robbdd_tools.world.cast import Cast

HOLDS = "holds"
"""Last part of the topic that reports the name of the object an agent holds, or an empty text: ``/panda/holds``."""
FARTHEST = 10.0
"""No gripper opens by more (m or rad): larger positions are percent, or counts of a motor."""
NEAR = 0.03
"""A tool may be this far (m) from the surface of an object that it holds: cameras and calibrations have errors."""


def grip_signals(declared: Iterable[str], cast: Cast) -> tuple[GripSignal, ...]:
    """Return the declared signals with the CURIEs of agents and objects. Raises ``NoGripSignal`` and ``NoElement``."""
    found: list[GripSignal] = []
    for text in declared:
        one = read_grip_signal(text)
        (agent,) = elements_of({one.agent: ""}, cast.every_agent)
        held = next(iter(elements_of({one.held: ""}, cast.every_object)), "") if one.held else ""
        found.append(GripSignal(agent, held, one.kind, one.source, one.low, one.high))
    return tuple(found)


class LogGrips:
    """The grips of a log. ``names`` are the bodies of the trace, in the order of the columns."""

    def __init__(self, cast: Cast, contents: LogContents, frames: Mapping[str, str], max_gap: float) -> None:
        """``frames`` maps elements to their frames, by which a text may name an object."""
        self._cast = cast
        self._contents = contents
        self._frames = frames
        self._max_gap = max_gap

    def observed(self, signals: Sequence[GripSignal]) -> list[FloatArray]:
        """Return the times (s) of the messages by which the signals are judged. Raises ``NoGripSignal``."""
        return [self._track(one).times for one in signals if one.kind != "topic"]

    def held(
        self,
        signals: Sequence[GripSignal],
        names: Sequence[str],
        times: FloatArray,
        poses: Mapping[str, tuple[FloatArray, FloatArray]],
    ) -> dict[str, FloatArray]:
        """Return the grips of each agent with known grips at ``times`` (n,): 1 for a held body, shape (n, len(names)).

        All signals of an agent must agree that it holds something. A signal may name its object. Otherwise, the object
        is the one at whose surface the tool is; if there are several, it is unknown which one.
        """
        found: dict[str, FloatArray] = {}
        for agent in self._cast.every_agent:
            own = [one for one in signals if one.agent == agent]
            if own:
                found[agent] = self._declared(agent, own, names, times, poses)
            elif any(_is_of(one, agent) for one in self._contents.texts):
                found[agent] = self._reported(agent, names, times)
        return found

    def _declared(
        self,
        agent: str,
        signals: Sequence[GripSignal],
        names: Sequence[str],
        times: FloatArray,
        poses: Mapping[str, tuple[FloatArray, FloatArray]],
    ) -> FloatArray:
        record = np.zeros((len(times), len(names)))
        for held in dict.fromkeys(one.held for one in signals):
            truth = _conjunction([self._truth(one, times) for one in signals if one.held == held])
            if held:
                record[:, names.index(held)] = truth
                continue
            near = self._near(agent, names, poses, len(times))
            # A candidate is held if it is the only one; an object at an unknown place may be the held one.
            several = np.nansum(near, axis=1) + np.isnan(near).sum(axis=1) > 1
            near[several[:, None] & (near > 0)] = np.nan
            on, unknown = truth[:, None] > 0, np.isnan(truth)[:, None]
            record = np.maximum(record, np.where(on, near, np.where(unknown & ~(near == 0), np.nan, 0.0)))
        return record

    def _near(
        self, agent: str, names: Sequence[str], poses: Mapping[str, tuple[FloatArray, FloatArray]], count: int
    ) -> FloatArray:
        """Return 1 where the tool is at an object that can be held, 0 where not, NaN if unknown, (count, names)."""
        near = np.zeros((count, len(names)))
        for column, name in enumerate(names):
            if self._cast.points.get(name) == "object":  # nobody knows how large it is
                near[:, column] = np.nan
                continue
            model = self._cast.objects.get(name)
            if model is None or not model.free:
                continue
            if agent not in poses or name not in poses:
                near[:, column] = np.nan
                continue
            distance = np.linalg.norm(poses[name][0] - poses[agent][0], axis=1)
            within = np.where(distance <= _radius(outline_of(model)) + NEAR, 1.0, 0.0)
            near[:, column] = np.where(np.isnan(distance), np.nan, within)
        return near

    def _truth(self, signal: GripSignal, times: FloatArray) -> FloatArray:
        """Return 1 where a signal reports a grip, 0 where it reports none, NaN where it is unknown, (n,)."""
        if signal.kind == "topic":
            truths = self._contents.truths.get(signal.source)
            if truths is None:
                raise NoGripSignal(
                    f"the log has no topic of truth values '{signal.source}'{_listed(self._contents.truths)}"
                )
            values = truths.at(times, self._max_gap)
            return np.where(np.isnan(values), np.nan, np.where(values > 0, 1.0, 0.0))
        track = self._track(signal)
        values = positions_at(track, times, self._max_gap)
        within = np.where((values >= signal.low) & (values <= signal.high), 1.0, 0.0)
        return np.where(np.isnan(values), np.nan, within)

    def _track(self, signal: GripSignal) -> JointTrack:
        """Return the numbers of a signal. Raises ``NoGripSignal`` with the signals that the log has."""
        if signal.kind == "wrench":
            if signal.source not in self._contents.forces:
                words = f"the log has no wrenches on '{signal.source}'{_listed(self._contents.forces)}"
                raise NoGripSignal(words)
            return self._contents.forces[signal.source]
        every = {name: track for joints in self._contents.joints.values() for name, track in joints.items()}
        if signal.source not in every:
            raise NoGripSignal(f"the log has no joint '{signal.source}'{_listed(every)}")
        track = every[signal.source]
        if signal.kind != EFFORT:
            farthest = float(np.nanmax(np.abs(track.positions), initial=0.0))
            if farthest > FARTHEST:
                words = f"joint '{signal.source}' has positions up to {farthest:g}, which are neither in m nor in rad"
                raise NoGripSignal(f"{words}: record it in its unit, or declare another signal")
            return track
        known = np.isfinite(track.efforts)
        if not known.any():
            raise NoGripSignal(f"the log has no efforts of joint '{signal.source}'")
        return JointTrack(track.times[known], np.abs(track.efforts[known]), track.efforts[known])

    def _reported(self, agent: str, names: Sequence[str], times: FloatArray) -> FloatArray:
        """Return the grips that the texts of an agent report."""
        own = [one for one in self._contents.texts if _is_of(one, agent)]
        known = {word: name for name in names for word in (name, local_name(name), self._frames.get(name, name))}
        record = np.zeros((len(times), len(names)))
        # Before its first message, it is unknown what the agent holds.
        record[times < own[0].time] = np.nan
        for one, until in zip(own, [*(later.time for later in own[1:]), np.inf], strict=True):
            rows = (times >= one.time) & (times < until)
            if one.text.strip() in known:
                record[rows, names.index(known[one.text.strip()])] = 1.0
            elif one.text.strip():
                record[rows] = np.nan
        return record


def _is_of(one: TextStamp, agent: str) -> bool:
    return one.topic.strip("/").split("/")[-2:] == [local_name(agent), HOLDS]


def _conjunction(truths: Sequence[FloatArray]) -> FloatArray:
    """Return 0 where a signal is 0, else NaN where one is NaN, else 1."""
    every = np.stack(truths)
    return np.where((every == 0).any(axis=0), 0.0, np.where(np.isnan(every).any(axis=0), np.nan, 1.0))


def _radius(outline: Outline) -> float:
    """Return the largest distance (m) of an object's surface from its centre."""
    return max(float(np.linalg.norm(centre)) + radius for centre, radius in outline)


def _listed(names: Iterable[str]) -> str:
    known = sorted(names)
    return f"; it has: {', '.join(known[:8])}" if known else ""
