"""A debug adapter over standard input and output: breakpoints on clauses, variables, steps, errors."""

from __future__ import annotations

import errno
import json
import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import psutil
import pytest

from commands.test_debug import Debugger
from dap.clients import Client
from fork_kit import ROBBDD
from kit import EXAMPLES, schema_errors
from robbdd_tools.base.files import uri_to_path
from robbdd_tools.run.debugging import free_port

pytestmark = [pytest.mark.physics, pytest.mark.usefixtures("forks")]
MODEL = EXAMPLES / "pickplace" / "pickplace.bdd"
LINES = MODEL.read_text(encoding="utf-8").splitlines()
CHOICE: dict[str, Any] = {"scenario": "part-to-bin", "where": "thing=cube0 and robot=~panda", "seed": 3}


def line_of(text: str) -> int:
    return next(number for number, line in enumerate(LINES, start=1) if text in line)


@pytest.fixture
def process() -> Iterator[subprocess.Popen[bytes]]:
    with subprocess.Popen([*ROBBDD, "dap"], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as started:
        yield started
        started.kill()


@pytest.fixture
def client(process: subprocess.Popen[bytes]) -> Client:
    return Client.of(process)


def stopped(client: Client) -> tuple[str, str]:
    """Return why and where the execution has stopped next."""
    body = client.event("stopped")
    return body["reason"], body.get("text", "")


def test_a_breakpoint_on_a_clause_stops_with_margins_poses_and_events(client: Client, tmp_path: Path) -> None:
    goal, untouched = line_of("at-goal:"), line_of("goal-untouched:")
    kept: dict[str, Any] = {**CHOICE, "noStore": False, "store": str(tmp_path / "store")}
    found = client.launch(MODEL, untouched, goal, line_of("Then:"), line_of("import"), **kept)
    assert [one["verified"] for one in found] == [True, True, False, False]
    assert [one.get("message") for one in found[2:]] == ["there is no clause on this line"] * 2
    assert stopped(client) == ("breakpoint", "goal-untouched opens")
    frames = client.ask("stackTrace", threadId=1)["stackFrames"]
    assert [(frame["name"], frame["line"]) for frame in frames] == [
        ("goal-untouched", untouched),
        ("part-to-bin -- 1", line_of("Scenario part-to-bin")),
        ("pick-place", line_of("Scenario Template")),
    ]
    assert frames[0]["source"]["path"] == str(MODEL)
    shown = client.variables()
    assert shown["Clause"]["verdict"] == "not judged yet"
    assert shown["Clause"]["window"] == "open since 0.512 s"
    assert shown["Clause"]["margin now"] == "+50 mm"
    assert shown["Events"]["evt-pick-start"] == "0.512 s"
    assert shown["Events"]["evt-place-end"] == "has not occurred"
    assert shown["World"]["cube0"].endswith(") m")
    assert shown["World"]["panda"].startswith("tool at (")
    scenario = client.variables(1)["Scenario"]
    assert (scenario["thing"], scenario["seed"]) == ("cube0", scenario["seed"])
    client.ask("continue", threadId=1)
    assert stopped(client)[1].startswith("at-goal opens, at-goal closes")
    held = client.ask("evaluate", expression="panda.grips", context="hover")
    assert held["result"] == "nothing"
    client.ask("continue", threadId=1)
    results = uri_to_path(client.event("robbdd/stored")["results"])
    assert results is not None
    assert json.loads(results.read_text(encoding="utf-8"))["complete"]
    assert client.event("exited") == {"exitCode": 0}
    client.event("terminated")
    assert "✔ +50 mm" in client.output
    assert "part-to-bin -- 1: holds" in client.output


def test_names_are_evaluated_and_nothing_else(client: Client) -> None:
    client.launch(MODEL, stopOnEntry=True, **CHOICE)
    assert stopped(client) == ("entry", "")
    for name in ("cube0", "<cubes.cube0>", "thing", "<pick-place.thing>", "env:cube0", "cube0.position"):
        assert client.ask("evaluate", expression=name)["result"].endswith(") m"), name
    assert client.ask("evaluate", expression="cube0.position.z")["result"].endswith(" m")
    assert client.ask("evaluate", expression="at-goal")["result"] == "not judged yet"
    assert client.ask("evaluate", expression="left_ws")["result"].startswith("around (")
    assert client.refused("evaluate", expression="__import__('os')").startswith("'__import__('os')' is not a name: ")
    assert client.refused("evaluate", expression="cube9").startswith("nothing in part-to-bin -- 1 is called 'cube9': ")


def test_it_steps_by_moments_and_samples_pauses_and_writes_the_scene(client: Client) -> None:
    client.launch(MODEL, stopOnEntry=True, **CHOICE)
    client.event("stopped")
    client.ask("next", threadId=1)
    assert stopped(client) == ("step", "at-source opens, at-source closes, goal-untouched opens, carry opens")
    first = client.ask("robbdd/scene")
    assert schema_errors("trace.schema.json", first) == []
    assert {clause["reason"] for clause in first["clauses"]} == {"not judged yet"}
    assert first["clauses"][first["paused_at"]]["name"] == "at-source"
    client.ask("stepIn", threadId=1)
    assert stopped(client) == ("step", "")
    assert client.ask("robbdd/scene")["duration"] == pytest.approx(first["duration"] + 0.016)
    client.ask("continue", threadId=1)
    assert client.refused("stackTrace", threadId=1) == "the simulation is running: pause it first"
    client.ask("pause", threadId=1)
    assert stopped(client)[0] == "pause"
    client.ask("terminate")
    client.event("terminated")
    assert "the debugger ended the execution" in client.output


def test_a_condition_chooses_the_moment(client: Client) -> None:
    client.ask("initialize", adapterID="robbdd")
    client.ask("launch", program=str(MODEL), noStore=True, **CHOICE)
    client.event("initialized")
    line = line_of("goal-untouched:")
    conditions = ("closes", "opens or turns negative", "never")
    stated = [{"line": line, "condition": condition} for condition in conditions[:1] + conditions[2:]]
    found = client.ask("setBreakpoints", source={"path": str(MODEL)}, breakpoints=stated)["breakpoints"]
    assert found[1]["message"] == (
        "'never' is not a moment of a clause: write 'opens', 'closes', 'turns negative', joined by 'or'"
    )
    client.ask("configurationDone")
    body = client.event("stopped")
    assert (body["text"], body["hitBreakpointIds"]) == ("goal-untouched closes", [found[0]["id"]])


def test_a_filter_stops_at_a_moment_of_any_clause(client: Client) -> None:
    client.launch(MODEL, filters=("opens",), **CHOICE)
    reason, text = stopped(client)
    assert reason == "breakpoint"
    assert "at-source opens" in text


def model_with(folder: Path, text: str) -> Path:
    path = folder / "broken.bdd"
    path.write_text(text, encoding="utf-8")
    return path


def test_what_cannot_be_debugged_is_refused_with_its_reason(client: Client, tmp_path: Path) -> None:
    client.ask("initialize", adapterID="robbdd")
    broken = model_with(tmp_path, "ns crit = 5\n")
    for arguments, reason in (
        ({}, "'program' is missing"),
        ({"program": 3}, "'program' must be a text, not 3"),
        ({"program": str(tmp_path / "none.bdd")}, f"{tmp_path / 'none.bdd'}:1:1: error: there is no file 'none.bdd'"),
        ({"program": str(broken)}, f"{broken}:1:"),
        ({"program": str(MODEL), "scenario": "nothing"}, "there is no scenario 'nothing'; the model has part-to-bin"),
        ({"program": str(MODEL), "where": "thing=none"}, "no scenario fits the selection"),
        ({"program": str(MODEL), "variation": 99}, "no scenario fits the selection"),
        ({"program": str(MODEL), "bhv": 3}, "'bhv' must map"),
    ):
        assert client.refused("launch", **arguments).startswith(reason), arguments
    assert client.refused("stackTrace", threadId=1) == "no scenario is debugged yet: launch one"
    assert client.refused("nonsense") == "the request 'nonsense' is not supported"


def test_python_code_is_debugged_in_the_same_session(client: Client) -> None:
    client.ask("initialize", adapterID="robbdd", supportsStartDebuggingRequest=True)
    client.ask("launch", program=str(MODEL), noStore=True, python=True, **CHOICE)
    client.event("initialized")
    client.ask("setExceptionBreakpoints", filters=["opens"])
    client.ask("configurationDone")
    while (request := client.read())["type"] != "request":
        pass
    assert request["command"] == "startDebugging"
    python = Debugger(request["arguments"]["configuration"]["port"])
    python.answer("initialize", adapterID="test", pathFormat="path")
    python.ask("attach", justMyCode=True)
    python.until(type="event", event="initialized")
    python.ask("configurationDone")
    assert "at-source opens" in stopped(client)[1]
    client.ask("continue", threadId=1)


@pytest.mark.parametrize("end", ["close", "kill"])
def test_the_agent_ends_with_the_adapter(end: str) -> None:
    command = [sys.executable, "-m", "robbdd_tools.cli", "dap"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        client = Client.of(process)
        client.launch(MODEL, stopOnEntry=True, **CHOICE)
        client.event("stopped")
        (agent,) = psutil.Process(process.pid).children(recursive=True)
        if end == "close":
            assert process.stdin is not None
            process.stdin.close()
        else:
            process.kill()
        process.wait(60)
        assert not psutil.wait_procs([agent], timeout=60)[1]


def test_a_port_serves_one_editor() -> None:
    port = free_port()
    with subprocess.Popen([*ROBBDD, "dap", "--port", str(port)], stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        assert process.stderr.readline() == f"waiting for an editor at 127.0.0.1:{port}\n"
        connection = socket.create_connection(("127.0.0.1", port))
        with connection, connection.makefile("rb") as received, connection.makefile("wb") as sent:
            client = Client(received, sent)
            client.ask("initialize", adapterID="robbdd")
            client.ask("disconnect")
        assert process.wait(60) == 0


def test_a_port_in_use_is_named() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        done = subprocess.run([*ROBBDD, "dap", "--port", str(port)], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr == f"robbdd: no editor can connect to 127.0.0.1:{port}: {os.strerror(errno.EADDRINUSE)}\n"
