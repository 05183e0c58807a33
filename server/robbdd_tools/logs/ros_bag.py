"""Read ROS 1 bags, and rosbag2 folders and files (SQLite or MCAP), without a ROS installation."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.logs.event_watch import EventWatch
from robbdd_tools.logs.frame_sources import STATIC
from robbdd_tools.logs.log_contents import LogContents, UnreadableLog
from robbdd_tools.logs.ros_definitions import known_types
from robbdd_tools.logs.ros_messages import HEADERLESS, READERS, RosContents
from robbdd_tools.logs.transform_batches import KIND, TransformBatches, is_usual

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from robbdd_tools.protocol.event_signals import EventSignal

NO_ROSBAGS = "reading ROS bags needs the extra 'logs': pip install 'robbdd-tools[logs]'"
MAX_LISTED = 8
ZSTD = b"\x28\xb5\x2f\xfd"
"""Begin of compressed data."""


def read_ros_bag(
    path: Path,
    clocks: Mapping[str, float] | None = None,
    signals: Iterable[EventSignal] = (),
    events: Iterable[tuple[int, str, str]] = (),
) -> LogContents:
    """Return the contents of a bag.

    ``events`` are further ones: the time of reception (ns), a topic, and the event. ``signals`` define which messages,
    of any type, report events. An event has the time of reception.

    The time of a pose is the time in its message's header. Without a header, it is the time of reception. If the two
    clocks differ, the time of reception is moved by the median difference, and a remark says so. ``clocks`` maps topics
    to the time (s) by which the clock of their headers is ahead; it is subtracted. Raises ``UnreadableLog``.
    """
    try:
        from rosbags.highlevel import AnyReader

        known = known_types()
    except ImportError:
        raise UnreadableLog(NO_ROSBAGS) from None
    contents, watch = RosContents(clocks or {}), EventWatch(signals)
    topic = ""
    try:
        # Bags of ROS 2 before Iron do not contain the definitions of their types.
        with AnyReader([path], default_typestore=known) as reader:
            defined = reader.typestore.fielddefs
            wanted = [
                one
                for one in reader.connections
                if (one.msgtype in READERS or one.topic in watch.topics) and one.msgtype in defined
            ]
            watch.check({one.topic for one in reader.connections})
            contents.remarks += not_read(
                {one.topic: str(one.msgtype) for one in reader.connections if one not in wanted}, defined
            )
            stamped = {one.topic: str(one.msgtype) for one in wanted if one.msgtype in READERS}
            ahead = dict(stated_clocks(clocks or {}, stamped))
            batches = TransformBatches(contents.found)
            # Transforms are by far the most messages of most logs.
            batched = _batched(wanted, watch.topics, ahead) if is_usual(defined, known.fielddefs) else set[str]()
            for connection, received, raw in reader.messages(connections=wanted) if wanted else ():
                if connection.topic in batched and batches.add(connection.topic, received, raw):
                    continue
                if raw[:4] == ZSTD:
                    words = "its messages are compressed, as its metadata.yaml says: name the folder of the bag"
                    raise UnreadableLog(words)
                topic = f": '{connection.topic}' ({connection.msgtype})"
                message = reader.deserialize(raw, connection.msgtype)
                contents.ahead = ahead.get(connection.topic, 0)
                take_message(contents, watch, (connection.topic, connection.msgtype), received, message)
                topic = ""
            batches.finish()
        for received, source, event in events:
            contents.found.text(source, received, event, declared=True)
        contents.remarks += watch.remarks
        return contents.finish()
    except UnreadableLog as error:
        raise UnreadableLog(f"{path}: {error}") from None
    except Exception as error:  # On damaged bytes each decoder raises exceptions of its own types.
        raise UnreadableLog(f"{path} cannot be read as a ROS bag{topic}: {error or type(error).__name__}") from error


def _batched(connections: Iterable[Any], watched: Collection[str], ahead: Collection[str]) -> set[str]:
    """Return the topics of moving transforms in CDR of which only the transforms are used, by the headers' clock."""
    topics = {one.topic for one in connections if one.msgtype == KIND and one.topic.rpartition("/")[2] != STATIC}
    others = {one.topic for one in connections if one.msgtype != KIND}
    return topics - others - {*watched, *ahead}


def take_message(
    contents: RosContents, watch: EventWatch, channel: tuple[str, str], received: int, message: Any
) -> None:
    """Add a decoded message of a channel (topic and type), and the events that it reports."""
    topic, kind = channel
    if kind in READERS:
        READERS[kind](contents, topic, received, message)
    for event in watch.events(topic, message) if topic in watch.topics else ():
        contents.found.text(topic, received, event, declared=True)


def not_read(topics: Mapping[str, str], defined: Collection[str]) -> list[str]:
    """Return sentences on topics (→ types) that are not read, because the type is not used or has no definition."""
    other = sorted(f"{topic} ({kind})" for topic, kind in topics.items() if kind not in READERS)
    missing = {topic: kind for topic, kind in topics.items() if kind in READERS and kind not in defined}
    listed = ", ".join(other[:MAX_LISTED]) + (f" and {len(other) - MAX_LISTED} more" if len(other) > MAX_LISTED else "")
    return ([f"not read: {listed}"] if other else []) + [
        f"'{topic}' is not read, because the bag does not define {kind}: record with storage 'mcap'"
        for topic, kind in sorted(missing.items())
    ]


def stated_clocks(stated: Mapping[str, float], known: Mapping[str, str]) -> Iterator[tuple[str, int]]:
    """Yield each topic with the time (ns) by which its headers are ahead. Raises ``UnreadableLog``."""
    for topic, seconds in stated.items():
        if topic not in known:
            stamped = ", ".join(sorted(one for one, kind in known.items() if kind not in HEADERLESS)) or "none"
            raise UnreadableLog(f"there is no topic '{topic}' with headers; the log has {stamped}")
        if known[topic] in HEADERLESS:
            kind = known[topic]
            raise UnreadableLog(
                f"'{topic}' ({kind}) has the time of its reception: only the clock of headers can be moved"
            )
        yield topic, round(seconds * 1e9)
