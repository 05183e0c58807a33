"""Turn the contents of a log into the trace of a scenario. No world is simulated."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.catalog.settings import written
from robbdd_tools.judging.log_names import (
    FramesProblem,
    elements_of,
    frame_of,
    local_name,
    occurrences_of,
    stated_frames,
)
from robbdd_tools.logs.transforms import Unconnected, poses_at, root_of, rotated
from robbdd_tools.monitor.trace import EventStamp, Trace
from robbdd_tools.traces.codec import Evidence
from robbdd_tools.world.extent import outline_of
from robbdd_tools.world.scene import Cast, cast_scene, contents_of
from robbdd_tools.world.staging import Staging

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.logs.log_contents import LogContents, TextStamp, Truths
    from robbdd_tools.protocol.log_request import LogRequest
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.world.pose import Pose

START, END = "scenario-start", "scenario-end"
HOLDS = "holds"
"""Last part of the topic with the name of the object that an agent holds, or with an empty text: ``/panda/holds``."""


@dataclass(frozen=True, slots=True)
class LogEvidence:
    """The evidence of a log on one scenario, and sentences on what is missing or was assumed."""

    evidence: Evidence
    remarks: tuple[str, ...]
    cast: Cast


def evidence_of(spec: ScenarioSpec, contents: LogContents, request: LogRequest) -> LogEvidence:
    """Return the evidence of a log on a scenario.

    Positions are those of the log in the frame of the world; the origin of a frame is that of the element's model. The
    trace has a sample at each observation of a frame that is used, at most ``request.rate`` per second, at each event
    and in each gap. A value is NaN where nothing was observed. Raises ``SceneError`` if an element has no model, and
    ``NoElement`` if the request names something else.
    """
    staging = None if spec.instance is None else Staging(spec.instance, spec.seed)
    cast = cast_scene(spec.scene, staging)
    remarks = list(contents.remarks)
    events = _events(spec, contents, remarks)
    elements = (*cast.objects, *cast.agents)
    frames = _Frames(spec, cast, contents, request, remarks)
    times = _times(frames.used(), events, contents, request)
    poses = {element: found for element in cast.objects if (found := frames.object_poses(element, times)) is not None}
    poses |= {element: found for element in cast.agents if (found := frames.poses(element, times)) is not None}
    names = tuple(poses)
    trace = Trace(
        names,
        times,
        np.stack([place for place, _ in poses.values()], axis=1) if poses else np.empty((len(times), 0, 3)),
        np.stack([turn for _, turn in poses.values()], axis=1) if poses else np.empty((len(times), 0, 4)),
        grips=_grips(cast, names, frames, contents.texts, times),
        events=events,
        settings={pair: written(value) for pair, value in cast.judged.items()},
        outlines={name: outline_of(model) for name, model in cast.objects.items()},
        contents={workspace: contents_of(spec.scene, workspace) for workspace in spec.scene.contains},
        correct_places=spec.scene.correct_places,
        log=Path(request.path).name,
        uncertain=elements_of(request.uncertainty, elements),
        truths={topic: _sampled(found, times) for topic, found in contents.truths.items()},
        immovable=(*(name for name, model in cast.objects.items() if not model.free), *cast.agents),
    )
    return LogEvidence(Evidence(trace, cast.regions), tuple(dict.fromkeys(remarks)), cast)


class _Frames:
    """The frames of a scenario's elements in a log, and their poses. ``remarks`` gets sentences on what is missing."""

    def __init__(
        self, spec: ScenarioSpec, cast: Cast, contents: LogContents, request: LogRequest, remarks: list[str]
    ) -> None:
        self._spec = spec
        self._cast = cast
        self._tracks = contents.tracks
        self._max_gap = request.max_gap
        self._remarks = remarks
        self.of: dict[str, str] = {}
        """Element → its frame."""
        stated = {**stated_frames(spec), **elements_of(request.frames, (*cast.objects, *cast.agents))}
        for element in (*cast.objects, *cast.agents):
            try:
                self.of[element] = frame_of(element, contents.tracks, stated)
            except FramesProblem as problem:
                if element in (*spec.scene.objects, *spec.scene.agents) and element not in spec.scene.unused:
                    remarks.append(str(problem))
        self._stated_world = bool(request.world)
        self._world = request.world.lstrip("/") or self._root()

    def used(self) -> set[str]:
        """Return the frames of elements, and those between them and their roots."""
        found: set[str] = set()
        for frame in self.of.values():
            while frame in self._tracks and frame not in found:
                found.add(frame)
                frame = self._tracks[frame].parent
        return found

    def poses(self, element: str, times: FloatArray) -> tuple[FloatArray, FloatArray] | None:
        """Return positions (n, 3) m and orientations (n, 4) of an element's frame; ``None`` if it has none."""
        if element not in self.of:
            return None
        try:
            return poses_at(self.of[element], self._world, self._tracks, times, self._max_gap)
        except Unconnected as problem:
            self._remarks.append(str(problem))
            return None

    def object_poses(self, element: str, times: FloatArray) -> tuple[FloatArray, FloatArray] | None:
        """Return the poses of an object's centre: in the log or, if it is not there, in the ``.scenex``."""
        if element in self.of:
            found = self.poses(element, times)
            if found is None:
                return None
            place, turn = found
            return place - rotated(turn, np.tile(self._cast.objects[element].frame, (len(times), 1))), turn
        pose = self._stated_pose(element)
        if pose is None:
            return None
        if not self._is_world():
            hint = "name the frame of the world with --world FRAME"
            self._remarks.append(f"{element} is not in the log, and the .scenex places it in the world: {hint}")
            return None
        self._remarks.append(f"{element} is not in the log, so it stands where the .scenex places it")
        upright = (float(np.cos(pose.yaw / 2)), 0.0, 0.0, float(np.sin(pose.yaw / 2)))
        return np.tile(pose.position, (len(times), 1)), np.tile(pose.rotation or upright, (len(times), 1))

    def _stated_pose(self, element: str) -> Pose | None:
        """Return the pose of an object that the ``.scenex`` states; ``None`` if it states none, or draws it."""
        if self._spec.instance is None:
            return None
        # A pose that is drawn at random differs with another seed.
        other = replace(self._cast, staging=Staging(self._spec.instance, self._spec.seed + 1))
        pose = self._cast.pose(element)
        return pose if pose == other.pose(element) else None

    def _is_world(self) -> bool:
        """Return whether the frame in which poses are given is that of the ``.scenex``: by its name, or by the user."""
        anchor = "" if self._spec.instance is None else self._spec.instance.anchor
        names = {"world", "map", local_name(anchor)}
        return self._stated_world or local_name(self._world).casefold() in names

    def _root(self) -> str:
        """Return the frame without a parent that the frames have in common."""
        roots: dict[str, str] = {}
        for frame in self.of.values():
            try:
                roots.setdefault(root_of(frame, self._tracks), frame)
            except Unconnected as problem:
                self._remarks.append(str(problem))
        if len(roots) > 1:
            listed = ", ".join(f"'{frame}' in '{root}'" for root, frame in roots.items())
            hint = "name the frame of the world with --world FRAME"
            self._remarks.append(f"the frames are not connected: {listed}; {hint}")
        return next(iter(roots), "")


def _events(spec: ScenarioSpec, contents: LogContents, remarks: list[str]) -> tuple[EventStamp, ...]:
    """Return the events of a scenario in a log. Without a report, the scenario starts and ends with the log."""
    stamps: list[EventStamp] = []
    for event, emitter in spec.events.items():
        times = occurrences_of(event, emitter, contents.texts)
        if emitter not in (START, END):
            stamps += (EventStamp(event, time, number) for number, time in enumerate(times, start=1))
            continue
        if not times:
            times = [0.0 if emitter == START else contents.end]
            remarks.append(f"the log does not report {event}: the {emitter.rpartition('-')[2]} of the log counts")
        stamps += (EventStamp(event, time) for time in times)
    return tuple(sorted(stamps, key=lambda stamp: stamp.time))


def _times(used: Iterable[str], events: Iterable[EventStamp], contents: LogContents, request: LogRequest) -> FloatArray:
    """Return the times of the trace's samples, s.

    These are the observations of the frames ``used``, thinned out to the largest rate, the messages on truths, the
    events, and one time in each gap.
    """
    moving = [contents.tracks[frame].times for frame in used if not contents.tracks[frame].static]
    seen = np.unique(np.concatenate([*moving, np.empty(0)]))
    slots = np.floor(seen * request.rate)
    kept = seen[np.concatenate([[True], slots[1:] > slots[:-1]])] if len(seen) else seen
    reported = [found.times for found in contents.truths.values()]
    edges = [*(stamp.time for stamp in events), 0.0, contents.end]
    times = np.unique(np.concatenate([kept, *reported, edges]))
    # Without a sample in a gap, a clause would be judged across it.
    long = np.diff(times) > request.max_gap
    return np.unique(np.concatenate([times, (times[:-1] + times[1:])[long] / 2]))


def _sampled(truths: Truths, times: FloatArray) -> FloatArray:
    """Return the last reported truth at each time; NaN before the first report."""
    rows = np.searchsorted(truths.times, times, side="right") - 1
    return np.where(rows < 0, np.nan, truths.values[np.maximum(rows, 0)])


def _grips(
    cast: Cast, names: Sequence[str], frames: _Frames, texts: Iterable[TextStamp], times: FloatArray
) -> dict[str, FloatArray]:
    """Return the objects that each agent holds, (n, len(names)), for the agents about which the log reports it."""
    found: dict[str, FloatArray] = {}
    known = {word: name for name in names for word in (name, local_name(name), frames.of.get(name, name))}
    for agent in cast.agents:
        own = [one for one in texts if one.topic.strip("/").split("/")[-2:] == [local_name(agent), HOLDS]]
        if not own:
            continue
        record = np.zeros((len(times), len(names)))
        # Before its first message, it is unknown what the agent holds.
        record[times < own[0].time] = np.nan
        for one, until in zip(own, [*(later.time for later in own[1:]), np.inf], strict=True):
            rows = (times >= one.time) & (times < until)
            if one.text.strip() in known:
                record[rows, names.index(known[one.text.strip()])] = 1.0
            elif one.text.strip():
                record[rows] = np.nan
        found[agent] = record
    return found
