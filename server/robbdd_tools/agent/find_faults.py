"""``python -m robbdd_tools.agent.find_faults``: find the faults of scene instances that every run would have.

The process reads scene instances and unsaved texts of their files as JSON from standard input, and writes a list of
faults as JSON to standard output. It neither steps a world nor executes users' code.
"""

from __future__ import annotations

import json
import os
import sys
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.agent.standard_streams import reserve_channel
from robbdd_tools.base.graphics import without_graphics
from robbdd_tools.base.limits import SCENE_MEMORY, SCENE_SECONDS
from robbdd_tools.base.plain import from_plain
from robbdd_tools.base.processes import limit_memory, limit_processor_time
from robbdd_tools.base.source_texts import use_unsaved
from robbdd_tools.catalog.executable import SceneInstance
from robbdd_tools.protocol.scene_faults import FaultKind, SceneFault

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from robbdd_tools.world.errors import SceneError


def _faults(instance: SceneInstance) -> Iterator[SceneFault]:
    from robbdd_tools.world.fixed_faults import fixed_faults

    for error in fixed_faults(instance):
        yield SceneFault(kind_of(error), error.reason, error.origin or instance.origin, error.entry)


def kind_of(error: SceneError) -> FaultKind:
    """Return the part of a scene that an error is about."""
    from robbdd_tools.world.frames import PoseError
    from robbdd_tools.world.overlaps import Overlap

    if isinstance(error, Overlap):
        return FaultKind.OVERLAP
    return FaultKind.POSE if isinstance(error, PoseError) else FaultKind.MODEL


def answer_instances(answer: Callable[[list[SceneInstance]], list[dict[str, Any]]]) -> None:
    """Answer the scene instances on standard input, with limited memory and processor time."""
    requests, answers = reserve_channel()
    # A model in an opened folder may demand any amount of memory or time.
    limit_memory(SCENE_MEMORY.value())
    limit_processor_time(SCENE_SECONDS.value())
    without_graphics()
    with os.fdopen(requests, encoding="utf-8") as stream:
        request = json.load(stream)
    use_unsaved({Path(path): text for path, text in request["sources"].items()})
    instances = [from_plain(SceneInstance, one) for one in request["instances"]]
    found = answer(instances)
    with os.fdopen(answers, "w", encoding="utf-8") as stream:
        json.dump(found, stream)


def main() -> None:
    """Answer the request on standard input."""
    answer_instances(lambda instances: [asdict(fault) for instance in instances for fault in _faults(instance)])


if __name__ == "__main__":
    sys.exit(main())
