"""Draw the scene instances of an edited ``.scenex``, in a process of its own with limited time and memory."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

from robbdd_tools.base.limits import MESSAGE_SIZE, MIB
from robbdd_tools.workbench.scene_findings import (
    answer_of,
    declares_instance,
    file_states,
    instances_of,
    request_for,
)

if TYPE_CHECKING:
    from robbdd_tools.names.project import Snapshot

DRAW = "robbdd_tools.agent.draw_scenes"


@dataclass(frozen=True, slots=True)
class DrawingRequest:
    """The request for the process, and the state of the files that it reads."""

    request: str
    files: str


def drawing_request(snapshot: Snapshot, uri: str) -> DrawingRequest | None:
    """Return the request for the scene instances of a file without errors; ``None`` if it declares none."""
    if not declares_instance(snapshot, uri):
        return None
    own = instances_of(snapshot, uri)
    return DrawingRequest(request_for(own), repr(list(file_states(own))))


def draw(asked: DrawingRequest) -> list[dict[str, Any]] | str:
    """Return the drawn scene instances, or the reason as text if they cannot be drawn. This takes seconds."""
    found = answer_of(DRAW, asked.request)
    if isinstance(found, str):
        return found
    scenes = cast("list[dict[str, Any]]", found)
    size = sum(len(array["data"]) for scene in scenes for mesh in scene["meshes"] for array in mesh.values())
    if size > MESSAGE_SIZE.value():
        return f"their meshes have {size / MIB:.0f} MiB (the limit {MESSAGE_SIZE.name})"
    return scenes
