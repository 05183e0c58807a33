"""Traces as MCAP: exact to the bit, without the wall clock, and readable for others."""

from __future__ import annotations

import json
from contextlib import suppress
from dataclasses import fields, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from mcap.reader import make_reader

from robbdd_tools.agent.compare_traces import difference
from robbdd_tools.catalog.api import Region
from robbdd_tools.monitor.contact import Contact
from robbdd_tools.monitor.trace import EventStamp, Trace
from robbdd_tools.traces import codec, mcap_file
from robbdd_tools.traces.codec import Evidence, pack, unpack
from robbdd_tools.traces.mcap_file import SCHEMAS, UnreadableTrace, read_trace, write_trace
from robbdd_tools.world.log_views import views
from world.worlds import BIN_WS, CUBE, PANDA, execution, pick_place

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

NAMES = ("e:a", "e:b")
REGIONS = {"e:ws": (("e:b", Region((0.0, 0.1, 1e-300), (0.5, 0.25, 0.1))),)}


def floats(*shape: int) -> st.SearchStrategy[FloatArray]:
    return arrays(np.float64, shape, elements=st.floats(allow_nan=True, allow_infinity=True))


@st.composite
def traces(draw: st.DrawFn) -> Trace:
    size = draw(st.integers(0, 4))
    return Trace(
        NAMES,
        draw(floats(size)),
        draw(floats(size, 2, 3)),
        draw(floats(size, 2, 4)),
        {"e:r": draw(floats(size, 2))},
        (EventStamp("t:e", draw(st.floats(0, 1e3))),),
        draw(st.booleans()),
        draw(st.text(max_size=5)),
        {("e:r", "e:a"): draw(floats(size))},
        {("e:a", "mass"): "0.1"},
        {("e:r", "e:b"): draw(floats(size))},
        {"e:a": (((0.0, 0.1, 0.2), 0.3),)},
        impulses={("e:r", "e:b"): draw(floats(size))},
        watched=("e:r",),
        contacts=(Contact("e:r", "e:a", "e:b", 0.1, draw(st.floats(0, 1e3)), 0.2, 0.3),),
        immovable=("e:b",),
    )


def bits(value: Any) -> object:
    """Return something that is equal only for values with equal bits."""
    if hasattr(value, "items"):
        return {key: bits(inner) for key, inner in value.items()}
    return (value.shape, value.dtype.str, value.tobytes()) if hasattr(value, "tobytes") else value


@given(traces())
def test_a_trace_comes_back_equal_to_the_last_bit(trace: Trace) -> None:
    back = unpack(pack(Evidence(trace, REGIONS)))
    for entry in fields(Trace):
        assert bits(getattr(back.trace, entry.name)) == bits(getattr(trace, entry.name)), entry.name
    assert back.regions == REGIONS


def older(data: bytes, *missing: str) -> bytes:
    """Return a packed trace as written by a version without some fields, none of which contains an array."""
    size = int.from_bytes(data[:8], "little")
    head = json.loads(data[8 : 8 + size])
    for name in missing:
        del head["fields"]["trace"]["fields"][name]
    text = json.dumps(head).encode()
    return len(text).to_bytes(8, "little") + text + data[8 + size :]


def test_a_trace_of_a_version_without_contacts_is_read_and_tells_what_is_fixed() -> None:
    settings = {("e:a", "mass"): "0.1", ("e:b", "friction"): "0.6"}
    trace = Trace(NAMES, np.zeros(1), np.zeros((1, 2, 3)), np.zeros((1, 2, 4)), settings=settings)
    lacking = ("impulses", "watched", "contacts", "immovable")
    back = unpack(older(pack(Evidence(trace, REGIONS)), *lacking)).trace
    assert (back.immovable, back.watched, back.forces) == (("e:b",), (), {})


@pytest.mark.parametrize("missing", ["times", "names"])
def test_a_trace_that_lacks_what_every_version_wrote_is_refused(missing: str) -> None:
    trace = Trace(NAMES, np.zeros(0), np.zeros((0, 2, 3)), np.zeros((0, 2, 4)))
    with pytest.raises(TypeError, match="this Trace was written by another version"):
        unpack(older(pack(Evidence(trace, REGIONS)), missing))


def still(rows: int = 5) -> Trace:
    times: FloatArray = np.linspace(0.0, 0.016 * (rows - 1), rows)
    return Trace(NAMES, times, np.zeros((rows, 2, 3)), np.zeros((rows, 2, 4)), {"e:r": np.zeros((rows, 2))})


@given(traces(), st.integers(1, 200), st.integers(1, 9))
def test_a_long_trace_is_written_in_parts(trace: Trace, message: int, part: int) -> None:
    evidence = Evidence(trace, REGIONS)
    expected = pack(evidence)
    with TemporaryDirectory() as folder, pytest.MonkeyPatch.context() as patch:
        patch.setattr(mcap_file, "MESSAGE", message)
        patch.setattr(codec, "PART", part)
        path = Path(folder) / "traces" / "a.mcap"
        write_trace(path, evidence, ())
        assert pack(read_trace(path)) == expected
        with path.open("rb") as file:
            parts = [one.data for _, _, one in make_reader(file).iter_messages(log_time_order=False)]
    assert b"".join(parts) == expected
    assert len(parts) > 1 or not len(trace.times)


def test_the_first_diverging_step_and_quantity_are_named() -> None:
    trace = still()
    positions, grips = trace.positions.copy(), trace.grips["e:r"].copy()
    positions[3, 1, 2] = 5e-324
    grips[4, 0] = 1.0
    other = replace(trace, positions=positions, grips={"e:r": grips})
    words = difference(Evidence(trace, {}), Evidence(other, {}))
    assert words == "step 3 (0.048 s): position of e:b z was 0.0 and is 5e-324"


@pytest.mark.parametrize(
    ("other", "words"),
    [
        (still(4), "step 4: 5 samples were taken, now 4"),
        (replace(still(), names=("e:a", "e:c")), "the scenes hold different bodies"),
        (replace(still(), remark="x"), "the traces differ apart from the samples"),
    ],
)
def test_other_differences_are_named_too(other: Trace, words: str) -> None:
    assert difference(Evidence(still(), {}), Evidence(other, {})).startswith(words)
    assert difference(Evidence(other, {}), Evidence(other, {})) == ""


def test_what_could_not_be_restored_is_not_written(tmp_path: Path) -> None:
    strange: Any = replace(still(), settings={("e:a", "x"): object()})
    with pytest.raises(TypeError, match="a object in a trace cannot be stored"):
        write_trace(tmp_path / "a.mcap", Evidence(strange, {}), ())


@pytest.mark.parametrize("data", [b"", b"no log at all", b"\x89MCAP0\r\n"])
def test_a_file_that_is_no_trace_is_explained(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "a.mcap"
    path.write_bytes(data)
    with pytest.raises(UnreadableTrace, match=r"a\.mcap"):
        read_trace(path)
    with pytest.raises(UnreadableTrace, match=r"none\.mcap is gone"):
        read_trace(tmp_path / "none.mcap")
    with pytest.raises(UnreadableTrace, match=r"cannot be read: .* is a folder"):
        read_trace(tmp_path)


@given(place=st.floats(0, 1, exclude_max=True), change=st.integers(1, 255), is_cut=st.booleans())
def test_a_damaged_trace_is_found_out(place: float, change: int, is_cut: bool) -> None:
    evidence = Evidence(still(200), REGIONS)
    with TemporaryDirectory() as folder:
        path = Path(folder) / "traces" / "a.mcap"
        write_trace(path, evidence, ())
        data = bytearray(path.read_bytes())
        at = int(place * len(data))
        data[at] ^= change
        path.write_bytes(data[:at] if is_cut else data)
        with suppress(UnreadableTrace):
            assert pack(read_trace(path)) == pack(evidence)


@pytest.mark.physics
def test_an_execution_gives_equal_files_that_viewers_understand(tmp_path: Path) -> None:
    for name in ("a.mcap", "b.mcap"):
        run = execution([pick_place()])
        run.run_behaviour(0)
        trace = run.complete(run.trace)
        write_trace(tmp_path / name, Evidence(trace, run.regions), views(run.simulation, trace))
        assert pack(read_trace(tmp_path / name)) == pack(Evidence(trace, run.regions))
    assert (tmp_path / "a.mcap").read_bytes() == (tmp_path / "b.mcap").read_bytes()
    assert BIN_WS in read_trace(tmp_path / "a.mcap").regions
    topics: dict[str, list[Any]] = {}
    with (tmp_path / "a.mcap").open("rb") as file:
        for schema, channel, message in make_reader(file).iter_messages():
            if channel.topic in SCHEMAS:
                assert schema is not None
                assert (schema.encoding, channel.message_encoding) == ("jsonschema", "json")
                topics.setdefault(channel.topic, []).append(json.loads(message.data))
    assert topics.keys() == SCHEMAS.keys() - {"/verdicts"}
    frames = [{frame["child_frame_id"] for frame in message["transforms"]} for message in topics["/tf"]]
    shown = {entity["frame_id"] for entity in topics["/scene"][0]["entities"]}
    # The floor is a plane, which that schema does not have.
    assert shown == frames[0] - {"world/solid"}
    assert CUBE in frames[-1]
    assert len(topics["/joints"][0][PANDA]) == 7
    last = next(frame for frame in topics["/tf"][-1]["transforms"] if frame["child_frame_id"] == CUBE)
    row = (len(topics["/tf"]) - 1) * 4
    place = trace.positions[row, trace.column(CUBE)]
    assert [last["translation"][axis] for axis in "xyz"] == pytest.approx(place.tolist(), abs=1e-5)
