"""Write an execution so far to a file, for drawing it during a pause."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.agent.show_trace import shown
from robbdd_tools.base.writing import replace_file
from robbdd_tools.world.log_views import views

if TYPE_CHECKING:
    from robbdd_tools.agent.clause_watch import ClauseWatch
    from robbdd_tools.agent.execution import Execution

DRAWN = ("/geometry", "/tf")


def write_scene(path: str, execution: Execution, watch: ClauseWatch) -> str:
    """Write the execution so far as JSON to a file. Return the reason if this fails, otherwise an empty text.

    The object has those parts of ``docs/schemas/trace.schema.json`` that the simulation knows. ``parts`` maps the
    feature lines of clauses to their curves.
    """
    trace = execution.trace
    seen: dict[str, list[tuple[float, Any]]] = {topic: [] for topic in DRAWN}
    for time, topic, message in views(execution.simulation, trace, last=True):
        if topic in seen:
            seen[topic].append((time, message))
    events = sorted(trace.events, key=lambda stamp: stamp.time)
    document = {
        "duration": trace.end,
        "remark": trace.remark,
        "events": [{"name": stamp.name, "time": stamp.time} for stamp in events],
        "parts": {str(line): curves for line, curves in watch.curves().items()},
        **shown(seen),
    }
    try:
        replace_file(Path(path), json.dumps(document, ensure_ascii=False) + "\n")
    except OSError as error:
        return f"{path}: {error.strerror or error}"
    return ""
