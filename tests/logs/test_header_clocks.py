"""Clocks of headers and of reception: conversion of times, clocks that differ, jump or run at another speed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from logs.bags import Message, joints, pose, text, transform, truth, wrench, write
from robbdd_tools.logs.header_clocks import HeaderClocks
from robbdd_tools.logs.log_contents import LogContents
from robbdd_tools.logs.open_log import read_log

SECOND = 1_000_000_000
WALL = 1_700_000_000 * SECOND


def read(folder: Path, messages: list[Message], clocks: dict[str, float] | None = None) -> LogContents:
    return read_log(write(folder / "drive", sorted(messages, key=lambda one: one.received)), clocks=clocks)


def of(clocks: HeaderClocks, *received: int) -> list[int]:
    return clocks.header_time().of(np.array(received, dtype=np.int64)).tolist()


@given(
    st.floats(0.05, 5.0),
    st.integers(-(10**9), 10**9),
    st.floats(0.0, 0.05),
    st.integers(0, 2**32 - 1),
    st.floats(0.0, 1.0),
)
def test_a_time_of_reception_is_converted_within_the_delays_of_messages(
    speed: float, offset: int, delay: float, seed: int, share: float
) -> None:
    """A simulator runs at any speed, and messages arrive up to ``delay`` (s) late."""
    random = np.random.default_rng(seed)
    clocks = HeaderClocks()
    published = WALL + np.arange(0, 20 * SECOND, SECOND // 50)
    headers = offset + np.rint((published - WALL) * speed).astype(np.int64) + SECOND
    received = published + np.rint(random.uniform(0, delay, len(published)) * 1e9).astype(np.int64)
    order = np.argsort(received, kind="stable")
    for when, stamp in zip(received[order].tolist(), headers[order].tolist(), strict=True):
        clocks.seen("/tf", "cup", when, stamp)
    clock = clocks.header_time()
    begin, end = int(received.min()), int(received.max())
    asked = begin + round(share * (end - begin))
    true = offset + SECOND + (asked - WALL) * speed
    (found,) = clock.of(np.array([asked], dtype=np.int64)).tolist()
    if len(clock.received):
        # Pairs are 50 ms apart, and each of them is late by at most the delay.
        assert abs(found - true) <= (speed * delay + 1e-6) * 1e9 + 1
    else:
        # The clocks drift apart by less than 0.1 s, so they count as differing by a constant.
        assert abs(found - true) <= (speed * delay + 0.1) * 1e9


def test_clocks_that_run_alike_differ_by_a_constant() -> None:
    clocks = HeaderClocks()
    for tick in range(100):
        clocks.seen("/tf", "cup", WALL + tick * SECOND // 10, 5 * SECOND + tick * SECOND // 10)
    clock = clocks.header_time()
    assert clock.offset == WALL - 5 * SECOND
    assert of(clocks, WALL + 3 * SECOND, WALL - SECOND) == [8 * SECOND, 4 * SECOND]
    assert clock.unusable == frozenset()


def test_small_differences_are_delays_and_not_clocks() -> None:
    clocks = HeaderClocks()
    for tick in range(100):
        clocks.seen("/tf", "cup", WALL + tick * SECOND // 10 + 900_000_000, WALL + tick * SECOND // 10)
    assert of(clocks, WALL) == [WALL]
    (remark,) = clocks.header_time().remarks
    assert remark == (
        "messages were received 0.900 s after the times in their headers, and those without a header, such as events, "
        "count when they were received: if this is no delay but a wrong clock, pass --clock /tf=-0.900 (seconds)"
    )


@pytest.mark.parametrize(("ahead", "words"), [(-99, ""), (99, ""), (-101, "0.101 s after"), (101, "0.101 s before")])
def test_only_long_delays_are_remarked(ahead: int, words: str) -> None:
    clocks = HeaderClocks()
    for tick in range(100):
        clocks.seen("/tf", "cup", WALL + tick * SECOND // 10, WALL + tick * SECOND // 10 + ahead * 1_000_000)
    remarks = clocks.header_time().remarks
    assert bool(remarks) is bool(words)
    assert words in "".join(remarks)


def simulated(speed: float) -> list[Message]:
    """A cup that is seen at 50 Hz for 10 s of simulated time, and an event in the middle."""
    seen = [
        transform("cup", (tick / 50, 0, 0), stamp=1 + tick / 50, received=1000 + tick / 50 / speed)
        for tick in range(501)
    ]
    return [*seen, text("pick-end", 1000 + 5 / speed)]


@pytest.mark.parametrize("speed", [0.2, 0.5, 1.0, 3.0])
def test_an_event_is_at_the_same_simulated_time_at_each_speed(speed: float, tmp_path: Path) -> None:
    found = read(tmp_path, simulated(speed))
    assert [one.time for one in found.texts] == [pytest.approx(5.0, abs=1e-6)]
    assert found.end == pytest.approx(10.0)
    changes = any("times of reception were converted by the headers of '/tf'" in one for one in found.remarks)
    assert changes == (speed != 1.0)


@pytest.mark.parametrize(("rate", "jump"), [(50, 3.0), (50, 0.4), (50, -0.4), (5, 0.4), (5, -0.4), (5, 8.0)])
def test_a_source_whose_clock_is_set_while_its_messages_come_as_before_is_not_used(
    rate: int, jump: float, tmp_path: Path
) -> None:
    """Between two events, 2 s pass on the recorder's clock, and more or less on the one that was set."""
    set_once = [
        transform("cup", (0, 0, 0), stamp=9 + tick / rate + (jump if tick > 5 * rate else 0), received=9 + tick / rate)
        for tick in range(1, 10 * rate)
    ]
    found = read(tmp_path, [*set_once, text("pick-start", 13.0), text("pick-end", 15.0)])
    assert np.isnan(found.tracks["cup"].positions).all()
    first, second = (one.time for one in found.texts)
    assert second - first == pytest.approx(2.0)
    way = f"the headers of 'cup' on '/tf' jump {'back' if jump < 0 else 'ahead'} by "
    assert any(one.startswith(way) for one in found.remarks)


@pytest.mark.parametrize("rate", [50, 5, 1])
def test_late_messages_and_pauses_of_a_simulator_are_no_jumps(rate: int, tmp_path: Path) -> None:
    """Some messages come in one burst after a stall, and nothing is published while a simulator pauses."""
    ticks = range(20 * rate)
    stalled = [
        transform("cup", (0, 0, 0), stamp=9 + tick / rate, received=max(9 + tick / rate, 12 if 2 * rate < tick else 0))
        for tick in ticks
    ]
    paused = [
        transform("mug", (0, 0, 0), stamp=9 + tick / rate, received=9 + tick / rate + (3 if tick > 4 * rate else 0))
        for tick in ticks
    ]
    for number, messages in enumerate((stalled, paused)):
        assert not any("jump" in one for one in read(tmp_path / str(number), messages).remarks)


@pytest.mark.parametrize("rate", [50, 5, 1])
@pytest.mark.parametrize(("before", "after"), [(3.25, 3.25), (5.0, 5.0), (0.5, 2.0), (1.0, 4.0), (4.0, 1.0)])
def test_a_simulator_of_any_speed_with_late_messages_does_not_jump(rate: int, before: float, after: float) -> None:
    clocks = HeaderClocks()
    published = np.arange(0, 20 * SECOND, SECOND // rate)
    late = np.rint(np.random.default_rng(0).uniform(0, 46e6, len(published))).astype(np.int64)
    stamps = np.rint(np.minimum(published, 10 * SECOND) * before + np.maximum(published - 10 * SECOND, 0) * after)
    order = np.argsort(published + late, kind="stable")
    clocks.seen_many("/tf", "cup", (WALL + published + late)[order], stamps.astype(np.int64)[order])
    found = clocks.header_time()
    assert not found.unusable
    assert not any("jump" in one for one in found.remarks)


@pytest.mark.parametrize(("speed", "jump"), [(0.1, 0.4), (0.5, -0.4), (0.5, 0.4), (3.25, 3.0), (3.25, -3.0)])
def test_a_clock_of_any_speed_that_is_set_is_noticed(speed: float, jump: float) -> None:
    clocks = HeaderClocks()
    for tick in range(200):
        stamp = 100 + speed * tick / 10 + (jump if tick > 50 else 0)
        clocks.seen("/tf", "cup", WALL + tick * SECOND // 10, round(stamp * SECOND))
    found = clocks.header_time()
    assert found.unusable == {("/tf", "cup")}
    (remark,) = found.remarks
    assert f"jump {'back' if jump < 0 else 'ahead'} by " in remark


def test_a_source_with_another_delay_is_remarked(tmp_path: Path) -> None:
    tool = [transform("tool", (0, 0, 0), stamp=100 + tick / 50) for tick in range(501)]
    sent = [pose("/camera/cup", (0, 0, 0), stamp=100 + tick / 10) for tick in range(101)]
    seen = [Message(one.topic, one.received + 0.3, one.kind, one.make) for one in sent]
    found = read(tmp_path / "late", [*tool, *seen])
    assert np.isfinite(found.tracks["camera/cup"].positions).all()
    words = "the headers of '/camera/cup' are 0.300 s behind those of '/tf', compared at reception: "
    assert [one for one in found.remarks if one.startswith(words) and "--clock /camera/cup=-0.300" in one]
    stated = read(tmp_path / "stated", [*tool, *seen], {"/camera/cup": 0.0})
    assert not any("compared at reception" in one for one in stated.remarks)


def test_a_source_that_jumps_back_is_not_used(tmp_path: Path) -> None:
    """A bag was played twice while it was recorded: at each time, the cup was at two places."""
    twice = [
        transform("cup", (play, 0, 0), stamp=1 + tick / 50, received=1000 + 12 * play + tick / 50)
        for play in range(2)
        for tick in range(501)
    ]
    steady = [pose("/mug", (0, 0, 0), stamp=1000 + tick / 10) for tick in range(200)]
    found = read(tmp_path, [*twice, *steady])
    assert np.isnan(found.tracks["cup"].positions).all()
    assert np.isfinite(found.tracks["mug"].positions).all()
    assert any("the headers of 'cup' on '/tf' jump back by 10.000 s" in one for one in found.remarks)
    assert found.end == pytest.approx(19.9)


def camera(ahead: float) -> list[Message]:
    """A tool by the robot's clock, and a cup by that of a camera's computer."""
    tool = [transform("tool", (0, 0, 0), stamp=100 + tick / 50) for tick in range(501)]
    cup = [pose("/camera/cup", (tick / 30, 0, 0), stamp=100 + tick / 30 + ahead) for tick in range(301)]
    return [*tool, *(Message(one.topic, one.received - ahead, one.kind, one.make) for one in cup)]


@pytest.mark.parametrize(("ahead", "side"), [(3.0, "ahead of"), (-2.0, "behind")])
def test_a_source_with_another_clock_is_used_only_if_its_clock_is_stated(
    ahead: float, side: str, tmp_path: Path
) -> None:
    found = read(tmp_path / "plain", camera(ahead))
    assert np.isnan(found.tracks["camera/cup"].positions).all()
    words = f"the headers of '/camera/cup' are {abs(ahead):.3f} s {side} those of '/tf', so they are not used"
    assert [one for one in found.remarks if words in one and f"--clock /camera/cup={ahead:.3f}" in one]
    moved = read(tmp_path / "moved", camera(ahead), {"/camera/cup": ahead}).tracks["camera/cup"]
    assert moved.times[:2].tolist() == pytest.approx([0.0, 1 / 30], abs=1e-6)
    kept = read(tmp_path / "kept", camera(ahead), {"/camera/cup": 0.0}).tracks["camera/cup"]
    assert np.isfinite(kept.positions).all()
    assert kept.times[1] - kept.times[0] == pytest.approx(1 / 30, abs=1e-6)


def test_joints_and_forces_of_another_clock_are_not_used(tmp_path: Path) -> None:
    tool = [transform("tool", (0, 0, 0), stamp=100 + tick / 50) for tick in range(501)]
    late = [joints(["q1"], [0.0], 50 + tick / 10, received=100 + tick / 10) for tick in range(100)]
    forces = [wrench("/ft", (0, 0, 1), 50 + tick / 10) for tick in range(100)]
    pushed = [Message(one.topic, one.received + 50, one.kind, one.make) for one in forces]
    found = read(tmp_path, [*tool, *late, *pushed])
    assert (found.joints, found.forces) == ({}, {})


def test_messages_without_stamps_have_the_time_of_their_reception(tmp_path: Path) -> None:
    unstamped = [transform("cup", (tick / 10, 0, 0), stamp=0.0, received=50 + tick / 10) for tick in range(1, 11)]
    found = read(tmp_path / "alone", [*unstamped, text("pick-end", 50.5), wrench("/ft", (0, 0, 1), 50.4)])
    assert found.tracks["cup"].times.tolist() == pytest.approx(np.arange(10) / 10)
    assert [round(one.time, 6) for one in found.texts] == [0.4]
    others = [transform("tool", (0, 0, 0), stamp=7 + tick / 10, received=50 + tick / 10) for tick in range(1, 11)]
    found = read(tmp_path / "both", [*unstamped, *others])
    assert found.tracks["cup"].times.tolist() == pytest.approx(found.tracks["tool"].times)


def test_texts_are_not_used_if_all_messages_were_received_at_one_time(tmp_path: Path) -> None:
    """A converter that does not keep the times of reception: events have no time."""
    seen = [transform("cup", (0, 0, 0), stamp=1 + tick / 50, received=5.0) for tick in range(501)]
    found = read(tmp_path, [*seen, text("pick-end", 5.0), truth("/seen", True, 5.0)])
    assert (found.texts, found.truths) == ((), {})
    assert any("the times of reception do not say when messages arrived" in one for one in found.remarks)
    assert np.isfinite(found.tracks["cup"].positions).all()


def test_a_first_message_without_a_stamp_joins_the_others_of_its_frame(tmp_path: Path) -> None:
    """Some drivers send a stamp only from their second message on; so does simulated time that begins at zero."""
    found = read(tmp_path, [transform("cup", (tick, 0, 0), stamp=float(tick)) for tick in range(3)])
    assert found.tracks["cup"].positions[:, 0].tolist() == [0, 1, 2]
    moved = [transform("cup", (0, 0, 0), stamp=0.0, received=1.0, parent="camera")]
    other = read(tmp_path / "parent", [*moved, transform("cup", (0, 0, 0), stamp=2.0)])
    assert other.tracks["cup"].parents == ("camera", "map")
