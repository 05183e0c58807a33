"""Turn the contents of a log into the trace of a scenario. No world is simulated."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from itertools import chain, count
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.agent.log_arms import find_arms
from robbdd_tools.agent.log_distances import far_apart
from robbdd_tools.agent.log_frames import Frames
from robbdd_tools.agent.log_grips import LogGrips, grip_signals
from robbdd_tools.base.large_arrays import large_array
from robbdd_tools.catalog.coordination import DEFINED, each_emitter, joined
from robbdd_tools.catalog.event_names import inner_event
from robbdd_tools.catalog.object_settings import can_move
from robbdd_tools.catalog.settings import written
from robbdd_tools.judging.defined_events import with_defined_events
from robbdd_tools.judging.scenario_clauses import iterations_of_events, statement_of
from robbdd_tools.logs.log_names import elements_of, local_name, occurrences_of
from robbdd_tools.logs.transforms import product, rotated
from robbdd_tools.monitor.trace import EventStamp, Trace
from robbdd_tools.protocol.clauses import EventOccurrence
from robbdd_tools.protocol.event_signals import read_event_signal
from robbdd_tools.traces.codec import Evidence
from robbdd_tools.world.cast import Cast
from robbdd_tools.world.extent import outline_of
from robbdd_tools.world.scene import cast_scene, contents_of
from robbdd_tools.world.staging import Staging

if TYPE_CHECKING:
    from robbdd_tools.agent.log_arms import LoggedArm
    from robbdd_tools.agent.log_frames import Poses
    from robbdd_tools.catalog.api import FloatArray, ObjectModel
    from robbdd_tools.logs.log_contents import LogContents
    from robbdd_tools.protocol.log_request import LogRequest
    from robbdd_tools.protocol.specs import ScenarioSpec

BLOCK = 65536
"""This many samples are computed at once."""
FASTER = 1.1
"""Times that follow each other up to this many times as fast as samples are judged are nearly all judged."""
START, END = "scenario-start", "scenario-end"


@dataclass(frozen=True, slots=True)
class LogEvidence:
    """The evidence of a log on one scenario, and sentences about missing data and assumptions."""

    evidence: Evidence
    remarks: tuple[str, ...]
    cast: Cast


def evidence_of(spec: ScenarioSpec, contents: LogContents, request: LogRequest) -> LogEvidence:
    """Return the evidence of a log on a scenario.

    Positions are in the frame of the world; the origin of a frame is the origin of the element's model. The trace has a
    sample at each observation of a used frame (at most ``request.rate`` per second), at each event and in each gap. A
    value is NaN where nothing was observed. An element without a model is a point. Raises ``SceneError`` for an
    impossible scene, and ``NoElement`` or ``NoGripSignal`` if the request names something that does not exist.
    """
    staging = None if spec.instance is None else Staging(spec.instance, spec.seed)
    cast = cast_scene(spec.scene, staging, of_log=True)
    remarks = list(contents.remarks)
    events = _events(spec, contents, [read_event_signal(one).event for one in request.signals], remarks)
    elements = (*cast.objects, *cast.agents, *cast.points)
    arms = find_arms(cast, contents, request, remarks)
    frames = Frames(spec, cast, contents, request, remarks, arms)
    grips, signals = LogGrips(cast, contents, frames.of, request.max_gap), grip_signals(request.grips, cast)
    observed = [
        *frames.observed(),
        *(track.times for arm in arms.values() for track in arm.tracks),
        *grips.observed(signals),
    ]
    remarks += _thinned_out(observed, request.rate)
    times = _times(observed, events, contents, request)
    joints = {agent: arm.positions(times, request.max_gap) for agent, arm in arms.items()}

    def poses_of(element: str, rows: slice) -> Poses | None:
        if element in cast.objects:
            return frames.object_poses(element, times[rows])
        found = frames.poses(element, times[rows])
        if found is None and element in arms:
            found = _tool(arms[element], joints[element][rows], frames.base_poses(element, times[rows]))
        return found

    known = [element for element in elements if poses_of(element, slice(0, 1)) is not None]
    names = (*known, *(name for name in dict.fromkeys(one.held for one in signals) if name and name not in known))
    positions, orientations = (large_array((len(times), len(names), width)) for width in (3, 4))
    for column, name in enumerate(names):
        for first in range(0, len(times), BLOCK):
            rows = slice(first, first + BLOCK)
            found = poses_of(name, rows) if name in known else None
            positions[rows, column], orientations[rows, column] = (np.nan, np.nan) if found is None else found
    poses = {name: (positions[:, column], orientations[:, column]) for column, name in enumerate(known)}
    trace = Trace(
        names,
        times,
        positions,
        orientations,
        grips=grips.held(signals, names, times, poses),
        events=events,
        settings={pair: written(value) for pair, value in cast.judged.items()},
        outlines={name: outline_of(model) for name, model in cast.objects.items()},
        contents={workspace: contents_of(spec.scene, workspace) for workspace in spec.scene.contains},
        correct_places=spec.scene.correct_places,
        log=Path(request.path).name,
        uncertain=elements_of(request.uncertainty, elements),
        truths={topic: found.at(times, request.max_gap) for topic, found in contents.truths.items()},
        joint_clearances={
            agent: shares for agent, arm in arms.items() if (shares := arm.clearance(joints[agent])) is not None
        },
        stated=tuple(name for name in known if name in cast.every_object and frames.is_stated(name)),
        immovable=(*(name for name, model in cast.objects.items() if not can_move(model)), *cast.every_agent),
    )
    remarks += (*frames.steps(), *frames.holes(), *_shapes(cast, known), *far_apart(trace))
    trace = with_defined_events(trace, spec.defined, cast.regions, numbered=not spec.node)
    return LogEvidence(Evidence(trace, cast.regions), tuple(dict.fromkeys(remarks)), cast)


def _shapes(cast: Cast, known: Collection[str]) -> Iterator[str]:
    """Yield sentences about the observed elements whose shape is guessed or unknown."""
    guessed = [f"{name} as {_described(cast.objects[name])}" for name in cast.by_name if name in known]
    if guessed:
        yield f"models of the catalog, by name: {', '.join(guessed)}; state others in a .scenex"
    for name in cast.points:
        if name in known:
            yield f"{name} has no model: it is the point at its frame, and what depends on its shape is unknown"


def _described(model: ObjectModel) -> str:
    """Return the name of a model, and how far its middle is from its frame: distances are from the middle."""
    away = 1000 * float(np.linalg.norm(model.frame))
    return model.name if away < 1.0 else f"{model.name}, whose middle is {away:.0f} mm from its frame"


def _events(
    spec: ScenarioSpec, contents: LogContents, signals: Collection[str], remarks: list[str]
) -> tuple[EventStamp, ...]:
    """Return the events of a scenario in a log. If the log does not report its start and end, they are the log's.

    If the recording was interrupted, the end of the log is not the end of the scenario; nor is it if the scenario's end
    is among the events of the declared ``signals``.
    """
    stamps: list[EventStamp] = []
    iterations = {**_awaited(spec), **iterations_of_events(spec)}
    for event, emitter in spec.events.items():
        if emitter == DEFINED:
            continue
        found = occurrences_of(event, _with_own_name(emitter, spec), contents.texts, signals)
        times = [one.time for one in found]
        if len(topics := {one.topic: None for one in found if not one.declared}) > 1:
            listed = " and ".join(f"'{topic}'" for topic in topics)
            remarks.append(f"{event} is reported on {listed}: --event '{local_name(event)}=TOPIC is TEXT' chooses one")
        if emitter not in (START, END):
            numbers = chain(sorted(iterations.get(event, ())), count(1 + max(iterations.get(event, ()), default=0)))
            stamps += (EventStamp(event, time, number) for number, time in zip(numbers, times, strict=False))
            continue
        if not times and emitter == END and contents.unfinished:
            remarks.append(f"the log does not report {event}, and its recording did not end: when it was is not known")
        elif not times and any(inner_event(one, [local_name(event)]) for one in signals):
            remarks.append(f"the log does not report {event} by its signal: when it was is not known")
        elif not times:
            times = [0.0 if emitter == START else contents.end]
            remarks.append(f"the log does not report {event}: the {emitter.rpartition('-')[2]} of the log counts")
        stamps += (EventStamp(event, time) for time in times)
    return tuple(sorted(stamps, key=lambda stamp: stamp.time))


def _with_own_name(emitters: str, spec: ScenarioSpec) -> str:
    """Add to an event's emitters the names that they have by themselves, if no other behaviour has one of that name."""
    every = {one for source in spec.events.values() for one in each_emitter(source) if " " in one}
    own = each_emitter(emitters)
    names = [one.rpartition(" ")[2] for one in own if one in every]
    return joined([*own, *(name for name in names if sum(one.endswith(f" {name}") for one in every) == 1)])


def _awaited(spec: ScenarioSpec) -> dict[str, set[int]]:
    """Map each event of a When to the iterations that wait for it."""
    found: dict[str, set[int]] = {}
    for clause in spec.clauses:
        statement = statement_of(clause) if clause.role == "when" and clause.iterations else None
        if isinstance(statement, EventOccurrence):
            found.setdefault(statement.event, set()).add(clause.iterations[0])
    return found


def _tool(arm: LoggedArm, positions: FloatArray, base: Poses | None) -> Poses | None:
    """Return the poses of a tool in the world at joint positions (n, joints), if the base is known."""
    if base is None:
        return None
    origin, turn = base
    place, rotation = arm.tool(positions)
    return origin + rotated(turn, place), product(turn, rotation)


def _times(
    observed: Iterable[FloatArray], events: Iterable[EventStamp], contents: LogContents, request: LogRequest
) -> FloatArray:
    """Return the times of the trace's samples, s.

    These are the times ``observed`` of frames and joints, thinned out to the largest rate, the messages on truths, the
    events, and one time in each gap.
    """
    kept = np.empty(0)
    for one in observed:
        thinned = [_thinned(one[first : first + BLOCK], request.rate) for first in range(0, len(one), BLOCK)]
        kept = _thinned(np.unique(np.concatenate([kept, *thinned])), request.rate)
    reported = [found.times for found in contents.truths.values()]
    edges = [*(stamp.time for stamp in events), 0.0, contents.end]
    times = np.unique(np.concatenate([kept, *reported, edges]))
    # Poses just outside a period only serve to interpolate poses in it.
    times = times[(times >= 0.0) & (times <= contents.end)]
    # Without a sample in a gap, a clause would be judged across it.
    long = np.diff(times) > request.max_gap
    return np.unique(np.concatenate([times, (times[:-1] + times[1:])[long] / 2]))


def _thinned_out(observed: Iterable[FloatArray], rate: float) -> list[str]:
    """Return a remark if some times (s) of observations follow each other faster than ``rate`` (1/s)."""
    recorded = max((1.0 / float(np.median(np.diff(one))) for one in observed if len(one) > 1), default=0.0)
    if recorded <= FASTER * rate:
        return []
    words = f"poses were recorded up to {recorded:.0f} times a second, and at most {rate:g} of these are judged"
    return [f"{words}: shorter peaks are not seen; --rate {recorded:.0f} judges all"]


def _thinned(times: FloatArray, rate: float) -> FloatArray:
    """Return the first of the times (n,) s, which increase, in each of the ``rate`` parts of a second."""
    slots = np.floor(times * rate)
    return times[np.concatenate([[True], slots[1:] > slots[:-1]])] if len(times) else times
