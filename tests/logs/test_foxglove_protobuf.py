"""Foxglove's messages in Protobuf say the same as in JSON."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from google.protobuf.descriptor_pb2 import FieldDescriptorProto, FileDescriptorProto, FileDescriptorSet
from google.protobuf.descriptor_pool import DescriptorPool
from google.protobuf.json_format import ParseDict
from google.protobuf.message_factory import GetMessageClass
from mcap.writer import Writer

from robbdd_tools.logs.log_contents import LogContents, UnreadableLog
from robbdd_tools.logs.open_log import read_log

STAMP = ".google.protobuf.Timestamp"
FIELDS = {
    "Vector3": {"x": "double", "y": "double", "z": "double"},
    "Quaternion": {"x": "double", "y": "double", "z": "double", "w": "double"},
    "Pose": {"position": ".foxglove.Vector3", "orientation": ".foxglove.Quaternion"},
    "PoseInFrame": {"timestamp": STAMP, "frame_id": "string", "pose": ".foxglove.Pose"},
    "PosesInFrame": {"timestamp": STAMP, "frame_id": "string", "poses*": ".foxglove.Pose"},
    "FrameTransform": {
        "timestamp": STAMP,
        "parent_frame_id": "string",
        "child_frame_id": "string",
        "translation": ".foxglove.Vector3",
        "rotation": ".foxglove.Quaternion",
    },
    "FrameTransforms": {"transforms*": ".foxglove.FrameTransform"},
    "CubePrimitive": {"pose": ".foxglove.Pose", "size": ".foxglove.Vector3"},
    "SceneEntity": {
        "timestamp": STAMP,
        "frame_id": "string",
        "id": "string",
        "cubes*": ".foxglove.CubePrimitive",
    },
    "SceneUpdate": {"entities*": ".foxglove.SceneEntity"},
    "Log": {"timestamp": STAMP, "message": "string"},
    "JointState": {"name": "string", "position": "double", "effort": "double"},
    "JointStates": {"timestamp": STAMP, "joints*": ".foxglove.JointState"},
}
"""The fields that Foxglove's published schemas define, as far as they are used; ``*`` marks lists."""
TYPES = {"double": FieldDescriptorProto.TYPE_DOUBLE, "string": FieldDescriptorProto.TYPE_STRING}


def definitions() -> FileDescriptorSet:
    from google.protobuf.timestamp_pb2 import DESCRIPTOR

    stamps = FileDescriptorProto()
    DESCRIPTOR.CopyToProto(stamps)
    file = FileDescriptorProto(name="all.proto", package="foxglove", syntax="proto3", dependency=[stamps.name])
    for name, fields in FIELDS.items():
        kind = file.message_type.add(name=name)
        for number, (field, type_name) in enumerate(fields.items(), 1):
            one = kind.field.add(name=field.strip("*"), number=number)
            one.label = FieldDescriptorProto.LABEL_REPEATED if "*" in field else FieldDescriptorProto.LABEL_OPTIONAL
            if type_name in TYPES:
                one.type = TYPES[type_name]
            else:
                one.type, one.type_name = FieldDescriptorProto.TYPE_MESSAGE, type_name
    # The importing file comes first: writers need not order them.
    return FileDescriptorSet(file=[file, stamps])


POSE = {"position": {"x": 1.0, "y": 0.0, "z": 0.5}, "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}
MESSAGES: list[tuple[str, str, dict[str, Any]]] = [
    ("/cup", "PoseInFrame", {"frame_id": "map", "pose": POSE}),
    ("/blocks", "PosesInFrame", {"frame_id": "map", "poses": [POSE, POSE]}),
    (
        "/tf",
        "FrameTransforms",
        {
            "transforms": [
                {
                    "parent_frame_id": "map",
                    "child_frame_id": "tool",
                    "translation": POSE["position"],
                    "rotation": POSE["orientation"],
                }
            ]
        },
    ),
    (
        "/scene",
        "SceneUpdate",
        {
            "entities": [
                {"frame_id": "map", "id": "box", "cubes": [{"pose": POSE}]},
                {"frame_id": "map", "id": "pile", "cubes": [{"pose": POSE}, {"pose": POSE}]},
            ]
        },
    ),
    ("/log", "Log", {"message": "pick-end"}),
    ("/joints", "JointStates", {"joints": [{"name": "elbow", "position": 0.0, "effort": 2.0}]}),
]


def stamped(message: dict[str, Any], stamp: Any) -> dict[str, Any]:
    """Put a stamp into a message: into its transforms or entities, if it has some."""
    for name in ("transforms", "entities"):
        if name in message:
            return {name: [{**one, "timestamp": stamp} for one in message[name]]}
    return {**message, "timestamp": stamp}


def log(path: Path, encoding: str) -> Path:
    schemas = definitions()
    pool = DescriptorPool()
    for file in reversed(schemas.file):
        pool.Add(file)
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        for topic, name, message in MESSAGES:
            is_json = encoding == "json"
            schema = b"{}" if is_json else schemas.SerializeToString()
            kind = writer.register_schema(f"foxglove.{name}", "jsonschema" if is_json else "protobuf", schema)
            channel = writer.register_channel(topic, encoding, kind)
            for second in (100, 101):
                if is_json:
                    data = json.dumps(stamped(message, {"sec": second, "nsec": 0})).encode()
                else:
                    made = GetMessageClass(pool.FindMessageTypeByName(f"foxglove.{name}"))()
                    stamp = f"1970-01-01T00:01:{second - 60}Z"
                    data = ParseDict(stamped(message, stamp), made).SerializeToString()
                writer.add_message(channel, second * 10**9, data, second * 10**9)
        writer.finish()
    return path


def summary(found: LogContents) -> dict[str, Any]:
    return {
        **{name: (one.parent, one.times.tolist(), one.positions.tolist()) for name, one in found.tracks.items()},
        "texts": found.texts,
        "joints": {name: one.positions.tolist() for name, one in found.joints["/joints"].items()},
        "remarks": found.remarks,
    }


@pytest.mark.parametrize("encoding", ["json", "protobuf"])
def test_foxglove_messages_are_read(encoding: str, tmp_path: Path) -> None:
    found = read_log(log(tmp_path / "drive.mcap", encoding))
    assert set(found.tracks) == {"/cup".strip("/"), "blocks/0", "blocks/1", "tool", "scene/box"}
    for track in found.tracks.values():
        assert (track.parent, track.times.tolist()) == ("map", [0.0, 1.0])
        assert track.positions.tolist() == [[1.0, 0.0, 0.5]] * 2
        assert np.array_equal(track.orientations, [[1.0, 0.0, 0.0, 0.0]] * 2)
    assert [one.text for one in found.texts] == ["pick-end"] * 2
    assert found.joints["/joints"]["elbow"].efforts.tolist() == [2.0, 2.0]
    assert "entities on '/scene' without exactly one solid have no place: 'pile'" in found.remarks


def test_protobuf_says_the_same_as_json(tmp_path: Path) -> None:
    one, other = (read_log(log(tmp_path / f"{name}.mcap", name)) for name in ("json", "protobuf"))
    assert summary(one) == summary(other)


def test_the_clock_of_a_topic_is_moved(tmp_path: Path) -> None:
    found = read_log(log(tmp_path / "drive.mcap", "protobuf"), clocks={"/cup": 0.25})
    assert (found.tracks["tool"].times - found.tracks["cup"].times).tolist() == [0.25, 0.25]


def test_a_damaged_definition_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "drive.mcap"
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        kind = writer.register_schema("foxglove.Log", "protobuf", b"\xff\xff")
        writer.add_message(writer.register_channel("/log", "protobuf", kind), 0, b"", 0)
        writer.finish()
    with pytest.raises(UnreadableLog, match=r"cannot be read: '/log' \(foxglove\.Log\)"):
        read_log(path)
