"""``python -m robbdd_tools.agent.draw_scenes``: draw scene instances as plain data.

The process reads scene instances and unsaved texts of their files as JSON from standard input, and writes the shapes
and faults of each one to standard output. It neither steps a world nor executes users' code.
"""

from __future__ import annotations

import sys
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from robbdd_tools.agent.find_faults import answer_instances, kind_of
from robbdd_tools.protocol.scene_faults import SceneFault

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import SceneInstance


def _drawn(instance: SceneInstance) -> dict[str, Any]:
    from robbdd_tools.world.instance_drawing import drawn_instance

    drawn, errors = drawn_instance(instance)
    faults = [
        SceneFault(kind_of(error), error.reason, error.origin or instance.origin, error.entry) for error in errors
    ]
    return {**drawn, "iri": instance.iri, "faults": [asdict(fault) for fault in faults]}


def main() -> None:
    """Answer the request on standard input."""
    answer_instances(lambda instances: list(map(_drawn, instances)))


if __name__ == "__main__":
    sys.exit(main())
