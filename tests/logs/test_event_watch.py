"""Events by numbers, truth values, texts and constants on any topic, and by the lines of programs' logs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from mcap.writer import Writer
from rosbags.typesys import get_types_from_msg

from logs.bags import ROS1, ROS2, Message, header, text, transform, truth, write
from robbdd_tools.logs.log_contents import LogContents, UnreadableLog
from robbdd_tools.logs.open_log import read_log
from robbdd_tools.protocol.event_signals import read_event_signal

STATE = "cell_msgs/msg/State"
for store in (ROS1, ROS2):
    store.register(get_types_from_msg("uint8 IDLE=0\nuint8 MOVING=3\nuint8 mode\nfloat64[] load\nstring name", STATE))
CUP = transform("cup", (0, 0, 0), stamp=1.0)


def number(value: int, received: float) -> Message:
    def make(store: Any) -> Any:
        return store.types["std_msgs/msg/Int32"](data=value)

    return Message("/n", received, "std_msgs/msg/Int32", make)


def state(mode: int, received: float, load: float = 0.0, name: str = "") -> Message:
    def make(store: Any) -> Any:
        import numpy as np

        return store.types[STATE](mode=mode, load=np.array([0.0, load]), name=name)

    return Message("/cell/state", received, STATE, make)


def read(folder: Path, messages: list[Message], *signals: str, kind: str = "sqlite") -> LogContents:
    path = write(folder / ("drive.bag" if kind == "ros1" else "drive"), [CUP, *messages], kind)
    return read_log(path, signals=[read_event_signal(one) for one in signals])


def events(found: LogContents) -> list[str]:
    return [f"{one.time + 1:g} {one.text}" for one in found.texts]


NUMBERS = [number(value, float(time)) for time, value in enumerate((0, 1, 1, 2, 1), start=2)]
STATES = [
    state(0, 2.0, 1.0, "idle"),
    state(3, 3.0, 5.0, "go"),
    state(3, 4.0, 6.0, "go"),
    state(0, 5.0, 2.0, "idle"),
    state(3, 6.0, 3.0, "go"),
]


@pytest.mark.parametrize("kind", ["sqlite", "mcap", "ros1"])
@pytest.mark.parametrize(
    ("signal", "expected"),
    [
        ("go=/n becomes 1", ["3 go", "6 go"]),
        ("go=/n is 1", ["3 go", "4 go", "6 go"]),
        ("go=/n rises above 1.5", ["5 go"]),
        ("go=/n falls below 1.5", ["6 go"]),
        ("go=/n", ["2 go", "3 go", "4 go", "5 go", "6 go"]),
        ("go=/cell/state.mode becomes MOVING", ["3 go", "6 go"]),
        ("go=/cell/state.mode becomes IDLE", ["5 go"]),
        ("go=/cell/state.name is go", ["3 go", "4 go", "6 go"]),
        ("go=/cell/state.load[1] rises above 4", ["3 go"]),
        ("go=/seen becomes true", ["4 go"]),
        ("go=/seen becomes false", ["6 go"]),
    ],
)
def test_a_message_of_any_type_reports_an_event(signal: str, expected: list[str], kind: str, tmp_path: Path) -> None:
    seen = [
        truth("/seen", False, 2.0),
        truth("/seen", True, 4.0),
        truth("/seen", True, 5.0),
        truth("/seen", False, 6.0),
    ]
    found = read(tmp_path, sorted([*NUMBERS, *STATES, *seen], key=lambda one: one.received), signal, kind=kind)
    assert events(found) == expected


def test_a_condition_that_holds_from_the_first_message_is_no_event(tmp_path: Path) -> None:
    found = read(tmp_path, NUMBERS, "idle=/n becomes 0")
    assert events(found) == []
    words = "'/n' fulfils the condition of idle in its first message: since when is not known, so this is no event"
    assert words in found.remarks


@pytest.mark.parametrize(
    ("signal", "words"),
    [
        ("go=/m becomes 1", "the log has no topic '/m'; it has: /cell/state, /n, /tf"),
        ("go=/n.mode becomes 1", "a message on '/n' has no field 'mode'; it has: data"),
        ("go=/cell/state.mode.x becomes 1", "a message on '/cell/state' has no field 'mode.x'; it has: no fields"),
        ("go=/cell/state.load[7] becomes 1", "'load[7]' of a message on '/cell/state' has 2 elements only"),
        ("go=/cell/state.mode becomes DONE", "'DONE' is no value of '/cell/state.mode', which is 0"),
        ("go=/cell/state.load becomes 1", "'/cell/state.load' is neither a number nor a text"),
        ("go=/cell/state.name rises above 1", "'/cell/state.name' is no number, but 'idle'"),
    ],
)
def test_a_signal_that_does_not_fit_the_log_is_refused(signal: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(UnreadableLog) as caught:
        read(tmp_path, [*NUMBERS, *STATES], signal)
    assert words in str(caught.value)


@pytest.mark.parametrize("kind", ["sqlite", "ros1"])
def test_lines_of_programs_report_events(kind: str, tmp_path: Path) -> None:
    def make(store: Any) -> Any:
        name = "rosgraph_msgs/msg/Log" if kind == "ros1" else "rcl_interfaces/msg/Log"
        fields = {"level": 20, "name": "task", "msg": "pick-start", "file": "", "function": "", "line": 1}
        if kind == "ros1":
            return store.types[name](header=header(store, 2.0, ""), topics=[], **fields)
        return store.types[name](stamp=header(store, 2.0, "").stamp, **fields)

    name = "rosgraph_msgs/msg/Log" if kind == "ros1" else "rcl_interfaces/msg/Log"
    found = read(tmp_path, [Message("/rosout", 2.0, name, make)], kind=kind)
    assert events(found) == ["2 pick-start"]


def test_messages_in_json_report_events(tmp_path: Path) -> None:
    path = tmp_path / "drive.mcap"
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        channel = writer.register_channel("/cell", "json", writer.register_schema("cell.State", "jsonschema", b"{}"))
        for time, mode in ((1, "idle"), (2, "busy")):
            writer.add_message(channel, time * 10**9, json.dumps({"arm": {"mode": mode}}).encode(), time * 10**9)
        writer.finish()
    found = read_log(path, signals=[read_event_signal("go=/cell.arm.mode becomes busy")])
    assert [(one.topic, one.text) for one in found.texts] == [("/cell", "go")]
    with pytest.raises(UnreadableLog, match="the log has no topic '/sell'; it has: /cell"):
        read_log(path, signals=[read_event_signal("go=/sell.arm.mode becomes busy")])


def test_a_table_has_no_topics(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    path.write_text("time,event\n1,go\n", encoding="utf-8")
    with pytest.raises(UnreadableLog, match="has no topics: name the events of a table in a column 'event'"):
        read_log(path, signals=[read_event_signal("go=/cell becomes 1")])


def test_reported_texts_stay_beside_the_declared_events(tmp_path: Path) -> None:
    assert events(read(tmp_path, [text("pick-end", 1.5), *NUMBERS], "go=/n becomes 2")) == ["1.5 pick-end", "5 go"]
