"""Decode many messages of transforms at once: most messages of a topic differ only in their numbers.

A message is in CDR, the encoding of ROS 2, little-endian. Its transforms begin with the stamp (s and ns, 4 bytes each)
and the names of the two frames; seven numbers of 8 bytes follow, aligned to 8 bytes.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.logs.log_collector import LogCollector
    from robbdd_tools.logs.stored_rows import Nanoseconds

KIND = "tf2_msgs/msg/TFMessage"
PARTS = (
    KIND,
    "geometry_msgs/msg/TransformStamped",
    "geometry_msgs/msg/Transform",
    "geometry_msgs/msg/Vector3",
    "geometry_msgs/msg/Quaternion",
    "std_msgs/msg/Header",
    "builtin_interfaces/msg/Time",
)
PLAIN_CDR = b"\x00\x01"
"""Begin of a little-endian message in plain CDR."""
HEAD = 4
"""Bytes before the content; alignment counts from its begin."""
SECOND = 1_000_000_000
MOST = 2048
"""This many messages are decoded at once."""
PLACES = 32
"""Bits of the place of a transform in its message."""
ORDER = [0, 1, 2, 6, 3, 4, 5]
"""Columns of a pose (position; w, x, y, z) in the numbers of a message (position; x, y, z, w)."""


class Place(NamedTuple):
    """A transform in a message: its frames without leading slashes, and where its stamp and numbers begin."""

    frame: str
    parent: str
    stamp: int
    numbers: int


class Layout(NamedTuple):
    """The transforms of messages of one length, and which of their bytes are the same in all of them."""

    places: tuple[Place, ...]
    same: npt.NDArray[np.bool_]


class TransformBatches:
    """Collects messages with moving transforms, and decodes those of a topic together.

    The result is that of decoding them one by one. Messages that cannot be decoded here are left to the caller.
    """

    def __init__(self, found: LogCollector) -> None:
        self._found = found
        self._topics: dict[str, list[tuple[int, bytes]]] = {}

    def add(self, topic: str, received: int, raw: bytes) -> bool:
        """Add a message; return false if its encoding is another one."""
        if raw[:2] != PLAIN_CDR:
            return False
        messages = self._topics.setdefault(topic, [])
        messages.append((received, raw))
        if len(messages) >= MOST:
            self._decode(topic)
        return True

    def finish(self) -> None:
        """Decode the messages that are left. Raises ``ValueError`` for a damaged message, as ``add`` does."""
        for topic in self._topics:
            self._decode(topic)

    def _decode(self, topic: str) -> None:
        messages, self._topics[topic] = self._topics[topic], []
        frames: dict[str, list[_Part]] = {}
        try:
            for rows, data in _by_length([raw for _, raw in messages]):
                for layout, chosen in _alike(data):
                    for place, stamps, poses in _transforms(layout, data[chosen]):
                        order = (rows[chosen] << PLACES) + place.stamp
                        frames.setdefault(place.frame, []).append(_Part(place.parent, order, stamps, poses))
        except ValueError as error:
            raise ValueError(f"'{topic}' ({KIND}): {error}") from None
        received = np.array([time for time, _ in messages], dtype=np.int64)
        runs = [(frame, run) for frame, parts in frames.items() for run in _runs(parts)]
        for frame, run in sorted(runs, key=lambda entry: int(entry[1].order[0])):
            times = run.stamps, received[run.order >> PLACES]
            self._found.transforms(topic, frame, run.parents, times, run.poses)


class _Part(NamedTuple):
    """Transforms of a frame in one parent. ``order`` (n,) are their places in the messages, which order them."""

    parent: str
    order: Nanoseconds
    stamps: Nanoseconds
    poses: FloatArray


class _Run(NamedTuple):
    """The transforms of a frame in the order of the messages, either with or without stamps."""

    order: Nanoseconds
    stamps: Nanoseconds
    poses: FloatArray
    parents: list[tuple[str, npt.NDArray[np.bool_]]]
    """Each parent in the order of its first occurrence, and its rows."""


def _runs(parts: Sequence[_Part]) -> Iterator[_Run]:
    names = list(dict.fromkeys(part.parent for part in parts))
    order = np.concatenate([part.order for part in parts])
    sorting = np.argsort(order)
    stamps = np.concatenate([part.stamps for part in parts])[sorting]
    poses = np.concatenate([part.poses for part in parts])[sorting]
    parent = np.concatenate([np.full(len(part.order), names.index(part.parent)) for part in parts])[sorting]
    for chosen in (stamps != 0, stamps == 0):
        if chosen.any():
            known = parent[chosen]
            numbers: list[int] = known.tolist()
            found = [(names[number], known == number) for number in dict.fromkeys(numbers)]
            yield _Run(order[sorting][chosen], stamps[chosen], poses[chosen], found)


def _by_length(messages: Sequence[bytes]) -> Iterator[tuple[Nanoseconds, npt.NDArray[np.uint8]]]:
    """Yield the numbers (n,) of messages of one length, and their bytes (n, length)."""
    lengths: dict[int, list[int]] = {}
    for number, raw in enumerate(messages):
        lengths.setdefault(len(raw), []).append(number)
    for length, numbers in lengths.items():
        data = np.frombuffer(b"".join(messages[number] for number in numbers), np.uint8)
        yield np.array(numbers, dtype=np.int64), data.reshape(-1, length)


def is_usual(definitions: Mapping[str, Any], usual: Mapping[str, Any]) -> bool:
    """Return whether a bag defines messages of transforms as ROS 2 does."""
    return all(definitions.get(kind) == usual[kind] for kind in PARTS)


def _alike(data: npt.NDArray[np.uint8]) -> Iterator[tuple[Layout, npt.NDArray[np.intp]]]:
    """Yield the rows (n, bytes) of messages that have the layout of the first of them, until all are yielded."""
    left = np.arange(len(data))
    while len(left):
        layout = _layout(data[left[0]].tobytes())
        equal = (data[left][:, layout.same] == data[left[0]][layout.same]).all(axis=1)
        yield layout, left[equal]
        left = left[~equal]


def _layout(raw: bytes) -> Layout:
    same = np.ones(len(raw), bool)
    same[:HEAD] = False
    places: list[Place] = []
    try:
        (count,) = struct.unpack_from("<I", raw, HEAD)
        end = HEAD + 4
        for _ in range(count):
            stamp = _aligned(end, 4)
            parent, end = _text(raw, stamp + 8)
            frame, end = _text(raw, _aligned(end, 4))
            numbers = _aligned(end, 8)
            # The bytes between two values have no meaning.
            same[stamp : stamp + 8] = same[end : numbers + 56] = False
            end = numbers + 56
            places.append(Place(frame.lstrip("/"), parent.lstrip("/"), stamp, numbers))
    except struct.error as error:
        raise ValueError(f"a message is cut off: {error}") from None
    if end > len(raw):
        raise ValueError(f"a message of {len(raw)} bytes should have {end}")
    same[end:] = False
    return Layout(tuple(places), same)


def _text(raw: bytes, begin: int) -> tuple[str, int]:
    """Return the text that begins with its length, and where it ends; its last byte is zero."""
    (length,) = struct.unpack_from("<I", raw, begin)
    end = begin + 4 + length
    if not length or end > len(raw):
        raise ValueError("a text is cut off")
    return raw[begin + 4 : end - 1].decode(), end


def _aligned(place: int, size: int) -> int:
    return place + (HEAD - place) % size


def _transforms(layout: Layout, data: npt.NDArray[np.uint8]) -> Iterator[tuple[Place, Nanoseconds, FloatArray]]:
    for place in layout.places:
        stamp = np.ascontiguousarray(data[:, place.stamp : place.stamp + 8])
        seconds, rest = stamp[:, :4].copy().view("<i4"), stamp[:, 4:].copy().view("<u4")
        stamps = seconds[:, 0].astype(np.int64) * SECOND + rest[:, 0]
        numbers = np.ascontiguousarray(data[:, place.numbers : place.numbers + 56]).view("<f8")
        yield place, stamps, numbers[:, ORDER]
