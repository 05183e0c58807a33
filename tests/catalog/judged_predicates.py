"""Judge predicates on traces made by hand."""

from __future__ import annotations

from dataclasses import replace

from monitor.traces import still, trace_of
from robbdd_tools.catalog.api import Arguments, Region
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.judge import judge
from robbdd_tools.monitor.time import During
from robbdd_tools.monitor.trace import Trace
from robbdd_tools.monitor.verdict import Verdict

REGIONS = {
    "tray_ws": (("tray", Region((0.0, 0.0, 0.1), (0.2, 0.1, 0.1))),),
    "far_ws": (("far", Region((0.0, 0.0, 0.1), (0.2, 0.1, 0.1))),),
    "both_ws": (
        ("tray", Region((0.0, 0.0, 0.1), (0.2, 0.1, 0.1))),
        ("far", Region((0.0, 0.0, 0.1), (0.2, 0.1, 0.1))),
    ),
}


def judged(predicate: str, trace: Trace, **arguments: str | tuple[str, ...]) -> Verdict:
    whole = During("start", "end")
    words: Arguments = arguments
    return judge(load_catalog().predicates[predicate], words, whole, trace, REGIONS)


def world(count: int = 2, **paths: list[list[float]]) -> Trace:
    bodies = {"tray": still(count), "far": still(count, (1.0, 0.0, 0.0)), **paths}
    return trace_of(bodies, {"start": 0.0, "end": (count - 1) * 0.1}, {"arm": {"ball": [1.0] * count}})


def limited(trace: Trace, target: str, name: str, value: str) -> Trace:
    """A trace in which an element has a configuration of how to judge it."""
    return replace(trace, settings={(target, name): value})


BALL_OUTLINE = {"ball": (((0.0, 0.0, 0.0), 0.03),)}
