"""External systems under test: processes and endpoints execute behaviours, and their failures are explained."""

from __future__ import annotations

import re
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import pytest

from kit import DOCS, EXAMPLES
from robbdd_tools.agent.execution import Execution
from robbdd_tools.base.external_systems import ENDPOINT_HOSTS, endpoint_host
from robbdd_tools.base.isolation import NO_USER_CODE
from robbdd_tools.catalog.executable import Implementation, Origin
from robbdd_tools.protocol.specs import ExecutionSpec
from robbdd_tools.run.user_code import UserCodeRefused
from robbdd_tools.workbench.model import load
from robbdd_tools.workbench.plan import Plan, Selection
from robbdd_tools.workbench.run import check_user_code
from robbdd_tools.world.external_behaviour import close_links
from world.worlds import BIN_WS, CUBE, PANDA, pick_place, scenario

pytestmark = pytest.mark.physics
NOD = """
def answers(message, state):
    if message["type"] == "reset":
        state.clear()
        return {"type": "ready", "version": 1}
    state.setdefault("start", message["joints"])
    state["ticks"] = tick = state.get("ticks", 0) + 1
    goal = list(state["start"])
    goal[5] += 0.1 * min(1.0, tick / 25)
    events = {1: ["pick-start"], 20: ["pick-end"], 30: ["place-start", "place-end"]}.get(tick, [])
    return {"type": "command", "joints": goal, "opening": 1.0, "events": events, "done": tick == 30}
"""
BEGINS = '    state.setdefault("start"'
MAIN = """
import os, sys, time
import msgpack
print("started", file=sys.stderr)
open("starts", "a").write("x")
state, messages = {}, msgpack.Unpacker()
while received := sys.stdin.buffer.read1(65536):
    messages.feed(received)
    for message in messages:
        sys.stdout.buffer.write(msgpack.packb(answers(message, state)))
        sys.stdout.buffer.flush()
"""


@pytest.fixture(autouse=True)
def _closed() -> Iterator[None]:
    yield
    close_links()


def executed(folder: Path, name: str, kind: str = "process", limit: float | None = None) -> Execution:
    implementation = Implementation("x:own", kind, name, Origin(str(folder / "run.bddx"), 5, 3), limit=limit)
    execution = ExecutionSpec("x:run", "x:run", implementation)
    return Execution(replace(scenario(), execution=execution), [pick_place(CUBE, BIN_WS, PANDA)])


def process(folder: Path, code: str = NOD, **options: Any) -> Execution:
    (folder / "policy.py").write_text(code + MAIN, encoding="utf-8")
    return executed(folder, "python policy.py", **options)


@contextmanager
def serving(code: str) -> Generator[str]:
    """Serve a policy on a free port, and return its address."""
    scope: dict[str, Any] = {}
    exec(code, scope)
    codec: Any = import_module("msgpack")

    def connected(socket: Any) -> None:
        state: dict[str, Any] = {}
        for frame in socket:
            socket.send(codec.packb(scope["answers"](codec.unpackb(frame), state)))

    server: Any = import_module("websockets.sync.server").serve(connected, "127.0.0.1", 0)
    Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield f"ws://127.0.0.1:{server.socket.getsockname()[1]}"
    finally:
        server.shutdown()


def nodded(execution: Execution) -> list[tuple[str, float]]:
    """Check that the arm has moved, and return the events with their times."""
    robot = execution.simulation.robots[PANDA]
    start = execution.simulation.joint_positions(robot).copy()
    assert execution.run_behaviour(0), execution.trace.remark
    assert execution.simulation.joint_positions(robot)[5] - start[5] == pytest.approx(0.1, abs=0.01)
    return [(stamp.name, stamp.time) for stamp in execution.trace.events]


def test_a_process_moves_the_arm_and_stamps_its_events_the_same_each_time(tmp_path: Path) -> None:
    first, second = nodded(process(tmp_path)), nodded(process(tmp_path))
    assert [name for name, _ in first][:5] == ["t:start", "t:pick-start", "t:pick-end", "t:place-start", "t:place-end"]
    assert first == second
    assert (tmp_path / "starts").read_text(encoding="utf-8") == "x", "the process is kept between executions"


def test_an_endpoint_does_the_same_as_a_process(tmp_path: Path) -> None:
    with serving(NOD) as address:
        assert nodded(executed(tmp_path, address, "endpoint")) == nodded(process(tmp_path))
        close_links()


def test_a_position_of_the_tool_is_solved_for_the_joints(tmp_path: Path) -> None:
    code = NOD.replace('"joints": goal', '"tool": {"position": [0.45, 0.1, 0.5], "closing": 0.3}').replace(
        "tick == 30", "tick == 100"
    )
    execution = process(tmp_path, code)
    assert execution.run_behaviour(0), execution.trace.remark
    robot = execution.simulation.robots[PANDA]
    assert np.allclose(execution.simulation.data.site_xpos[robot.tool], [0.45, 0.1, 0.5], atol=0.02)


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        (BEGINS, f"    os._exit(3)\n{BEGINS}", r"ended with exit code 3: started at "),
        (BEGINS, f"    time.sleep(9)\n{BEGINS}", r"did not answer within 0\.3 s at "),
        (BEGINS, f"    print('hello', flush=True)\n{BEGINS}", r"sent \d+ instead of a map|is not MessagePack"),
        ('"joints": goal', '"joints": goal[1:]', r"sent 'joints' that is not a list of 7 finite numbers: \["),
        ('"joints": goal', '"joints": [float("nan")] * 7', r"sent 'joints' that is not a list of 7 finite numbers"),
        ('"opening": 1.0', '"opening": "wide"', r"sent 'opening' that is not a finite number: 'wide'"),
        ('"events": events', '"events": [4]', r"sent 'events' that are no list of at most 100 names: \[4\]"),
        ('"events": events', '"events": ["pick-over"]', r"sent a wrong event: 'pick-place' has no event 'pick-over'"),
        ('"done": tick == 30', '"done": 1', r"sent 'done' that is neither true nor false: 1"),
        ('"version": 1', '"version": 2', r"answered .* to 'reset', not "),
        ('"type": "command"', '"type": "hello"', r"answered .* to an observation, not "),
    ],
)  # fmt: skip
def test_a_failing_process_leaves_the_execution_without_a_result(
    tmp_path: Path, old: str, new: str, reason: str
) -> None:
    assert old in NOD
    execution = process(tmp_path, "import os, time\n" + NOD.replace(old, new), limit=0.3)
    assert not execution.run_behaviour(0)
    assert execution.fault is not None
    remark = execution.broken
    assert remark.startswith("run.bddx:5:3: the process 'python policy.py' ")
    assert re.search(reason, remark), remark
    again = process(tmp_path, NOD)
    nodded(again)


def test_a_system_may_report_that_its_behaviour_failed(tmp_path: Path) -> None:
    code = NOD.replace('return {"type": "command",', 'return {"type": "failed", "reason": "no grasp",')
    execution = process(tmp_path, code)
    assert not execution.run_behaviour(0)
    assert (execution.fault, execution.broken) == (None, "")
    assert execution.trace.remark.startswith("no grasp at 0")


@pytest.mark.parametrize(
    ("kind", "name", "reason"),
    [
        ("process", "./not-there", "cannot be started: No such file or directory"),
        ("endpoint", "ws://127.0.0.1:9", "cannot be reached: "),
    ],
)
def test_a_system_that_is_not_there_is_named(tmp_path: Path, kind: str, name: str, reason: str) -> None:
    execution = executed(tmp_path, name, kind)
    assert not execution.run_behaviour(0)
    assert f"the {kind} '{name}' {reason}" in execution.broken


def planned(folder: Path, source: str) -> Plan:
    text = (
        (EXAMPLES / "external" / "tidy.bddx").read_text(encoding="utf-8").replace('process "python policy.py"', source)
    )
    for name in ("tidy.bdd", "cell.scenex"):
        text = text.replace(name, (EXAMPLES / "external" / name).as_posix())
    (folder / "tidy.bddx").write_text(text, encoding="utf-8")
    return Plan.of(load(folder / "tidy.bddx"), Selection(first=1))


def test_both_kinds_are_users_code(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(NO_USER_CODE, "1")
    for source, words in (('process "./p"', "the process './p'"), ('endpoint "ws://h:1"', "the endpoint 'ws://h:1'")):
        with pytest.raises(
            UserCodeRefused, match=rf"tidy\.bddx:7:\d+: a behaviour is {words}: leave out --no-user-code"
        ):
            check_user_code(planned(tmp_path, source))


def test_the_host_of_an_endpoint_has_to_be_allowed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "robbdd.toml").write_text('endpoint-hosts = ["lab-pc"]\n', encoding="utf-8")
    own = tmp_path / "own.toml"
    monkeypatch.setenv("ROBBDD_CONFIG", str(own))
    monkeypatch.delenv(ENDPOINT_HOSTS, raising=False)
    plan = planned(tmp_path, 'endpoint "ws://lab-pc:9000"')
    with pytest.raises(
        UserCodeRefused, match=r"'ws://lab-pc:9000', whose host is not allowed: give --allow-host lab-pc"
    ):
        check_user_code(plan)
    monkeypatch.setenv(ENDPOINT_HOSTS, "other,lab-pc")
    check_user_code(plan)
    monkeypatch.delenv(ENDPOINT_HOSTS)
    own.write_text('endpoint-hosts = ["lab-pc"]\n', encoding="utf-8")
    check_user_code(plan)
    own.write_text("endpoint-hosts = 3\n", encoding="utf-8")
    with pytest.raises(UserCodeRefused, match="'endpoint-hosts' is a list of host names"):
        check_user_code(plan)


def test_an_address_has_one_host() -> None:
    assert endpoint_host("wss://lab.example:9/x") == "lab.example"
    for wrong in ("http://lab", "ws://", "ws://lab:x", "ws://me@lab", "lab:9000", "ws://a b", "ws://[1"):
        assert endpoint_host(wrong) == "", wrong


def test_the_example_needs_nothing_of_ours() -> None:
    text = (EXAMPLES / "external" / "policy.py").read_text(encoding="utf-8")
    imported = {
        line.split()[1].partition(".")[0] for line in text.splitlines() if line.strip().startswith(("import", "from"))
    }
    assert imported <= {"os", "sys", "math", "msgpack", "websockets"}


def test_the_bytes_on_the_page_are_those_of_the_answer() -> None:
    page = (DOCS / "external-systems.md").read_text(encoding="utf-8")
    (written,) = re.findall(r"^```\n((?:[0-9a-f]{2} ?)+)\n```$", page, re.MULTILINE)
    packed = import_module("msgpack").packb({"type": "ready", "version": 1})
    assert bytes.fromhex(written) == packed
    assert f"the {len(packed)} bytes" in page
