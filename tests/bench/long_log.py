"""``python -m tests.bench.long_log [MINUTES]``: time and memory of judging a bag with eight transforms at 1 kHz.

The bag is a file of ROS 2 (MCAP, compressed): one message on ``/tf`` per millisecond, with the cube and the tool of the
example *pickplace* and six other frames. The robot picks in the first seconds and places shortly before the end, so
that windows are open for nearly the whole time. Times and memory are those of the process that judges; memory is
sampled from ``/proc`` (Linux). The figures are for ``docs/logs.md``.
"""

from __future__ import annotations

import resource
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import psutil
from mcap.writer import CompressionType, Writer
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

sys.path.insert(0, str(Path(__file__).parent.parent))

from kit import EXAMPLES

STORE = get_typestore(Stores.ROS2_HUMBLE)
RATE = 1000
"""Messages per second."""
MOVING = ("cube0", "panda", *(f"link{number}" for number in range(1, 7)))
RESTING = {"table": (0.5, 0.0, 0.8), "bin_left": (0.55, 0.3, 0.8), "bin_right": (0.55, -0.3, 0.8)}
START, GOAL = np.array((0.45, 0.0, 0.825)), np.array((0.55, 0.3, 0.86))
TF, TEXT = "tf2_msgs/msg/TFMessage", "std_msgs/msg/String"
EVENTS = (("pick-start", 0.1), ("pick-end", 0.2), ("place-start", 0.8), ("place-end", 0.9))
"""Events of the example, and when they occur as a share of the duration."""
NUMBERS = 7
"""Numbers of a pose."""


def main() -> None:
    minutes = float(sys.argv[1]) if len(sys.argv) > 1 else 60.0
    with tempfile.TemporaryDirectory(dir=Path.cwd()) as name:
        folder = Path(name)
        models = shutil.copytree(EXAMPLES / "pickplace", folder / "models")
        log = folder / "long.mcap"
        write_log(log, round(minutes * 60))
        print(f"{minutes:g} min of log, {log.stat().st_size / 1e6:.0f} MB")
        print(f"decoding by rosbags alone, of the first minute: {decoded(log):.0f} times as fast as real time")
        where = "thing=cube0 and goal=left_ws"
        command = ["robbdd", "judge", str(log), "pickplace.bdd", "--no-store", "--where", where]
        done = subprocess.Popen(command, cwd=models)
        peaks = watch(done)
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        taken = used.ru_utime + used.ru_stime
        print(f"judged in {taken:.0f} s of processor time: {minutes * 60 / taken:.0f} times as fast as real time")
        print(f"memory of its own: {peaks[0] / 1e6:.0f} MB; with pages of files: {peaks[1] / 1e6:.0f} MB")


def write_log(path: Path, seconds: int) -> None:
    """Write the bag. The bytes of a message are those of a template with other stamps and places."""
    template = bytearray(STORE.serialize_cdr(_transforms(dict.fromkeys(MOVING, (0, 0, 0))), TF))
    stamps = _offsets(template)
    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.ZSTD)
        writer.start(profile="ros2")
        channels = {topic: _channel(writer, topic, kind) for topic, kind in _TOPICS.items()}
        still = STORE.serialize_cdr(_transforms(RESTING), TF)
        writer.add_message(channels["/tf_static"], 10**9, bytes(still), 10**9)
        events = {round(share * seconds * RATE): name for name, share in EVENTS}
        for tick in range(seconds * RATE):
            received = 10**9 + tick * 10**9 // RATE
            place = START + (GOAL - START) * min(max(tick / RATE / seconds - 0.2, 0.0) / 0.6, 1.0)
            seconds_part, rest = divmod(received, 10**9)
            for number, (stamp, numbers) in enumerate(stamps):
                template[stamp : stamp + 8] = seconds_part.to_bytes(4, "little") + rest.to_bytes(4, "little")
                moved = place + np.array((0.0, 0.0, 0.1 * (number > 1)))
                template[numbers : numbers + 24] = moved.tobytes()
            writer.add_message(channels["/tf"], received, bytes(template), received)
            if tick in events:
                data = STORE.serialize_cdr(STORE.types[TEXT](data=events[tick]), TEXT)
                writer.add_message(channels["/events"], received, bytes(data), received)
        writer.finish()


_TOPICS = {"/tf": TF, "/tf_static": TF, "/events": TEXT}


def _channel(writer: Writer, topic: str, kind: str) -> int:
    definition, _ = STORE.generate_msgdef(kind, ros_version=2)
    number = writer.register_schema(kind, "ros2msg", definition.encode())
    return writer.register_channel(topic, "cdr", number)


def _transforms(places: dict[str, Any]) -> Any:
    types: Any = STORE.types
    head = types["std_msgs/msg/Header"](types["builtin_interfaces/msg/Time"](1, 0), "map")
    turn = types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0)
    vector, moved = types["geometry_msgs/msg/Vector3"], types["geometry_msgs/msg/Transform"]
    kind = types["geometry_msgs/msg/TransformStamped"]
    found = [kind(head, name, moved(vector(*map(float, place)), turn)) for name, place in places.items()]
    return types[TF](transforms=found)


def _offsets(data: bytearray) -> list[tuple[int, int]]:
    """Return where the stamp and the place of each transform are in the bytes of a message."""
    found: list[tuple[int, int]] = []
    turn = np.array((0.0, 0.0, 0.0, 1.0)).tobytes()
    end = 8
    for _ in MOVING:
        begin = data.index(bytes((1, 0, 0, 0, 0, 0, 0, 0)), end)
        end = data.index(turn, begin) + len(turn)
        found.append((begin, end - 8 * NUMBERS))
    return found


def decoded(path: Path) -> float:
    """Return how many times as fast as real time rosbags decodes the first minute of messages, in processor time."""
    begun, count = time.process_time(), 0
    with AnyReader([path]) as reader:
        for connection, _, raw in reader.messages():
            reader.deserialize(raw, connection.msgtype)
            count += 1
            if count >= 60 * RATE:
                break
    return count / RATE / (time.process_time() - begun)


def watch(process: subprocess.Popen[bytes]) -> tuple[int, int]:
    """Wait for the end of a process. Return the peaks of its descendants' own memory and of all their memory, bytes."""
    peaks = [0, 0]
    ended = threading.Event()

    def sample() -> None:
        while not ended.wait(0.1):
            for one in _family(process.pid):
                try:
                    status = Path(f"/proc/{one}/status").read_text()
                except OSError:
                    continue
                for index, field in enumerate(("RssAnon", "VmRSS")):
                    size = status.partition(f"{field}:")[2].split()
                    peaks[index] = max(peaks[index], int(size[0]) * 1024 if size else 0)

    watcher = threading.Thread(target=sample)
    watcher.start()
    process.wait()
    ended.set()
    watcher.join()
    return peaks[0], peaks[1]


def _family(pid: int) -> list[int]:
    try:
        root = psutil.Process(pid)
        return [pid, *(one.pid for one in root.children(recursive=True))]
    except psutil.Error:
        return []


if __name__ == "__main__":
    main()
