"""List the topics of a log, with the types of their messages and the fields of these types."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from robbdd_tools.base.files import open_regular
from robbdd_tools.logs.growing_mcap import is_cut
from robbdd_tools.logs.log_contents import UnreadableLog
from robbdd_tools.logs.log_summary import Topic
from robbdd_tools.logs.mcap_records import McapRecords
from robbdd_tools.logs.ros_bag import NO_ROSBAGS
from robbdd_tools.logs.ros_definitions import known_types

if TYPE_CHECKING:
    from mcap.records import Schema

MAX_DEPTH = 4
"""Fields that are nested more deeply than this are not listed."""
MAX_FIELDS = 200
Definitions = Mapping[str, Any]
"""Type of a message → its constants and its fields, as rosbags describes them."""


def topics_of(path: Path) -> dict[str, Topic]:
    """Return the topics of a log by name; none for a table. Raises ``UnreadableLog`` and ``OSError``."""
    if path.suffix.lower() == ".csv":
        return {}
    try:
        if path.suffix.lower() == ".mcap":
            return dict(sorted(_mcap_topics(path)))
        return dict(sorted(_bag_topics(path)))
    except ImportError:
        raise UnreadableLog(NO_ROSBAGS) from None
    except OSError:
        raise
    except Exception as error:  # On damaged bytes each reader raises exceptions of its own types.
        raise UnreadableLog(f"the topics of {path} cannot be read: {error or type(error).__name__}") from error


def _bag_topics(path: Path) -> Iterator[tuple[str, Topic]]:
    from rosbags.highlevel import AnyReader

    with AnyReader([path], default_typestore=known_types()) as reader:
        defined = reader.typestore.fielddefs
        for name, topic in reader.topics.items():
            kind = topic.msgtype or ""
            yield name, Topic(kind, topic.msgcount, tuple(_ros_fields(kind, defined))[:MAX_FIELDS])


def _mcap_topics(path: Path) -> Iterator[tuple[str, Topic]]:
    from mcap.reader import make_reader

    found: dict[str, Topic] = {}
    if is_cut(path):
        for one in McapRecords(path).new_messages():
            known = found.get(one.channel.topic) or _topic(one.schema, 0)
            found[one.channel.topic] = Topic(known.type, known.count + 1, known.fields)
        yield from found.items()
        return
    with open_regular(path) as file:
        summary = make_reader(file).get_summary()
    for channel in summary.channels.values() if summary is not None else ():
        counts = {} if summary is None or summary.statistics is None else summary.statistics.channel_message_counts
        schema = None if summary is None else summary.schemas.get(channel.schema_id)
        yield channel.topic, _topic(schema, counts.get(channel.id, 0))


def _topic(schema: Schema | None, count: int) -> Topic:
    if schema is None:
        return Topic("", count)
    if schema.encoding == "ros2msg":
        from rosbags.typesys import get_types_from_msg

        kind = schema.name
        fields = _ros_fields(kind, get_types_from_msg(schema.data.decode(), kind))
    elif schema.encoding == "jsonschema":
        fields = _json_fields(json.loads(schema.data or b"{}"))
    else:
        fields = iter(())
    return Topic(schema.name, count, tuple(fields)[:MAX_FIELDS])


def _ros_fields(kind: str, defined: Definitions, depth: int = 0) -> Iterator[tuple[str, str]]:
    """Yield the paths and types of a type's fields. An element of an array is ``name[0]``."""
    from rosbags.interfaces import Nodetype

    if kind not in defined or depth > MAX_DEPTH:
        return
    for name, (node, described) in defined[kind][1]:
        path, element = (f"{name}[0]", described[0]) if node in (Nodetype.ARRAY, Nodetype.SEQUENCE) else (name, None)
        inner, of = (node, described) if element is None else element
        if inner == Nodetype.NAME:
            yield from ((f"{path}.{rest}", leaf) for rest, leaf in _ros_fields(of, defined, depth + 1))
        else:
            yield path, str(of[0])


def _json_fields(schema: dict[str, Any], depth: int = 0) -> Iterator[tuple[str, str]]:
    """Yield the paths and types of the properties of a JSON schema."""
    properties = cast("dict[str, dict[str, Any]]", schema.get("properties", {}))
    for name, described in properties.items() if depth <= MAX_DEPTH else ():
        kind = str(described.get("type", ""))
        path, inner = (f"{name}[0]", described.get("items", {})) if kind == "array" else (name, described)
        nested = list(_json_fields(inner, depth + 1))
        if nested:
            yield from ((f"{path}.{rest}", leaf) for rest, leaf in nested)
        else:
            yield path, str(inner.get("type", ""))
