"""Processes end with their children on POSIX, for real, and on Windows, by substitution."""

from __future__ import annotations

import ctypes
import os
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from robbdd_tools.base import processes

posix = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no POSIX signals")
NEW_GROUP, BREAK, BELOW_NORMAL = 0x200, 1, 0x4000
PARENT = """
import subprocess, sys, time
child = subprocess.Popen([sys.executable, "-c", "print(0, flush=True); import time; time.sleep(600)"])
time.sleep(600)
"""


class Recorder:
    """A process that only records requests."""

    pid = 4711

    def __init__(self) -> None:
        self.calls: list[str] = []

    def terminate(self) -> None:
        self.calls.append("terminate")

    def kill(self) -> None:
        self.calls.append("kill")


@pytest.fixture
def windows(monkeypatch: pytest.MonkeyPatch) -> pytest.MonkeyPatch:
    """What the module would find on Windows."""
    monkeypatch.setattr(sys, "platform", "win32")
    monkeypatch.setattr(subprocess, "CREATE_NEW_PROCESS_GROUP", NEW_GROUP, raising=False)
    monkeypatch.setattr(subprocess, "BELOW_NORMAL_PRIORITY_CLASS", BELOW_NORMAL, raising=False)
    monkeypatch.setattr(signal, "CTRL_BREAK_EVENT", BREAK, raising=False)
    monkeypatch.delattr(os, "killpg", raising=False)
    monkeypatch.delattr(os, "nice", raising=False)
    return monkeypatch


@posix
def test_the_children_of_a_group_end_with_their_leader() -> None:
    command = [sys.executable, "-c", PARENT]
    with subprocess.Popen(command, stdout=subprocess.PIPE, start_new_session=True) as leader:
        assert leader.stdout is not None
        leader.stdout.readline()
        processes.end_group(leader)
        assert leader.stdout.read() == b"", "the output ends when the last process that holds it has ended"
        assert processes.describe_exit(leader.wait()) == "signal SIGKILL (often: memory ran out)"
        processes.end_group(leader)


@posix
def test_a_new_group_is_not_that_of_its_parent() -> None:
    print_group = [sys.executable, "-c", "import os; print(os.getpgrp() == os.getpid())"]
    with subprocess.Popen(print_group, stdout=subprocess.PIPE, **processes.own_group()) as leader:
        assert leader.communicate()[0] == b"True\n"


@posix
def test_a_process_hears_that_it_is_to_end() -> None:
    code = (
        "import os, time\nfrom robbdd_tools.base.processes import on_end_request\n"
        "on_end_request(lambda number: os._exit(100 + number))\nprint(flush=True)\ntime.sleep(600)"
    )
    command = [sys.executable, "-c", code]
    with subprocess.Popen(command, stdout=subprocess.PIPE, start_new_session=True) as process:
        assert process.stdout is not None
        process.stdout.readline()
        processes.request_end(process)
        assert process.wait() == 100 + signal.SIGTERM


@posix
def test_background_work_yields_to_all_other_processes() -> None:
    code = "import os\nfrom robbdd_tools.base.processes import lower_priority\nlower_priority()\nprint(os.nice(0))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert int(done.stdout) == min(19, os.nice(0) + processes.NICENESS)


def test_windows_gives_a_process_a_group_of_its_own(windows: pytest.MonkeyPatch) -> None:
    assert windows
    assert processes.own_group() == {"creationflags": NEW_GROUP}


def test_windows_asks_by_ctrl_break_and_ends_what_has_no_console(windows: pytest.MonkeyPatch) -> None:
    sent: list[tuple[int, int]] = []

    def kill(pid: int, number: int) -> None:
        sent.append((pid, number))

    windows.setattr(os, "kill", kill)
    process = Recorder()
    processes.request_end(process)
    assert (sent, process.calls) == ([(process.pid, BREAK)], [])

    def without_console(*_: int) -> None:
        raise OSError("the handle is invalid")

    windows.setattr(os, "kill", without_console)
    processes.request_end(process)
    assert process.calls == ["terminate"]


@pytest.mark.parametrize(("code", "calls"), [(0, []), (128, ["kill"]), (None, ["kill"])])
def test_windows_ends_the_whole_tree_or_at_least_its_root(
    windows: pytest.MonkeyPatch, code: int | None, calls: list[str]
) -> None:
    commands: list[list[str]] = []

    def run(command: list[str], **_: Any) -> SimpleNamespace:
        commands.append(command)
        if code is None:
            raise FileNotFoundError(command[0])
        return SimpleNamespace(returncode=code)

    windows.setattr(subprocess, "run", run)
    process = Recorder()
    processes.end_group(process)
    assert (commands, process.calls) == ([["taskkill", "/pid", "4711", "/t", "/f"]], calls)


def test_windows_hears_ctrl_break(windows: pytest.MonkeyPatch) -> None:
    handlers: dict[int, Any] = {}
    windows.setattr(signal, "SIGBREAK", 21, raising=False)
    windows.setattr(signal, "signal", handlers.__setitem__)
    heard: list[int] = []
    processes.on_end_request(heard.append)
    assert set(handlers) == {signal.SIGINT, signal.SIGTERM, 21}
    handlers[21](21, None)
    assert heard == [21]


def test_windows_lowers_the_priority_class(windows: pytest.MonkeyPatch) -> None:
    asked: list[tuple[int, int]] = []

    def set_class(process: int, priority: int) -> None:
        asked.append((process, priority))

    kernel = SimpleNamespace(GetCurrentProcess=lambda: -1, SetPriorityClass=set_class)
    windows.setattr(ctypes, "windll", SimpleNamespace(kernel32=kernel), raising=False)
    processes.lower_priority()
    assert asked == [(-1, BELOW_NORMAL)]


@pytest.mark.parametrize(
    ("code", "words"),
    [
        (7, "code 7"),
        (-11, "signal SIGSEGV"),
        (-4711, "signal 4711"),
        (0xC0000005, "code 0xC0000005 (access violation)"),
        (0xC0009999, "code 0xC0009999 (ended by Windows)"),
    ],
)
def test_an_exit_code_in_words(code: int, words: str) -> None:
    assert processes.describe_exit(code) == words


@posix
def test_a_program_that_takes_too_long_is_ended_with_its_children(tmp_path: Path) -> None:
    ending = processes.run_for(0.5, [sys.executable, "-c", PARENT], tmp_path)
    assert ending.code is None


def test_a_program_reads_and_writes(tmp_path: Path) -> None:
    code = "import sys; print(sys.stdin.read().upper()); print('é', file=sys.stderr); sys.exit(3)"
    environment = {**os.environ, "PYTHONUTF8": "1"}
    ending = processes.run_for(60, [sys.executable, "-c", code], tmp_path, environment, "text")
    assert ending == processes.Ending(3, "TEXT\n", "é\n")


@posix
def test_a_process_cannot_use_more_processor_time_than_it_has_set() -> None:
    code = "from robbdd_tools.base.processes import limit_processor_time as f; f(1)\nwhile True: pass"
    assert subprocess.run([sys.executable, "-c", code]).returncode == -signal.SIGXCPU
