"""Read MCAP files with JSON messages of Foxglove's types."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mcap.reader import make_reader

from robbdd_tools.base.files import open_regular
from robbdd_tools.logs.event_watch import EventWatch
from robbdd_tools.logs.log_collector import LogCollector
from robbdd_tools.logs.log_contents import UnreadableLog

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator

    from robbdd_tools.logs.log_contents import LogContents
    from robbdd_tools.protocol.event_signals import EventSignal

TRANSFORMS, TRANSFORM, POSE = "foxglove.FrameTransforms", "foxglove.FrameTransform", "foxglove.PoseInFrame"
LOG = "foxglove.Log"
JOINTS = "foxglove.JointStates"
ROS_JOINTS = ("sensor_msgs/JointState", "sensor_msgs/msg/JointState")
"""ROS's type of joint states, which bridges also write as JSON messages."""
ROS_PROFILE = "ros2"
OWN_TRACE = "robbdd-trace-1"
"""Encoding of the exact trace, which files of simulated runs contain."""


def encodings(path: Path) -> set[str]:
    """Return the encodings of the messages of an MCAP file. Raises ``UnreadableLog``."""
    try:
        with open_regular(path) as file:
            summary = make_reader(file).get_summary()
    except Exception as error:  # On damaged bytes the decoder raises exceptions of several types.
        raise UnreadableLog(f"{path} cannot be read as MCAP: {error or type(error).__name__}") from error
    found = set[str]() if summary is None else {one.message_encoding for one in summary.channels.values()}
    if OWN_TRACE in found:
        raise UnreadableLog(f"{path} is the trace of a simulated execution: judge its run, by its number")
    return found


def is_uniform(path: Path) -> bool:
    """Return whether all messages of an MCAP file are in JSON, or the file has the ROS 2 profile.

    Raises ``UnreadableLog``.
    """
    found = encodings(path)
    with open_regular(path) as file:
        return found == {"json"} or ("json" not in found and make_reader(file).get_header().profile == ROS_PROFILE)


def read_foxglove(path: Path, signals: Iterable[EventSignal] = ()) -> LogContents:
    """Return the contents of an MCAP file with JSON messages: transforms, poses and texts.

    ``signals`` define which messages, of any type, report events. An event has the time of reception. Raises
    ``UnreadableLog``.
    """
    found, watch = LogCollector(), EventWatch(signals)
    try:
        for topic, kind, received, message in _messages(path, watch.topics):
            if kind in READ:
                take_json(found, topic, kind, received, message)
            for event in watch.events(topic, message) if topic in watch.topics else ():
                found.text(topic, received, event)
        watch.check(_topics(path) if watch.topics else ())
    except UnreadableLog as error:
        raise UnreadableLog(f"{path}: {error}") from None
    except Exception as error:  # On damaged bytes the decoder raises exceptions of several types.
        raise UnreadableLog(f"{path} cannot be read as MCAP: {error or type(error).__name__}") from error
    contents = found.finish()
    return replace(contents, remarks=(*watch.remarks, *contents.remarks))


def take_json(found: LogCollector, topic: str, kind: str, received: int, message: Any) -> None:
    """Take a message of one of the types ``READ``."""
    match kind:
        case "foxglove.FrameTransforms":
            for one in message["transforms"]:
                _add_transform(found, topic, received, one)
        case "foxglove.FrameTransform":
            _add_transform(found, topic, received, message)
        case "foxglove.PoseInFrame":
            pose, time = message["pose"], (_stamp(message["timestamp"]), received)
            place, turn = _vector(pose["position"]), _turn(pose["orientation"])
            found.pose(topic, topic, message["frame_id"], time, (place, turn))
        case "foxglove.Log":
            found.text(topic, received, str(message["message"]))
        case "foxglove.JointStates":
            known = [one for one in message["joints"] if one.get("position") is not None]
            _add_joints(found, topic, (_stamp(message["timestamp"]), received), known)
        case _:
            positions, efforts = message["position"], message.get("effort") or ()
            found.joints(topic, (_header_stamp(message), received), message["name"], positions, efforts)


def _messages(path: Path, watched: Collection[str]) -> Iterator[tuple[str, str, int, Any]]:
    with open_regular(path) as file:
        for schema, channel, message in make_reader(file, validate_crcs=True).iter_messages():
            kind = "" if schema is None else schema.name
            if channel.message_encoding == "json" and (kind in READ or channel.topic in watched):
                yield channel.topic, kind, message.log_time, json.loads(message.data)


def _topics(path: Path) -> set[str]:
    with open_regular(path) as file:
        summary = make_reader(file).get_summary()
        return set() if summary is None else {one.topic for one in summary.channels.values()}


READ = {TRANSFORMS, TRANSFORM, POSE, LOG, JOINTS, *ROS_JOINTS}


def _add_transform(found: LogCollector, topic: str, received: int, one: Any) -> None:
    pose, time = (_vector(one["translation"]), _turn(one["rotation"])), (_stamp(one["timestamp"]), received)
    found.transform(topic, one["child_frame_id"], one["parent_frame_id"], time, pose)


def _add_joints(found: LogCollector, topic: str, time: tuple[int, int], states: list[Any]) -> None:
    names, positions = [str(one["name"]) for one in states], [float(one["position"]) for one in states]
    found.joints(topic, time, names, positions, [float(one.get("effort", math.nan)) for one in states])


def _header_stamp(message: Any) -> int:
    """Return the stamp (ns) of a ROS message's header, whose names differ between ROS 1 and ROS 2."""
    stamp = message["header"]["stamp"]
    rest = next((stamp[name] for name in ("nanosec", "nsec", "nsecs") if name in stamp), 0)
    return int(stamp.get("sec", stamp.get("secs", 0))) * 1_000_000_000 + int(rest)


def _vector(value: Any) -> tuple[float, float, float]:
    return float(value["x"]), float(value["y"]), float(value["z"])


def _turn(value: Any) -> tuple[float, float, float, float]:
    return float(value["w"]), float(value["x"]), float(value["y"]), float(value["z"])


def _stamp(value: Any) -> int:
    return int(value["sec"]) * 1_000_000_000 + int(value["nsec"])
