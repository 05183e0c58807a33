"""``python -m robbdd_tools.agent.show_trace RUN INDEX``: print the contents of a stored trace as one JSON object.

The object has those parts of ``docs/schemas/trace.schema.json`` that are read from the trace: shapes, meshes, bodies,
frames, workspaces, tools and forces. Exit codes: 0 done; 2 the trace cannot be read, with the reason on standard error.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.traces.mcap_file import UnreadableTrace, read_trace, read_views
from robbdd_tools.world.arrays import array

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.monitor.trace import Trace

FAILED = 2
FRAMES = 4000
"""Maximum number of frames; longer executions are thinned to every second one, every third …"""
SAME = 1e-6
"""Stamps belong to the same sample if they differ by at most this (s)."""


def show(path: Path) -> dict[str, Any]:
    """Return the contents of a trace that can be displayed. Raises ``UnreadableTrace``."""
    seen = read_views(path, ("/geometry", "/tf"))
    if not seen["/tf"] or not seen["/geometry"]:
        raise UnreadableTrace(f"{path} was stored by an older version and has no shapes: run the scenario again")
    return shown(seen, read_trace(path).trace)


def shown(seen: Mapping[str, Sequence[tuple[float, Any]]], trace: Trace | None = None) -> dict[str, Any]:
    """Return the views of an execution (time in s and message, by topic) in the form in which they are displayed.

    Tools and forces are from its ``trace``; without a trace, there are none.
    """
    transforms = [message["transforms"] for _, message in seen["/tf"]]
    geometry = seen["/geometry"][0][1]
    start = {frame["child_frame_id"]: _pose(frame) for frame in transforms[0]}
    numbers = {name: number for number, name in enumerate(start)}
    moving = [frame["child_frame_id"] for frame in transforms[-1]] if len(transforms) > 1 else []
    every = -(-len(transforms) // FRAMES)
    times = np.array([time for time, _ in seen["/tf"]][::every])
    tools: dict[str, FloatArray] = {}
    rows = np.zeros(0, dtype=np.intp)
    if trace is not None:
        rows = np.clip(np.searchsorted(trace.times, times - SAME), 0, len(trace.times) - 1)
        tools = {agent: poses for agent in trace.grips if np.isfinite(poses := _tool(trace, agent)[rows]).all()}
    bodies = [_body(name, pose) for name, pose in start.items()]
    bodies += [_body(f"{agent}/tool", poses[0].tolist()) for agent, poses in tools.items()]
    numbers |= {agent: len(start) + index for index, agent in enumerate(tools)}
    return {
        "shapes": [{**shape, "body": numbers[shape["body"]]} for shape in geometry["shapes"]],
        "meshes": geometry["meshes"],
        "bodies": bodies,
        "frames": {
            "times": array(times, "float32"),
            "bodies": [numbers[name] for name in (*moving, *tools)],
            "poses": array(
                np.concatenate(
                    [_poses(transforms[::every], moving), *(poses[:, None] for poses in tools.values())], axis=1
                ),
                "float32",
            ),
        },
        "tools": [{"agent": agent, "body": numbers[agent]} for agent in tools],
        "forces": None if trace is None or trace.log else _forces(trace, rows, numbers),
        "workspaces": [{**space, "body": numbers.get(space["body"])} for space in geometry["workspaces"]],
    }


def _body(name: str, pose: Sequence[float]) -> dict[str, Any]:
    return {"name": name.removesuffix("/solid"), "position": pose[:3], "orientation": pose[3:]}


def _tool(trace: Trace, agent: str) -> FloatArray:
    """Return the poses of an agent's tool: x, y, z (m), then w, x, y, z; shape (n, 7)."""
    column = trace.column(agent)
    return np.hstack([trace.positions[:, column], trace.orientations[:, column]])


def _forces(trace: Trace, rows: NDArray[np.intp], numbers: Mapping[str, int]) -> list[dict[str, Any]]:
    """Return the contact forces between elements: at each picture, the largest force since the previous picture.

    So no force is left out. ``rows`` (k,) are the samples of the pictures; the last one also has the forces after it.
    """
    starts = [0, *(row + 1 for row in rows[:-1])]
    found: dict[tuple[str, str], FloatArray] = {}
    for pair, forces in (*trace.forces.items(), *trace.touches.items()):
        first, second = sorted(pair, key=lambda name: (name not in trace.grips, name))
        found[first, second] = np.maximum(found.get((first, second), 0.0), forces)
    return [
        {
            "between": [first, second],
            "bodies": [numbers.get(first), numbers.get(second)],
            "peaks": array(np.maximum.reduceat(forces, starts), "float32"),
        }
        for (first, second), forces in sorted(found.items())
        if forces.any()
    ]


def _poses(transforms: Sequence[Sequence[Mapping[str, Any]]], moving: Sequence[str]) -> np.ndarray[Any, Any]:
    found = np.empty((len(transforms), len(moving), 7))
    column = {name: index for index, name in enumerate(moving)}
    for row, frames in enumerate(transforms):
        for frame in frames:
            if frame["child_frame_id"] in column:
                found[row, column[frame["child_frame_id"]]] = _pose(frame)
    return found


def _pose(frame: Mapping[str, Any]) -> list[float]:
    place, turn = frame["translation"], frame["rotation"]
    return [place["x"], place["y"], place["z"], turn["w"], turn["x"], turn["y"], turn["z"]]


def _main() -> int:
    folder, index = sys.argv[1:]
    try:
        print(json.dumps(show(trace_file(Path(folder), int(index))), ensure_ascii=False))
    except UnreadableTrace as error:
        print(error, file=sys.stderr)
        return FAILED
    return 0


if __name__ == "__main__":
    sys.exit(_main())
