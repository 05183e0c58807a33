"""Read MCAP files with JSON messages of Foxglove's types."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mcap.reader import make_reader

from robbdd_tools.base.files import open_regular
from robbdd_tools.logs.log_contents import LogContents, TextStamp, TrackBuilder, UnreadableLog

if TYPE_CHECKING:
    from collections.abc import Iterator

TRANSFORMS, TRANSFORM, POSE = "foxglove.FrameTransforms", "foxglove.FrameTransform", "foxglove.PoseInFrame"
LOG = "foxglove.Log"
OWN_TRACE = "robbdd-trace-1"
"""Encoding of the exact trace in the traces of simulated runs."""


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


def read_foxglove(path: Path) -> LogContents:
    """Return the contents of an MCAP file with JSON messages: transforms, poses and texts. Raises ``UnreadableLog``."""
    builder, texts = TrackBuilder(), list[tuple[int, str, str]]()
    try:
        for topic, kind, time, message in _messages(path):
            match kind:
                case "foxglove.FrameTransforms":
                    for one in message["transforms"]:
                        _add_transform(builder, one)
                case "foxglove.FrameTransform":
                    _add_transform(builder, message)
                case "foxglove.PoseInFrame":
                    pose = message["pose"]
                    place, turn = _vector(pose["position"]), _turn(pose["orientation"])
                    builder.add(topic.lstrip("/"), message["frame_id"], _stamp(message["timestamp"]), place, turn)
                case "foxglove.Log":
                    texts.append((time, topic, str(message["message"])))
                case _:
                    pass
    except UnreadableLog as error:
        raise UnreadableLog(f"{path}: {error}") from None
    except Exception as error:  # On damaged bytes the decoder raises exceptions of several types.
        raise UnreadableLog(f"{path} cannot be read as MCAP: {error or type(error).__name__}") from error
    return contents_of(builder, texts)


def contents_of(builder: TrackBuilder, texts: list[tuple[int, str, str]]) -> LogContents:
    """Return the contents of a log with a single clock. ``texts`` are times (ns), topics and texts."""
    stamps = [*builder.bounds(), *(time for time, _, _ in texts)]
    begin, end = min(stamps, default=0), max(stamps, default=0)
    found = tuple(TextStamp(topic, text, (time - begin) / 1e9) for time, topic, text in sorted(texts))
    return LogContents(builder.tracks(begin), found, (end - begin) / 1e9)


def _messages(path: Path) -> Iterator[tuple[str, str, int, Any]]:
    with open_regular(path) as file:
        for schema, channel, message in make_reader(file, validate_crcs=True).iter_messages():
            if schema is not None and channel.message_encoding == "json" and schema.name in READ:
                yield channel.topic, schema.name, message.log_time, json.loads(message.data)


READ = {TRANSFORMS, TRANSFORM, POSE, LOG}


def _add_transform(builder: TrackBuilder, one: Any) -> None:
    place, turn = _vector(one["translation"]), _turn(one["rotation"])
    builder.add(one["child_frame_id"], one["parent_frame_id"], _stamp(one["timestamp"]), place, turn)


def _vector(value: Any) -> tuple[float, float, float]:
    return float(value["x"]), float(value["y"]), float(value["z"])


def _turn(value: Any) -> tuple[float, float, float, float]:
    return float(value["w"]), float(value["x"]), float(value["y"]), float(value["z"])


def _stamp(value: Any) -> int:
    return int(value["sec"]) * 1_000_000_000 + int(value["nsec"])
