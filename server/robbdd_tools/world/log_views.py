"""Data of an execution for log viewers: moving frames, their shapes, joints, events."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.drawn_shapes import DIGITS, color, geometry, shown_geoms
from robbdd_tools.world.engine import mujoco

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.monitor.judge import Regions
    from robbdd_tools.monitor.trace import Trace
    from robbdd_tools.protocol.messages import ClauseJudged
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.traces.mcap_file import View
    from robbdd_tools.world.simulation import Simulation

EVERY = 4
"""One of this many samples is a picture: about 16 per second are enough; the exact trace has all samples."""
PERIOD = 1 / 16
"""Seconds between two pictures of observations."""
WORLD = "world"
UPRIGHT = (1.0, 0.0, 0.0, 0.0)
"""Orientation (w, x, y, z) with which a thing is drawn whose orientation a log lacks."""


def views(simulation: Simulation, trace: Trace, *, last: bool = False) -> Iterator[View]:
    """Yield the views of an execution topic by topic; each is stamped with simulated time.

    With ``last``, there is a picture of the last sample, too.
    """
    for stamp in trace.events:
        yield stamp.time, "/events", {"name": stamp.name, "time": stamp.time}
    model = simulation.model
    names = drawn_bodies(model)
    bodies = list(names)
    yield 0.0, "/geometry", geometry(model, names, simulation.world.cast.regions)
    solids = {body: shapes for body in bodies if (shapes := _shapes(model, body))}
    yield 0.0, "/scene", {"deletions": [], "entities": [_entity(names[body], solids[body]) for body in solids]}
    scratch = mujoco.MjData(model)
    states = simulation.recorder.states
    moving = [body for body in bodies if model.body_weldid[body] != 0]
    rows = dict.fromkeys((*range(0, len(states), EVERY), *((len(states) - 1,) if last else ())))
    for row in rows:
        time = float(trace.times[row])
        scratch.qpos[:] = states[row]
        mujoco.mj_kinematics(model, scratch)
        shown = bodies if row == 0 else moving
        places, turns = scratch.xpos[shown].round(DIGITS).tolist(), scratch.xquat[shown].round(DIGITS).tolist()
        yield time, "/tf", {"transforms": _frames(time, [names[body] for body in shown], places, turns)}
        if simulation.robots:
            yield time, "/joints", _joints(simulation, states[row])


def drawn_bodies(model: Any) -> dict[int, str]:
    """Return the names of the bodies that have something to draw, by their number in the engine's model."""
    bodies = [body for body in range(model.nbody) if next(shown_geoms(model, body), None) is not None]
    names = {body: str(model.body(body).name) or WORLD for body in bodies}
    return {body: f"{WORLD}/solid" if name == WORLD else name for body, name in names.items()}


def observed_views(model: Any, regions: Regions, trace: Trace) -> Iterator[View]:
    """Yield the views of a trace of observations. ``model`` is a compiled model that has a body for each object.

    An object is drawn where it was last observed, upright if the log does not say how it is turned; objects that were
    never observed are left out.
    """
    for stamp in trace.events:
        yield stamp.time, "/events", {"name": stamp.name, "time": stamp.time}
    bodies = {str(model.body(body).name): body for body in range(1, model.nbody)}
    seen = [name for name in trace.names if name in bodies and _is_seen(trace, name)]
    drawn = {bodies[name]: name for name in seen}
    carried = {workspace: [box for box in boxes if box[0] in seen] for workspace, boxes in regions.items()}
    yield 0.0, "/geometry", geometry(model, drawn, carried)
    solids = {name: shapes for body, name in drawn.items() if (shapes := _shapes(model, body))}
    yield 0.0, "/scene", {"deletions": [], "entities": [_entity(name, solids[name]) for name in solids]}
    if not seen:
        return
    rows = _shown(trace.times)
    columns = [trace.column(name) for name in seen]
    known = [_last_known(trace, column)[rows] for column in columns]
    places, turns = (
        np.stack([values[row, column] for row, column in zip(known, columns, strict=True)], axis=1).round(DIGITS)
        for values in (trace.positions, trace.orientations)
    )
    turns[np.isnan(turns).any(axis=2)] = UPRIGHT
    for time, place, turn in zip(trace.times[rows].tolist(), places, turns, strict=True):
        yield time, "/tf", {"transforms": _frames(time, seen, place.tolist(), turn.tolist())}


def _shown(times: FloatArray) -> list[int]:
    """Return the samples of which there are pictures: one per ``PERIOD``, and the last one."""
    found, shown = list[int](), -np.inf
    for row, time in enumerate(times):
        if time >= shown + PERIOD or row == len(times) - 1:
            found.append(row)
            shown = float(time)
    return found


def _is_seen(trace: Trace, name: str) -> bool:
    return bool(np.isfinite(trace.positions[:, trace.column(name)]).any())


def _last_known(trace: Trace, column: int) -> NDArray[np.intp]:
    """Return for each sample the last one at which a body was observed, or else the first one after it, shape (n,)."""
    missing = np.isnan(trace.positions[:, column]).any(axis=1)
    rows = np.maximum.accumulate(np.where(missing, -1, np.arange(len(trace.times))))
    return np.where(rows < 0, int(np.argmin(missing)), rows)


def verdict_views(spec: ScenarioSpec, judged: Sequence[ClauseJudged], end: float) -> Iterator[View]:
    """Yield the verdicts, each at its instant; a verdict without an instant is at the trace's end (s)."""
    clauses = {clause.line: clause for clause in spec.clauses}
    for one in judged:
        stated = clauses[one.line]
        clause = {"iri": stated.iri, "name": stated.name, "role": stated.role, "sentence": stated.sentence}
        details = {"verdict": one.verdict, "robustness": one.robustness, "unit": one.unit, "reason": one.reason}
        yield (end if one.at is None else one.at), "/verdicts", {**clause, **details}


def _joints(simulation: Simulation, state: FloatArray) -> dict[str, dict[str, float]]:
    return {
        name: dict(zip(robot.model.joints, state[robot.joints].round(DIGITS).tolist(), strict=True))
        for name, robot in simulation.robots.items()
    }


def _frames(
    time: float, names: Sequence[str], places: Sequence[Sequence[float]], turns: Sequence[Sequence[float]]
) -> list[dict[str, Any]]:
    stamp = _stamp(time)
    return [
        {
            "timestamp": stamp,
            "parent_frame_id": WORLD,
            "child_frame_id": name,
            "translation": {"x": place[0], "y": place[1], "z": place[2]},
            "rotation": {"x": turn[1], "y": turn[2], "z": turn[3], "w": turn[0]},
        }
        for name, place, turn in zip(names, places, turns, strict=True)
    ]


def _entity(name: str, shapes: dict[str, list[Any]]) -> dict[str, Any]:
    forever = {"sec": 0, "nsec": 0}
    nothing: dict[str, list[Any]] = {
        kind: []
        for kind in ("metadata", "arrows", "cubes", "spheres", "cylinders", "lines", "triangles", "texts", "models")
    }
    head = {"timestamp": _stamp(0.0), "frame_id": name, "id": name, "lifetime": forever, "frame_locked": True}
    return {**head, **nothing, **shapes}


def _shapes(model: Any, body: int) -> dict[str, list[Any]]:
    """Return the boxes, spheres and cylinders of a body, by the viewers' names; meshes are left out."""
    found: dict[str, list[Any]] = {}
    for geom in shown_geoms(model, body):
        half = model.geom_size[geom].tolist()
        match int(model.geom_type[geom]):
            case mujoco.mjtGeom.mjGEOM_BOX:
                kind, size = "cubes", [2 * side for side in half]
            case mujoco.mjtGeom.mjGEOM_SPHERE:
                kind, size = "spheres", [2 * half[0]] * 3
            case mujoco.mjtGeom.mjGEOM_CYLINDER | mujoco.mjtGeom.mjGEOM_CAPSULE:
                kind, size = "cylinders", [2 * half[0], 2 * half[0], 2 * half[1]]
            case _:
                continue
        found.setdefault(kind, []).append(_solid(model, geom, size))
    return found


def _solid(model: Any, geom: int, size: list[float]) -> dict[str, Any]:
    place, turn = model.geom_pos[geom].tolist(), model.geom_quat[geom].tolist()
    pose = {
        "position": dict(zip("xyz", place, strict=True)),
        "orientation": dict(zip("wxyz", turn, strict=True)),
    }
    shade = dict(zip("rgba", color(model, geom), strict=True))
    return {"pose": pose, "size": dict(zip("xyz", size, strict=True)), "color": shade}


def _stamp(time: float) -> dict[str, int]:
    nanoseconds = round(time * 1e9)
    return {"sec": nanoseconds // 10**9, "nsec": nanoseconds % 10**9}
