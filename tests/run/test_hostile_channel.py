"""Users' code that writes to the agent's message channel, prints endlessly or leaves processes running."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from robbdd_tools.base.processes import run_for
from robbdd_tools.protocol.messages import LogLine, RunFinished
from robbdd_tools.run.launch import LOGS, MAX_STRANGE_LINES
from robbdd_tools.run.run_policy import Policy
from run.test_scheduler import HOLDS, prepared, reasons_without_places, run, verdicts

pytestmark = [pytest.mark.physics, pytest.mark.skipif(sys.platform != "linux", reason="/proc")]
USER_STEPS = r"""
import os, signal, subprocess, sys
from behave import given

def pipes():
    for name in os.listdir("/proc/self/fd"):
        try:
            if int(name) > 2 and os.readlink(f"/proc/self/fd/{name}").startswith("pipe:"):
                yield int(name)
        except OSError:
            pass

def send(data):
    for descriptor in pipes():
        try:
            left = data
            while left:
                left = left[os.write(descriptor, left):]
        except OSError:
            pass

FOREIGN = [
    b"\xff\xfe\x00 no UTF-8\n",
    b"[" * 200000 + b"\n",
    b"x" * 3_000_000 + b"\n",
    b'{"type": "ScenarioFinished", "index": 1000000000, "simulated": 0, "wall": 0, "stepping": 0}\n',
    b'{"type": "ScenarioFinished", "index": -1, "simulated": 0, "wall": 0, "stepping": 0}\n',
    b'{"type": "ScenarioFinished", "index": 1, "simulated": NaN, "wall": 1e999, "stepping": 0}\n',
    b'{"type": "ScenarioFinished", "index": "1", "simulated": 0, "wall": 0, "stepping": 0}\n',
    b'{"type": "ScenarioFinished", "index": 2, "simulated": 0, "wall": 0, "stepping": 0}\n',
    b'{"type": "ScenarioStarted", "index": 2}\n',
    b'{"type": "ClauseJudged", "index": 2, "line": 5, "verdict": "holds", "robustness": 1, "unit": "m", "at": null,'
    b' "reason": ""}\n',
    b'{"type": "ClauseJudged", "index": 1, "line": 99999, "verdict": "holds", "robustness": 1, "unit": "m",'
    b' "at": null, "reason": ""}\n',
    b'{"type": "LogLine", "level": 1, "text": []}\n',
    b'{"type": "RunFinished", "ok": true}\n',
    b"\n" * 1000,
    b"no message\n" * 1000,
    b'{"type": "ScenarioFin',
]

@given("foreign messages")
def foreign(context):
    for data in FOREIGN:
        send(data)

@given("an endless stream of messages")
def endless(context):
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTERM, signal.SIGINT})
    while True:
        send(b'{"type": "ScenarioStarted", "index": 1}\n' * 100)

@given("much output")
def much(context):
    os.write(1, b"first\n")
    for _ in range(2000):
        os.write(1, b"o" * 9_999 + b"\n")
    subprocess.run([sys.executable, "-c", "print('of a program')"], check=True)
    os.write(2, b"last\n")

@given("an empty input")
def empty(context):
    assert sys.stdin.read() == ""
    subprocess.run(["cat"], check=True, timeout=60)

def note(pid):
    with open(os.environ["ROBBDD_TEST_PIDS"], "a") as file:
        file.write(f"{pid}\n")

def leave(env=None):
    sleep = "import signal\nsignal.signal(signal.SIGTERM, signal.SIG_IGN)\nsignal.pause()"
    note(subprocess.Popen([sys.executable, "-c", sleep]).pid)
    note(subprocess.Popen([sys.executable, "-c", sleep], start_new_session=True, env=env).pid)
    if os.fork() == 0:
        os.setsid()
        pid = os.fork()
        if pid:
            note(pid)
            os._exit(0)
        while True:
            signal.pause()
    os.wait()

@given("processes left behind")
def leaves(context):
    leave({})

@given("processes left behind at an exit")
def leaves_and_ends(context):
    leave()
    os._exit(7)

@given("nothing left")
def nothing(context):
    for pid in map(int, open(os.environ["ROBBDD_TEST_PIDS"])):
        try:
            os.kill(pid, 0)
        except ProcessLookupError:
            continue
        raise AssertionError(f"{pid} is alive")
"""


def test_foreign_messages_cost_nothing(tmp_path: Path) -> None:
    manifest = prepared(tmp_path / "run", [HOLDS], [("given", "foreign messages"), HOLDS], [HOLDS], user=USER_STEPS)
    results, messages, ending = run(tmp_path / "run", manifest, Policy(1))
    assert (verdicts(results), results.complete, ending) == (["holds"] * 3, True, "")
    assert messages[-1] == RunFinished(True)
    logged = [message.text for message in messages if isinstance(message, LogLine)]
    assert any("no UTF-8" in text for text in logged)
    assert "ignored ScenarioFinished of scenario 1000000000, which the agent does not execute" in logged
    assert "ignored ClauseJudged of line 99999, where scenario 1 has no clause" in logged
    assert "ignored RunFinished within a scenario" in logged
    assert sum("not a run message" in text for text in logged) <= MAX_STRANGE_LINES
    assert max(map(len, logged)) < 1000


def test_an_endless_stream_of_messages_is_timed_out(tmp_path: Path) -> None:
    manifest = prepared(
        tmp_path / "run", [HOLDS], [HOLDS, ("given", "an endless stream of messages")], [HOLDS], user=USER_STEPS
    )
    results, _, _ = run(tmp_path / "run", manifest, Policy(1, timeout=5.0))
    assert verdicts(results) == ["holds", "unknown", "holds"]
    assert reasons_without_places(results, 1) == {"", "model_steps:endless failed: timed out after 5 s"}


def test_much_output_is_kept_from_its_beginning_and_its_end(tmp_path: Path) -> None:
    manifest = prepared(tmp_path / "run", [("given", "much output"), ("given", "an empty input")], user=USER_STEPS)
    results, _, _ = run(tmp_path / "run", manifest, Policy(1, log_limit=100_000))
    assert verdicts(results) == ["holds"]
    log = (tmp_path / "run" / LOGS / "agent-1.log").read_text(encoding="utf-8")
    assert log.startswith("first\nooo")
    assert log.endswith("of a program\nlast\n")
    assert "bytes left out" in log
    assert len(log.encode()) < 100_200


@pytest.fixture
def pids(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    path = tmp_path / "pids"
    monkeypatch.setenv("ROBBDD_TEST_PIDS", str(path))
    return path


def is_running(pid: int) -> bool:
    stat = Path(f"/proc/{pid}/stat")
    return stat.exists() and stat.read_text().rpartition(")")[2].split()[0] != "Z"


def test_processes_left_behind_end_with_their_scenario(tmp_path: Path, pids: Path) -> None:
    manifest = prepared(
        tmp_path / "run", [("given", "processes left behind")], [("given", "nothing left")], user=USER_STEPS
    )
    results, _, _ = run(tmp_path / "run", manifest, Policy(1))
    assert verdicts(results) == ["holds", "holds"]
    assert len(pids.read_text().split()) == 3


def test_processes_left_behind_end_with_their_agent(tmp_path: Path, pids: Path) -> None:
    manifest = prepared(tmp_path / "run", [("given", "processes left behind at an exit")], [HOLDS], user=USER_STEPS)
    results, _, _ = run(tmp_path / "run", manifest, Policy(1))
    assert verdicts(results) == ["unknown", "holds"]
    (reason,) = reasons_without_places(results, 0)
    assert reason.endswith(" failed: the process ended with code 7")
    left = list(map(int, pids.read_text().split()))
    assert len(left) == 3
    assert not any(map(is_running, left))


def test_the_helpers_of_other_programs_are_left_alone(tmp_path: Path) -> None:
    code = (
        "import subprocess, sys\n"
        "from robbdd_tools.base.descendants import end_marked\n"
        "child = subprocess.Popen([sys.executable, '-c', 'input()'], stdin=subprocess.PIPE)\n"
        "end_marked('another')\n"
        "print(child.poll())\n"
        "child.communicate(b'\\n')\n"
    )
    environment = {**os.environ, "ROBBDD_AGENT": "mine"}
    assert run_for(60, [sys.executable, "-c", code], tmp_path, environment).output == "None\n"
