"""A debugger connects to a run and stops in users' code."""

from __future__ import annotations

import json
import shutil
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from kit import EXAMPLES
from robbdd_tools.cli import main
from robbdd_tools.run import debugging
from robbdd_tools.run.debugging import free_port

STEPS = """from behave import then


@then('the lamp is green after event "crit:evt-end"')
def lamp(context):
    colour = "red"
    assert colour == "green"
"""
LAMP = "            and\n            'the lamp is green' after <evt-end>\n        )"


class Debugger:
    """A client of the Debug Adapter Protocol."""

    def __init__(self, port: int) -> None:
        self._stream = socket.create_connection(("127.0.0.1", port)).makefile("rwb")
        self._number = 0

    def ask(self, command: str, **arguments: object) -> int:
        """Send a request; return its number."""
        self._number += 1
        body = {"seq": self._number, "type": "request", "command": command, "arguments": arguments}
        content = json.dumps(body).encode()
        self._stream.write(b"Content-Length: %d\r\n\r\n%b" % (len(content), content))
        self._stream.flush()
        return self._number

    def until(self, **fields: object) -> Any:
        """Return the first message with these fields, of those that arrive from now on."""
        while True:
            message = self._read()
            if all(message.get(name) == value for name, value in fields.items()):
                return message

    def answer(self, command: str, **arguments: object) -> Any:
        """Send a request, and return the body of its answer."""
        number = self.ask(command, **arguments)
        message = self.until(type="response", request_seq=number)
        assert message["success"], message
        return message["body"]

    def _read(self) -> dict[str, Any]:
        length = 0
        while line := self._stream.readline().strip():
            length = int(line.rpartition(b":")[2])
        return json.loads(self._stream.read(length))


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """The example with a clause that a step of the user judges."""
    folder = tmp_path / "pickplace"
    shutil.copytree(EXAMPLES / "pickplace", folder)
    path = folder / "pickplace.bdd"
    path.write_text(path.read_text(encoding="utf-8").replace("\n        )\n", f"\n{LAMP}\n", 1), encoding="utf-8")
    (folder / "steps").mkdir()
    (folder / "steps" / "pickplace_steps.py").write_text(STEPS, encoding="utf-8")
    return path


@pytest.fixture
def debugged(model: Path) -> Iterator[tuple[subprocess.Popen[str], int]]:
    """A run that waits for a debugger, and its port."""
    port = free_port()
    command = [sys.executable, "-m", "robbdd_tools.cli", "run", str(model), "--debug", str(port), "--first", "2"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, encoding="utf-8") as process:
        yield process, port
        process.kill()


@pytest.mark.physics
def test_a_breakpoint_in_a_step_stops_every_scenario_with_its_variables(
    debugged: tuple[subprocess.Popen[str], int], model: Path
) -> None:
    process, port = debugged
    assert process.stdout is not None
    line = next(line for line in process.stdout if line.startswith("waiting"))
    assert line == f"waiting for a debugger at 127.0.0.1:{port} (Debug Adapter Protocol)\n"
    debugger = Debugger(port)
    debugger.answer("initialize", adapterID="test", pathFormat="path")
    debugger.ask("attach", justMyCode=True)
    debugger.until(type="event", event="initialized")
    source = {"path": str(model.parent / "steps" / "pickplace_steps.py")}
    debugger.answer("setBreakpoints", source=source, breakpoints=[{"line": 7}])
    debugger.ask("configurationDone")
    for _ in range(2):
        thread = debugger.until(type="event", event="stopped")["body"]["threadId"]
        (frame, *_) = debugger.answer("stackTrace", threadId=thread)["stackFrames"]
        assert (frame["name"], frame["line"], frame["source"]["path"]) == ("lamp", 7, source["path"])
        assert debugger.answer("evaluate", expression="colour", frameId=frame["id"])["result"] == "'red'"
        debugger.ask("continue", threadId=thread)
    rest = process.stdout.read()
    assert process.wait() == 1
    assert "2 scenarios: 0 hold, 2 violated, 0 unknown" in rest


def test_without_the_library_it_is_named(model: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any) -> None:
    def nothing(_: str) -> None:
        return None

    monkeypatch.setattr(debugging, "find_spec", nothing)
    assert main(["run", str(model), "--debug"]) == 2
    assert "debugging needs the package debugpy: pip install 'robbdd-tools[debug]'" in capsys.readouterr().err


def test_a_port_is_a_number(capsys: Any) -> None:
    with pytest.raises(SystemExit):
        main(["run", "m.bdd", "--debug", "70000"])
    assert "'70000' is not a port: a number from 1 to 65535" in capsys.readouterr().err
