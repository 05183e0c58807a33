"""Logs that are larger than memory: they are decoded, kept and judged in parts, with the result of the whole."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from logs.bags import Message, transform, write
from robbdd_tools.base import large_arrays
from robbdd_tools.logs import stored_rows, transform_batches
from robbdd_tools.logs.header_clocks import HeaderClocks
from robbdd_tools.logs.log_collector import LogCollector
from robbdd_tools.logs.log_contents import LogContents
from robbdd_tools.logs.open_log import read_log
from robbdd_tools.logs.stored_rows import StoredRows


def several(messages: Sequence[Message]) -> Message:
    """Join messages with one transform each to one message."""

    def make(store: object) -> object:
        contents = [one.make(store) for one in messages]
        contents[0].transforms = [transform for one in contents for transform in one.transforms]
        return contents[0]

    return Message(messages[0].topic, messages[0].received, messages[0].kind, make)


@st.composite
def bags(draw: st.DrawFn) -> list[Message]:
    """Draw messages of transforms: of several lengths, unordered, without stamps, with frames twice and lost frames."""
    found: list[Message] = [transform("map_of_the_cell", (0.0, 0.0, 0.0), stamp=5.0)]
    places = st.sampled_from([(0.0, 0.0, 0.0), (1.0, 2.0, 3.0), (float("nan"), 0.0, 0.0)])
    for tick in range(draw(st.integers(1, 40))):
        ones = [
            transform(
                draw(st.sampled_from(["cup", "mug", "lid_of_the_pot", "/cup"])),
                draw(places),
                stamp=draw(st.sampled_from([tick / 10 + 5, tick / 10 + 5, tick / 10 + 4.6, 0.0])),
                received=tick / 10 + 5,
                parent=draw(st.sampled_from(["map"] * 9 + ["cup"])),
                turn=draw(st.sampled_from([(1.0, 0.0, 0.0, 0.0), (0.0, 2.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)])),
            )
            for _ in range(draw(st.integers(1, 3)))
        ]
        found.append(several(ones))
    return found


def same(one: LogContents, other: LogContents) -> bool:
    assert one.remarks == other.remarks, (one.remarks, other.remarks)
    assert (one.end, one.texts) == (other.end, other.texts)
    assert list(one.tracks) == list(other.tracks)
    for frame, track in one.tracks.items():
        expected = other.tracks[frame]
        assert (track.parent, track.static) == (expected.parent, expected.static)
        for found, known in ((track.times, expected.times), (track.positions, expected.positions)):
            assert np.array_equal(found, known, equal_nan=True)
        assert np.array_equal(track.orientations, expected.orientations, equal_nan=True)
    return True


@settings(max_examples=40)
@given(bags(), st.integers(1, 7), st.integers(1, 9))
def test_transforms_decoded_together_are_those_decoded_one_by_one(
    messages: list[Message], together: int, kept: int
) -> None:
    with tempfile.TemporaryDirectory() as folder, pytest.MonkeyPatch.context() as patch:
        bag = write(Path(folder) / "drive", messages)
        patch.setattr(transform_batches, "PLAIN_CDR", b"none")
        expected = read_log(bag)
        patch.undo()
        patch.setattr(transform_batches, "MOST", together)
        patch.setattr(stored_rows, "BLOCK", kept)
        patch.setattr(large_arrays, "IN_MEMORY", 0)
        assert same(read_log(bag), expected)


@given(st.lists(st.tuples(st.integers(0, 10**10), st.integers(0, 10**10)), min_size=1, max_size=60), st.data())
def test_clocks_of_many_messages_are_those_of_each(pairs: list[tuple[int, int]], data: st.DataObject) -> None:
    one, many = HeaderClocks(), HeaderClocks()
    pairs = sorted(pairs, key=lambda pair: pair[0])
    for received, stamp in pairs:
        one.seen("/tf", "cup", received, stamp)
    begin = 0
    while begin < len(pairs):
        end = data.draw(st.integers(begin + 1, len(pairs)))
        received, stamps = np.array(pairs[begin:end], dtype=np.int64).T
        many.seen_many("/tf", "cup", received, stamps)
        begin = end
    assert one == many


def test_a_damaged_message_of_transforms_is_refused_with_its_topic() -> None:
    whole = bytes.fromhex("00010000" + "01000000" + "00" * 8 + "ff000000")
    batches = transform_batches.TransformBatches(LogCollector())
    assert batches.add("/tf", 1, whole)
    with pytest.raises(ValueError, match=r"'/tf' \(tf2_msgs/msg/TFMessage\): a text is cut off"):
        batches.finish()
    batches.add("/tf", 1, whole[:7])
    with pytest.raises(ValueError, match="a message is cut off"):
        batches.finish()
    assert not batches.add("/tf", 1, b"\x00\x00" + whole[2:]), "big-endian messages are decoded by the library"


def test_a_copy_of_rows_shares_what_is_stored_and_grows_on_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    from copy import deepcopy

    monkeypatch.setattr(stored_rows, "BLOCK", 3)
    rows = StoredRows(2)
    for tick in range(8):
        rows.append(tick, (tick, -tick))
    other = deepcopy(rows)
    for tick in range(8, 12):
        other.append(tick, (tick, -tick))
        rows.append(100 + tick, (0, 0))
    assert [time for times, _ in other.blocks() for time in times.tolist()] == list(range(12))
    assert rows.bounds() == [0, 111]
    assert (len(rows), len(other)) == (12, 12)
