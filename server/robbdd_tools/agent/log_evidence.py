"""Turn the contents of a log into the trace of a scenario. No world is simulated."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.catalog.settings import written
from robbdd_tools.judging.log_names import FramesProblem, frame_of, local_name, occurrences_of, stated_frames
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
    trace has a sample at each observation of a frame that is used, at most ``request.rate`` per second, and at each
    event. A value is NaN where nothing was observed. Raises ``SceneError`` if an element has no model.
    """
    staging = None if spec.instance is None else Staging(spec.instance, spec.seed)
    cast = cast_scene(spec.scene, staging)
    remarks = list(contents.remarks)
    frames = _frames(spec, cast, contents, request, remarks)
    events, bounds = _events(spec, contents)
    remarks += bounds
    world = request.world.lstrip("/") or _root(frames.values(), contents, remarks)
    times = _times(frames.values(), events, contents, request.rate, request.max_gap)
    names: list[str] = []
    positions: list[FloatArray] = []
    turns: list[FloatArray] = []
    for element in (*cast.objects, *cast.agents):
        found = _poses(element, spec, frames, cast, contents, world, times, request.max_gap, remarks)
        if found is not None:
            names.append(element)
            positions.append(found[0])
            turns.append(found[1])
    count = len(times)
    trace = Trace(
        tuple(names),
        times,
        np.stack(positions, axis=1) if positions else np.empty((count, 0, 3)),
        np.stack(turns, axis=1) if turns else np.empty((count, 0, 4)),
        grips=_grips(cast, names, contents.texts, times, frames),
        events=events,
        settings={pair: written(value) for pair, value in cast.judged.items()},
        outlines={name: outline_of(model) for name, model in cast.objects.items()},
        contents={workspace: contents_of(spec.scene, workspace) for workspace in spec.scene.contains},
        log=Path(request.path).name,
        truths={topic: _sampled(found, times) for topic, found in contents.truths.items()},
        immovable=(*(name for name, model in cast.objects.items() if not model.free), *cast.agents),
    )
    return LogEvidence(Evidence(trace, cast.regions), tuple(dict.fromkeys(remarks)), cast)


def _frames(
    spec: ScenarioSpec, cast: Cast, contents: LogContents, request: LogRequest, remarks: list[str]
) -> dict[str, str]:
    """Return the frame of each element that has one."""
    stated = {**stated_frames(spec), **request.frames}
    found: dict[str, str] = {}
    for element in (*cast.objects, *cast.agents):
        try:
            found[element] = frame_of(element, contents.tracks, stated)
        except FramesProblem as problem:
            if element in (*spec.scene.objects, *spec.scene.agents) and element not in spec.scene.unused:
                remarks.append(str(problem))
    return found


def _root(frames: Iterable[str], contents: LogContents, remarks: list[str]) -> str:
    """Return the frame without a parent that the frames have in common."""
    roots: dict[str, str] = {}
    for frame in frames:
        try:
            roots.setdefault(root_of(frame, contents.tracks), frame)
        except Unconnected as problem:
            remarks.append(str(problem))
    if len(roots) > 1:
        listed = ", ".join(f"'{frame}' in '{root}'" for root, frame in roots.items())
        remarks.append(f"the frames are not connected: {listed}; name the frame of the world with --world FRAME")
    return next(iter(roots), "")


def _events(spec: ScenarioSpec, contents: LogContents) -> tuple[tuple[EventStamp, ...], list[str]]:
    """Return the events of a scenario in a log. Without a report, the scenario starts and ends with the log."""
    stamps: list[EventStamp] = []
    remarks: list[str] = []
    for event, emitter in spec.events.items():
        times = occurrences_of(event, emitter, contents.texts)
        if not times and emitter in (START, END):
            times = [0.0 if emitter == START else contents.end]
            edge = "start" if emitter == START else "end"
            remarks.append(f"the log does not report {event}: the {edge} of the log counts")
        inner = emitter not in (START, END)
        stamps += (EventStamp(event, time, number if inner else 0) for number, time in enumerate(times, start=1))
    return tuple(sorted(stamps, key=lambda stamp: stamp.time)), remarks


def _times(
    frames: Iterable[str], events: Iterable[EventStamp], contents: LogContents, rate: float, max_gap: float
) -> FloatArray:
    """Return the times of the trace's samples, s.

    These are the observations, thinned out to ``rate`` (Hz), the events, and one time in each gap.
    """
    used = _used(frames, contents)
    moving = [track.times for frame, track in contents.tracks.items() if not track.static and frame in used]
    seen = np.unique(np.concatenate([*moving, np.empty(0)]))
    slots = np.floor(seen * rate)
    kept = seen[np.concatenate([[True], slots[1:] > slots[:-1]])] if len(seen) else seen
    reported = [found.times for found in contents.truths.values()]
    edges = [*(stamp.time for stamp in events), 0.0, contents.end]
    times = np.unique(np.concatenate([kept, *reported, edges]))
    # Without a sample in a gap, a clause would be judged across it.
    long = np.diff(times) > max_gap
    return np.unique(np.concatenate([times, (times[:-1] + times[1:])[long] / 2]))


def _used(frames: Iterable[str], contents: LogContents) -> set[str]:
    """Return the frames, and those between them and their roots."""
    found: set[str] = set()
    for frame in frames:
        while frame in contents.tracks and frame not in found:
            found.add(frame)
            frame = contents.tracks[frame].parent
    return found


def _stated_pose(element: str, cast: Cast, spec: ScenarioSpec) -> Pose | None:
    """Return the pose of an object that the ``.scenex`` states; ``None`` if it states none, or draws it at random."""
    if spec.instance is None or element not in cast.objects:
        return None
    other = replace(cast, staging=Staging(spec.instance, spec.seed + 1))
    pose = cast.pose(element)
    return pose if pose == other.pose(element) else None


def _poses(
    element: str,
    spec: ScenarioSpec,
    frames: Mapping[str, str],
    cast: Cast,
    contents: LogContents,
    world: str,
    times: FloatArray,
    max_gap: float,
    remarks: list[str],
) -> tuple[FloatArray, FloatArray] | None:
    """Return the poses of an element at some times: positions (n, 3) m and orientations (n, 4); ``None`` if unknown."""
    if element in frames:
        try:
            place, turn = poses_at(frames[element], world, contents.tracks, times, max_gap)
        except Unconnected as problem:
            remarks.append(str(problem))
            return None
        if element in cast.objects:
            offset = np.tile(cast.objects[element].frame, (len(times), 1))
            place = place - rotated(turn, offset)
        return place, turn
    pose = _stated_pose(element, cast, spec)
    if pose is None:
        return None
    remarks.append(f"{element} is not in the log, so it stands where the .scenex places it")
    half = pose.yaw / 2
    turned = pose.rotation or (float(np.cos(half)), 0.0, 0.0, float(np.sin(half)))
    return np.tile(pose.position, (len(times), 1)), np.tile(turned, (len(times), 1))


def _sampled(truths: Truths, times: FloatArray) -> FloatArray:
    """Return the last reported truth at each time; NaN before the first report."""
    rows = np.searchsorted(truths.times, times, side="right") - 1
    return np.where(rows < 0, np.nan, truths.values[np.maximum(rows, 0)])


def _grips(
    cast: Cast, names: list[str], texts: Iterable[TextStamp], times: FloatArray, frames: Mapping[str, str]
) -> dict[str, FloatArray]:
    """Return what each agent holds, as far as the log says it (``HOLDS``)."""
    found: dict[str, FloatArray] = {}
    known = {word: name for name in names for word in (name, local_name(name), frames.get(name, name))}
    for agent in cast.agents:
        own = [one for one in texts if one.topic.strip("/").split("/")[-2:] == [local_name(agent), HOLDS]]
        if not own:
            continue
        record = np.zeros((len(times), len(names)))
        for index, one in enumerate(own):
            until = own[index + 1].time if index + 1 < len(own) else np.inf
            held = known.get(one.text.strip())
            if held is not None:
                record[(times >= one.time) & (times < until), names.index(held)] = 1.0
        # Before its first message, it is unknown what the agent holds.
        record[times < own[0].time] = np.nan
        found[agent] = record
    return found
