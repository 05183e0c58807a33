"""Draw a stored scene as markers of ROS: objects, links of arms, workspaces and events, for RViz and Foxglove."""

from __future__ import annotations

import base64
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

import numpy as np

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

Vector = Sequence[float]
Mesh = Mapping[str, Mapping[str, Any]]
"""``vertices`` and ``faces`` of a mesh, each an array as JSON."""
MARKERS = "/markers"
CUBE, SPHERE, CYLINDER, TEXT, TRIANGLES = 1, 2, 3, 9, 11
"""Types of ``visualization_msgs/msg/Marker``."""
WORKSPACE_COLOR = (0.2, 0.6, 1.0, 0.2)
TEXT_COLOR = (1.0, 1.0, 1.0, 1.0)
GROUND = 4.0
"""Edge (m) of the square that is drawn for an infinite plane."""
THIN = 0.001
"""Thickness (m) of a drawn plane, which is below the plane."""
TEXT_HEIGHT, TEXT_ABOVE, TEXT_SECONDS = 0.05, 0.2, 2
"""Height (m) of the name of an event, its place above the tool (m), and how long it is shown (s)."""
UPRIGHT = (1.0, 0.0, 0.0, 0.0)
WORLD = "world"
SOLID = "world/solid"


@dataclass(frozen=True, slots=True)
class Drawn:
    """A marker: its frame and group, a type of marker, and its pose (m; w, x, y, z) and edges (m) in the frame."""

    frame: str
    group: str
    type: int
    position: Vector
    orientation: Vector
    scale: Vector
    color: Vector
    points: Sequence[Vector] = ()
    text: str = ""
    seconds: int = 0


def frame_name(body: str) -> str:
    """Return the frame of a body: the local name of an element, or the names of an arm and its link, with a dot."""
    return WORLD if body == SOLID else body.rpartition(":")[2].replace("/", ".")


def scene_markers(geometry: Mapping[str, Any], frames: Mapping[str, Vector]) -> Iterator[Drawn]:
    """Yield the markers of a trace's ``/geometry``.

    ``frames`` maps an object to the position (m) of its model's frame in the object's coordinates, in which the shapes
    are given.
    """
    for shape in geometry["shapes"]:
        origin = np.array(frames.get(shape["body"], (0.0, 0.0, 0.0)))
        yield from _shape(shape, np.array(shape["position"]) - origin, geometry["meshes"])
    for space in geometry["workspaces"]:
        center = np.array(space["center"]) - np.array(frames.get(space["body"], (0.0, 0.0, 0.0)))
        scale = [2 * half for half in space["half"]]
        turn = space.get("orientation", UPRIGHT)
        name = f"workspace {frame_name(space['name'])}"
        yield Drawn(frame_name(space["body"]), name, CUBE, center.tolist(), turn, scale, WORKSPACE_COLOR)


def event_marker(event: str, frame: str) -> Drawn:
    """Return the text that shows an event above a frame."""
    place, scale = (0.0, 0.0, TEXT_ABOVE), (0.0, 0.0, TEXT_HEIGHT)
    text = event.rpartition(":")[2]
    return Drawn(frame, "events", TEXT, place, UPRIGHT, scale, TEXT_COLOR, text=text, seconds=TEXT_SECONDS)


def _shape(shape: Mapping[str, Any], place: FloatArray, meshes: Sequence[Mesh]) -> Iterator[Drawn]:
    """Yield the markers of a shape. Its sizes are those of the engine: half edges, radius and half length."""
    frame, turn, color = frame_name(shape["body"]), shape["orientation"], shape["color"]
    a, b, c = shape["size"]

    def one(kind: int, scale: Vector, shift: Vector = (0.0, 0.0, 0.0), points: Sequence[Vector] = ()) -> Drawn:
        moved = place + turned(turn, shift)
        return Drawn(frame, frame, kind, moved.tolist(), turn, scale, color, points)

    match shape["kind"]:
        case "box":
            yield one(CUBE, (2 * a, 2 * b, 2 * c))
        case "sphere":
            yield one(SPHERE, (2 * a, 2 * a, 2 * a))
        case "ellipsoid":
            yield one(SPHERE, (2 * a, 2 * b, 2 * c))
        case "cylinder":
            yield one(CYLINDER, (2 * a, 2 * a, 2 * b))
        case "capsule":
            yield one(CYLINDER, (2 * a, 2 * a, 2 * b))
            yield one(SPHERE, (2 * a, 2 * a, 2 * a), (0.0, 0.0, b))
            yield one(SPHERE, (2 * a, 2 * a, 2 * a), (0.0, 0.0, -b))
        case "plane":
            yield one(CUBE, (2 * a or GROUND, 2 * b or GROUND, THIN), (0.0, 0.0, -THIN / 2))
        case _:
            corners = _corners(meshes[cast("int", shape["mesh"])])
            yield one(TRIANGLES, (1.0, 1.0, 1.0), points=corners)


def turned(turn: Vector, vector: Vector) -> Any:
    """Return a vector (3,) turned by a unit quaternion (w, x, y, z)."""
    w, axis = turn[0], np.array(turn[1:])
    return np.array(vector) + 2 * np.cross(axis, np.cross(axis, vector) + w * np.array(vector))


def _corners(mesh: Mesh) -> Sequence[Vector]:
    """Return the corners of a mesh's triangles, three for each."""
    vertices = np.frombuffer(base64.b64decode(mesh["vertices"]["data"]), "<f4").reshape(-1, 3)
    faces = np.frombuffer(base64.b64decode(mesh["faces"]["data"]), "<u4")
    return vertices[faces].astype(float).tolist()


def marker_array(drawn: Sequence[Drawn], stamp: Any, store: Any, first: int = 0) -> Any:
    """Return a ``MarkerArray``; the markers are numbered from ``first`` and keep their place in a moving frame."""
    types = store.types
    return types["visualization_msgs/msg/MarkerArray"](
        markers=[_marker(one, number, stamp, types) for number, one in enumerate(drawn, first)]
    )


def _marker(one: Drawn, number: int, stamp: Any, types: Mapping[str, Any]) -> Any:
    point, color = types["geometry_msgs/msg/Point"], types["std_msgs/msg/ColorRGBA"]
    w, x, y, z = one.orientation
    header = types["std_msgs/msg/Header"](stamp=stamp, frame_id=one.frame)
    nothing = np.empty(0, np.uint8)
    return types["visualization_msgs/msg/Marker"](
        header=header,
        ns=one.group,
        id=number,
        type=one.type,
        action=0,
        pose=types["geometry_msgs/msg/Pose"](
            position=point(*map(float, one.position)),
            orientation=types["geometry_msgs/msg/Quaternion"](float(x), float(y), float(z), float(w)),
        ),
        scale=types["geometry_msgs/msg/Vector3"](*map(float, one.scale)),
        color=color(*map(float, one.color)),
        lifetime=types["builtin_interfaces/msg/Duration"](sec=one.seconds, nanosec=0),
        frame_locked=True,
        points=[point(*corner) for corner in one.points],
        colors=[],
        texture_resource="",
        texture=types["sensor_msgs/msg/CompressedImage"](header=header, format="", data=nothing),
        uv_coordinates=[],
        text=one.text,
        mesh_resource="",
        mesh_file=types["visualization_msgs/msg/MeshFile"](filename="", data=nothing),
        mesh_use_embedded_materials=False,
    )
