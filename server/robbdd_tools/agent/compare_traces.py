"""``python -m robbdd_tools.agent.compare_traces RUN OTHER``: find where the traces of two runs first differ.

For each scenario with a trace in OTHER, one JSON object is printed. It has the ``index`` of the scenario and the
``difference``, which is empty if the traces are bit-identical.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.traces.codec import pack
from robbdd_tools.traces.mcap_file import UnreadableTrace, read_trace

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.monitor.trace import Trace
    from robbdd_tools.traces.codec import Evidence


@dataclass(frozen=True, slots=True)
class _Divergence:
    """Two values that differ at the same sample."""

    row: int
    quantity: str
    ours: float
    theirs: float


def difference(first: Evidence, second: Evidence) -> str:
    """Return the sample and the quantity at which two traces first differ; empty if they are bit-identical."""
    if pack(first) == pack(second):
        return ""
    one, other = first.trace, second.trace
    if one.names != other.names:
        return "the scenes hold different bodies"
    found = [divergence for divergence in _divergences(one, other) if divergence is not None]
    if found:
        earliest = min(found, key=lambda divergence: divergence.row)
        time = one.times[earliest.row]
        return (
            f"step {earliest.row} ({time:.3f} s): {earliest.quantity} was {earliest.ours!r} and is {earliest.theirs!r}"
        )
    if len(one.times) != len(other.times):
        return (
            f"step {min(len(one.times), len(other.times))}: {len(one.times)} samples were taken, now {len(other.times)}"
        )
    for stamp, again in zip(one.events, other.events, strict=False):
        if stamp != again:
            return f"event {stamp.name} was at {stamp.time:.3f} s; event {again.name} is at {again.time:.3f} s"
    return "the traces differ apart from the samples (events, settings, regions)"


def _divergences(one: Trace, other: Trace) -> Iterator[_Divergence | None]:
    yield _first(one.times, other.times, "time", ())
    axes = ("x", "y", "z")
    yield _first(one.positions, other.positions, "position", (one.names, axes))
    yield _first(one.orientations, other.orientations, "orientation", (one.names, ("w", *axes)))
    for agent in one.grips.keys() & other.grips.keys():
        yield _first(one.grips[agent], other.grips[agent], f"grip of {agent}", (one.names,))
    for pair in one.forces.keys() & other.forces.keys():
        yield _first(one.forces[pair], other.forces[pair], f"force between {' and '.join(pair)}", ())
    for pair in one.impulses.keys() & other.impulses.keys():
        yield _first(one.impulses[pair], other.impulses[pair], f"impulse between {' and '.join(pair)}", ())
    for pair in one.reaches.keys() & other.reaches.keys():
        yield _first(one.reaches[pair], other.reaches[pair], f"reach of {' for '.join(pair)}", ())
    for pair in one.gaps.keys() & other.gaps.keys():
        yield _first(one.gaps[pair], other.gaps[pair], f"gap between {' and '.join(pair)}", ())


def _first(
    ours: FloatArray, theirs: FloatArray, quantity: str, labels: tuple[tuple[str, ...], ...]
) -> _Divergence | None:
    """Return the first position at which the bits of two arrays differ, up to the length of the shorter array."""
    rows = min(len(ours), len(theirs))
    bits = [np.ascontiguousarray(values[:rows]).view(np.uint64) for values in (ours, theirs)]
    places = np.argwhere(bits[0] != bits[1])
    if not len(places):
        return None
    place = tuple(int(index) for index in places[0])
    named = " ".join(label[index] for label, index in zip(labels, place[1:], strict=True))
    words = f"{quantity} of {named}" if named else quantity
    return _Divergence(place[0], words, float(ours[place]), float(theirs[place]))


def _main() -> int:
    run, other = map(Path, sys.argv[1:])
    for index in range(len(read_manifest(other).scenarios)):
        if not trace_file(other, index).is_file():
            continue
        try:
            words = difference(read_trace(trace_file(run, index)), read_trace(trace_file(other, index)))
        except UnreadableTrace as error:
            words = str(error)
        print(json.dumps({"index": index, "difference": words}))
    return 0


if __name__ == "__main__":
    sys.exit(_main())
