"""Traces in MCAP, the robotics log format: the exact trace, and topics for viewers and plotters.

Topics: ``/trace`` (the bytes of ``codec`` in one message, or in several of a long trace), ``/tf``
(foxglove.FrameTransforms), ``/scene`` (foxglove.SceneUpdate), ``/geometry`` (the same with meshes, for our own views),
``/joints``, ``/events`` and ``/verdicts`` (JSON with the schemas below). Times are simulated; nothing depends on the
wall clock, so equal executions give equal files.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import Any

from mcap.reader import make_reader
from mcap.writer import Writer

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import open_regular
from robbdd_tools.base.writing import replacing_bytes
from robbdd_tools.traces.codec import Evidence, pack_parts, unpack

TRACE, ENCODING = "/trace", "robbdd-trace-1"
LIBRARY = "robbdd"
MESSAGE = 1 << 24
"""A message with a part of a trace has at least this many bytes, but for the last one."""
NUMBER, TEXT = {"type": "number"}, {"type": "string"}


def _object(**properties: Any) -> dict[str, Any]:
    return {"type": "object", "properties": properties}


def _list(items: Any) -> dict[str, Any]:
    return {"type": "array", "items": items}


_TIME = _object(sec={"type": "integer"}, nsec={"type": "integer"})
_VECTOR, _TURN = _object(x=NUMBER, y=NUMBER, z=NUMBER), _object(x=NUMBER, y=NUMBER, z=NUMBER, w=NUMBER)
_SOLID = _object(
    pose=_object(position=_VECTOR, orientation=_TURN),
    size=_VECTOR,
    color=_object(r=NUMBER, g=NUMBER, b=NUMBER, a=NUMBER),
)
_FRAME = _object(timestamp=_TIME, parent_frame_id=TEXT, child_frame_id=TEXT, translation=_VECTOR, rotation=_TURN)
_ENTITY = _object(
    timestamp=_TIME,
    frame_id=TEXT,
    id=TEXT,
    lifetime=_TIME,
    frame_locked={"type": "boolean"},
    cubes=_list(_SOLID),
    spheres=_list(_SOLID),
    cylinders=_list(_SOLID),
)
_LISTED = _list(_object())
SCHEMAS: Mapping[str, tuple[str, dict[str, Any]]] = {
    "/tf": ("foxglove.FrameTransforms", _object(transforms=_list(_FRAME))),
    "/scene": ("foxglove.SceneUpdate", _object(entities=_list(_ENTITY))),
    "/geometry": (
        "robbdd.Geometry",
        _object(shapes=_list(_object()), meshes=_list(_object()), workspaces=_list(_object())),
    ),
    "/joints": ("robbdd.JointStates", {"type": "object", "additionalProperties": _object(), "description": "rad or m"}),
    "/events": ("robbdd.Event", _object(name=TEXT, time=NUMBER)),
    "/verdicts": (
        "robbdd.Verdict",
        _object(iri=TEXT, name=TEXT, role=TEXT, sentence=TEXT, verdict=TEXT, robustness=NUMBER, unit=TEXT, reason=TEXT),
    ),
}
"""Topic → name and JSON schema of the type of its messages."""

View = tuple[float, str, Any]
"""A message for viewers: simulated time (s), topic, message."""


class UnreadableTrace(RobbddError):
    """A file is not a trace of this tool; the message gives the reason."""


def write_trace(path: Path, evidence: Evidence, views: Iterable[View]) -> None:
    """Write a trace and its messages for viewers; raises ``OSError``, and ``TypeError`` as ``pack_parts``."""
    parts = _joined(pack_parts(evidence))
    first = next(parts)
    path.parent.mkdir(exist_ok=True)
    with replacing_bytes(path) as file:
        writer = Writer(file)
        writer.start(library=LIBRARY)
        channel = writer.register_channel(TRACE, ENCODING, writer.register_schema("robbdd.Trace", "", b""))
        for data in chain([first], parts):
            writer.add_message(channel, 0, data, 0)
        channels: dict[str, int] = {}
        for time, topic, message in views:
            if topic not in channels:
                name, schema = SCHEMAS[topic]
                number = writer.register_schema(name, "jsonschema", json.dumps(schema).encode())
                channels[topic] = writer.register_channel(topic, "json", number)
            stamp = round(time * 1e9)
            writer.add_message(channels[topic], stamp, json.dumps(message, ensure_ascii=False).encode(), stamp)
        writer.finish()


def read_trace(path: Path) -> Evidence:
    """Restore a trace; raises ``UnreadableTrace``."""
    try:
        with open_regular(path) as file:
            found = make_reader(file, validate_crcs=True).iter_messages(topics=[TRACE], log_time_order=False)
            if parts := [message.data for _, _, message in found]:
                return unpack(parts[0] if len(parts) == 1 else b"".join(parts))
    except Exception as error:  # Each decoder raises exceptions of its own types for damaged bytes.
        raise UnreadableTrace(f"{path} {_wrong_with_it(error)}") from error
    raise UnreadableTrace(f"{path} holds no trace")


def read_views(path: Path, topics: Sequence[str]) -> Mapping[str, list[tuple[float, Any]]]:
    """Return time (s) and message of the viewers' messages, by topic; raises ``UnreadableTrace``."""
    found: dict[str, list[tuple[float, Any]]] = {topic: [] for topic in topics}
    try:
        with open_regular(path) as file:
            for _, channel, message in make_reader(file, validate_crcs=True).iter_messages(topics=list(topics)):
                found[channel.topic].append((message.log_time / 1e9, json.loads(message.data)))
    except Exception as error:  # Each decoder raises exceptions of its own types for damaged bytes.
        raise UnreadableTrace(f"{path} {_wrong_with_it(error)}") from error
    return found


def _joined(parts: Iterable[bytes]) -> Iterator[bytes]:
    """Join parts of a trace to messages. A trace of an hour has too many bytes for one message."""
    found = bytearray()
    for part in parts:
        found += part
        if len(found) >= MESSAGE:
            yield bytes(found)
            found.clear()
    if found:
        yield bytes(found)


def _wrong_with_it(error: Exception) -> str:
    if isinstance(error, FileNotFoundError):
        return "is gone"
    if isinstance(error, OSError):
        return f"cannot be read: {error.strerror or error}"
    return "is damaged, or was written by another version: run the scenario again"
