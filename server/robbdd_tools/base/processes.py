"""End processes together with their children, on POSIX and on Windows.

No other module uses the signals, process groups and priorities of operating systems.
"""

from __future__ import annotations

import ctypes
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol, TypedDict

END_SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK")
"""Signals that ask a program to end. A system may lack some of them."""
CTRL_C: int = signal.SIGINT
"""The signal that Ctrl-C sends."""
NICENESS = 10
"""POSIX niceness of background work: it yields to the editor, but still makes progress."""
WINDOWS_ERRORS = {
    0xC0000005: "access violation",
    0xC0000017: "out of memory",
    0xC00000FD: "stack overflow",
    0xC0000409: "stack buffer overrun",
    0xC000013A: "interrupted by Ctrl-C",
}
"""Windows exit codes of crashed processes, from ``ntstatus.h``."""
_MIN_ERROR = 0xC0000000


class RunningProcess(Protocol):
    """The interface that ``subprocess.Popen`` and ``asyncio.subprocess.Process`` have in common."""

    @property
    def pid(self) -> int:
        """The id of the process. On POSIX, it is also the id of the process group that the process leads."""
        ...

    def terminate(self) -> None:
        """Send SIGTERM on POSIX; on Windows, end the process immediately."""
        ...

    def kill(self) -> None:
        """End the process at once."""
        ...


class GroupArguments(TypedDict, total=False):
    """Arguments of ``Popen``."""

    creationflags: int
    start_new_session: bool


def own_group() -> GroupArguments:
    """Return arguments of ``Popen`` with which the new process becomes the leader of a process group.

    Ctrl-C in a terminal then reaches only the parent, which can stop its children one by one.
    """
    if sys.platform == "win32":
        return {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP}
    return {"start_new_session": True}


@dataclass(frozen=True, slots=True)
class Ending:
    """The output of a program and its exit code. ``code`` is ``None`` if the program had to be killed."""

    code: int | None
    output: str
    errors: str


def run_for(
    seconds: float, command: Sequence[str], folder: Path, environment: Mapping[str, str] | None = None, sent: str = ""
) -> Ending:
    """Run a program in ``folder`` with ``sent`` as input. Raises ``OSError``.

    After ``seconds``, the program is ended together with its children.
    """
    pipe = subprocess.PIPE
    with subprocess.Popen(
        command,
        stdin=pipe,
        stdout=pipe,
        stderr=pipe,
        cwd=folder,
        env=environment,
        encoding="utf-8",
        errors="replace",
        **own_group(),
    ) as process:
        try:
            output, errors = process.communicate(sent, seconds)
        except subprocess.TimeoutExpired:
            end_group(process)
            return Ending(None, *process.communicate())
    return Ending(process.returncode, output, errors)


def request_end(process: RunningProcess) -> None:
    """Ask the leader of a process group to end. The process can react by ``on_end_request``."""
    with suppress(OSError):
        if sys.platform == "win32":
            try:
                os.kill(process.pid, signal.CTRL_BREAK_EVENT)
            except OSError:
                # Console events need a console.
                process.terminate()
        else:
            process.terminate()


def end_group(process: RunningProcess) -> None:
    """Kill the leader of a group and its children."""
    with suppress(OSError):
        if sys.platform == "win32":
            # Windows finds children through their parent, so the tree must be ended before its root.
            command = ["taskkill", "/pid", str(process.pid), "/t", "/f"]
            try:
                ended = subprocess.run(command, capture_output=True, check=False).returncode == 0
            except OSError:
                ended = False
            if not ended:
                process.kill()
        else:
            os.killpg(process.pid, signal.SIGKILL)


def on_end_request(handle: Callable[[int], None]) -> None:
    """Call ``handle`` with the signal number when this process is asked to end. Use it in the main thread only."""
    for name in ("SIGINT", "SIGTERM", "SIGBREAK"):
        number: int | None = getattr(signal, name, None)
        if number is not None:
            signal.signal(number, lambda received, _: handle(received))


@contextmanager
def end_requests(handle: Callable[[int], None]) -> Generator[None]:
    """Within the block, call ``handle`` with the signal number when this process is asked to end.

    Requests are, for example, Ctrl-C and the closing of the terminal. Signals that the parent made this process ignore
    (``nohup``) stay ignored. Outside of the main thread, this has no effect.
    """
    before: dict[int, Any] = {}
    if threading.current_thread() is threading.main_thread():
        for name in END_SIGNALS:
            number: int | None = getattr(signal, name, None)
            if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
                before[number] = signal.signal(number, lambda received, _: handle(received))
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def lower_priority() -> None:
    """Lower the scheduling priority of this process."""
    if sys.platform == "win32":
        kernel = ctypes.windll.kernel32
        kernel.SetPriorityClass(kernel.GetCurrentProcess(), subprocess.BELOW_NORMAL_PRIORITY_CLASS)
    else:
        os.nice(NICENESS)


def limit_memory(largest: int) -> None:
    """Limit the address space of this process to ``largest`` bytes. Beyond it, Python raises ``MemoryError``.

    Windows and macOS have no such limit.
    """
    if sys.platform != "win32":
        import resource

        _, most = resource.getrlimit(resource.RLIMIT_AS)
        if most == resource.RLIM_INFINITY or largest < most:
            with suppress(OSError, ValueError):  # macOS refuses a limit below the current use
                resource.setrlimit(resource.RLIMIT_AS, (largest, most))


def limit_processor_time(seconds: int) -> None:
    """End this process after ``seconds`` of processor time, even in the middle of work. Windows has no such limit."""
    if sys.platform != "win32":
        import resource

        _, most = resource.getrlimit(resource.RLIMIT_CPU)
        if most == resource.RLIM_INFINITY or seconds < most:
            resource.setrlimit(resource.RLIMIT_CPU, (seconds, most))


def describe_exit(code: int) -> str:
    """Return an exit code of ``Popen`` as text: ``code 7``, ``signal SIGKILL`` or ``code 0xC0000005 (…)``."""
    if code < 0:
        known = {each.value: each.name for each in signal.Signals}
        hint = " (often: memory ran out)" if known.get(-code) == "SIGKILL" else ""
        return f"signal {known.get(-code, -code)}{hint}"
    if code >= _MIN_ERROR:
        return f"code 0x{code:X} ({WINDOWS_ERRORS.get(code, 'ended by Windows')})"
    return f"code {code}"
