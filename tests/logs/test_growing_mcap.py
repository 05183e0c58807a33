"""Recordings that were interrupted are read up to their last complete record; those that go on are read in parts."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

from logs.bags import pose, text, transform, truth, write
from logs.test_open_log import foxglove
from robbdd_tools.logs.growing_mcap import GrowingMcap, is_cut
from robbdd_tools.logs.log_contents import LogContents, UnreadableLog
from robbdd_tools.logs.log_files import is_log
from robbdd_tools.logs.open_log import read_log
from robbdd_tools.protocol.event_signals import read_event_signal

MESSAGES = [
    one
    for tick in range(400)
    for one in (
        transform("cup", (tick, 0, 0), stamp=1 + tick / 100),
        pose("/mug", (0, tick, 0), stamp=1 + tick / 100),
        text(f"e{tick}", 1 + tick / 100),
        truth("/seen", tick % 7 == 0, 1 + tick / 100),
    )
]


def in_chunks(path: Path, folder: Path, size: int = 2000) -> Path:
    """Write an MCAP file again with small chunks, as a recorder writes them every few seconds."""
    from mcap.reader import make_reader
    from mcap.writer import Writer

    found = folder / "chunks.mcap"
    with path.open("rb") as source, found.open("wb") as file:
        writer = Writer(file, chunk_size=size)
        writer.start()
        channels: dict[int, int] = {}
        for schema, channel, message in make_reader(source).iter_messages():
            assert schema is not None
            if channel.id not in channels:
                number = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[channel.id] = writer.register_channel(channel.topic, channel.message_encoding, number)
            writer.add_message(channels[channel.id], message.log_time, message.data, message.publish_time)
        writer.finish()
    return found


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("growing")
    (path,) = write(folder / "drive", MESSAGES, "mcap").glob("*.mcap")
    return in_chunks(path, folder)


def assert_same(found: LogContents, expected: LogContents) -> None:
    assert found.texts == expected.texts
    assert found.tracks.keys() == expected.tracks.keys()
    for frame, track in found.tracks.items():
        assert np.array_equal(track.times, expected.tracks[frame].times)
        assert np.array_equal(track.positions, expected.tracks[frame].positions)
    assert found.truths.keys() == expected.truths.keys()


def test_a_file_that_grows_says_in_the_end_what_the_whole_file_says(whole: Path, tmp_path: Path) -> None:
    """It is read whenever some more bytes were written, wherever these end."""
    data = whole.read_bytes()
    path = tmp_path / "growing.mcap"
    path.write_bytes(b"")
    log = GrowingMcap(path, {}, [read_event_signal("on=/seen becomes true")])
    counts: list[int] = []
    for bound in (*np.random.default_rng(1).integers(0, len(data), 40), len(data)):
        if bound >= path.stat().st_size:
            path.write_bytes(data[:bound])
        log.read()
        counts.append(len(log.contents().texts))
        assert log.complete == (path.stat().st_size == len(data))
    assert counts == sorted(counts)
    assert len(set(counts)) > 3
    assert_same(log.contents(), read_log(whole, signals=[read_event_signal("on=/seen becomes true")]))


@pytest.mark.parametrize("share", [0.1, 0.3, 0.5])
def test_an_interrupted_recording_has_the_begin_of_the_whole_one(share: float, whole: Path, tmp_path: Path) -> None:
    data = whole.read_bytes()
    folder = tmp_path / "drive"
    folder.mkdir()
    path = folder / "cut.mcap"
    path.write_bytes(data[: round(share * len(data))])
    assert is_cut(path)
    assert not is_cut(whole)
    assert is_log(folder)
    for one in (folder, path):
        found, expected = read_log(one), read_log(whole)
        assert found.unfinished
        assert not expected.unfinished
        count = len(found.texts)
        assert 0 < count < len(expected.texts)
        assert found.texts == expected.texts[:count]
        words = "the recording of cut.mcap was interrupted: it is read up to its last complete record, at"
        assert found.remarks[0] == f"{words} {found.end:.2f} s"


def test_an_interrupted_recording_in_json_is_read(tmp_path: Path) -> None:
    path = in_chunks(foxglove(tmp_path / "drive.mcap"), tmp_path, 10)
    path.write_bytes(path.read_bytes()[:-20])
    found = read_log(path)
    assert [one.text for one in found.texts] == ["pick-start", "pick-end"]
    assert found.unfinished


@pytest.mark.parametrize("seed", range(8))
def test_damage_inside_is_refused_or_ends_what_is_read(seed: int, whole: Path, tmp_path: Path) -> None:
    data = bytearray(whole.read_bytes()[:-100])
    random = np.random.default_rng(seed)
    where, size = int(random.integers(8, len(data) - 400)), int(random.integers(1, 400))
    data[where : where + size] = random.integers(0, 256, size, dtype=np.uint8).tobytes()
    path = tmp_path / "cut.mcap"
    path.write_bytes(data)
    expected = read_log(whole)
    with suppress(UnreadableLog):
        assert set(read_log(path).texts) <= set(expected.texts)


def test_a_length_beyond_the_file_is_an_end(whole: Path, tmp_path: Path) -> None:
    data = bytearray(whole.read_bytes()[:-100])
    data[9:17] = b"\xff" * 8
    path = tmp_path / "cut.mcap"
    path.write_bytes(data)
    with pytest.raises(UnreadableLog, match=r"cut\.mcap cannot be read as MCAP: it has no complete record"):
        read_log(path)


def test_messages_of_ros_and_json_in_one_file_are_both_read(whole: Path, tmp_path: Path) -> None:
    """Such a file has no profile of ROS; neither have those of some converters."""
    from mcap.reader import make_reader
    from mcap.writer import Writer

    path = tmp_path / "both.mcap"
    with whole.open("rb") as ros, foxglove(tmp_path / "json.mcap").open("rb") as plain, path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        channels: dict[str, int] = {}
        for source in (ros, plain):
            for schema, channel, message in make_reader(source).iter_messages():
                assert schema is not None
                if channel.topic not in channels:
                    number = writer.register_schema(schema.name, schema.encoding, schema.data)
                    channels[channel.topic] = writer.register_channel(channel.topic, channel.message_encoding, number)
                writer.add_message(channels[channel.topic], message.log_time, message.data, message.publish_time)
        writer.finish()
    found = read_log(path)
    assert {"e0", "pick-start"} <= {one.text for one in found.texts}
    assert not found.unfinished


def test_a_clock_or_a_signal_of_a_topic_that_is_not_there_is_refused(whole: Path, tmp_path: Path) -> None:
    path = tmp_path / "cut.mcap"
    path.write_bytes(whole.read_bytes()[:-20])
    with pytest.raises(UnreadableLog, match="there is no topic '/cap' with headers; the log has /mug, /tf"):
        read_log(path, clocks={"/cap": 1.0})
    with pytest.raises(UnreadableLog, match="the log has no topic '/cap'; it has: /events, /mug, /seen, /tf"):
        read_log(path, signals=[read_event_signal("on=/cap")])


def test_a_folder_without_metadata_is_read_if_it_has_one_file(tmp_path: Path) -> None:
    folder = write(tmp_path / "drive", MESSAGES[:40])
    expected = read_log(folder)
    (folder / "metadata.yaml").unlink()
    assert is_log(folder)
    assert_same(read_log(folder), expected)
    (file,) = folder.glob("*.db3")
    (folder / "second.db3").write_bytes(file.read_bytes())
    with pytest.raises(
        UnreadableLog, match=r"has no metadata\.yaml and several files: write it with 'ros2 bag reindex"
    ):
        read_log(folder)
