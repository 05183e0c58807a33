"""Forks processes that have the product's modules loaded, until standard input ends.

What a test starts through ``launch.py`` is a process of its own, as if an interpreter had started, but without the
half second of processor time that importing takes.
"""

from __future__ import annotations

import atexit
import gc
import json
import os
import selectors
import shutil
import signal
import socket
import struct
import sys
import threading
from contextlib import redirect_stdout, suppress
from dataclasses import dataclass
from importlib import import_module
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NoReturn
from unittest.mock import patch

from pygls.lsp._base_server import BaseLanguageServer

from fork_server.converter import compile_all, shared_converter
from fork_server.launch import LENGTH, STATUS
from fork_server.launching import STARTED_BY, WORKER_STARTED_BY, interpreter_command, worker_command

EXAMPLE = Path(__file__).parents[2] / "examples" / "pickplace"
LOADED = (
    "behave.parser",
    "hypothesis.internal.observability",
    "numpy",
    "pytest",
    "pytest_lsp",
    "xdist.plugin",
    "xdist.remote",
    "robbdd_tools.agent.execute_requests",
    "robbdd_tools.agent.runner",
    "robbdd_tools.cli",
    "robbdd_tools.lsp.handlers",
    "robbdd_tools.lsp.main",
    "robbdd_tools.lsp.rejudging",
    "robbdd_tools.lsp.worker",
    "robbdd_tools.pytest_plugin.scenario_nodes",
    "robbdd_tools.pytest_plugin.session_hooks",
    "robbdd_tools.world.fixed_faults",
    "robbdd_tools.world.overlaps",
    *(f"robbdd_tools.commands.{name}" for name in ("check", "export", "gherkin", "models", "query", "run", "runs")),
)


@dataclass(frozen=True)
class Request:
    """What a fork is to run, and where."""

    arguments: list[str]
    environment: dict[str, str]
    umask: int
    descriptors: list[int]
    """Standard input, output and error output, and the working directory."""


@dataclass(frozen=True)
class Fork:
    """A running fork: its number, its descriptor and the connection of its launcher."""

    pid: int
    descriptor: int
    connection: socket.socket


def serve(address: str) -> Request | None:
    """Fork for every connection; returns the request in a fork, ``None`` in the server when standard input ends."""
    listener = socket.socket(socket.AF_UNIX)
    listener.bind(address)
    listener.listen(64)
    print("ready", flush=True)
    with selectors.DefaultSelector() as selector:
        selector.register(0, selectors.EVENT_READ)
        selector.register(listener, selectors.EVENT_READ)
        while True:
            for key, _ in selector.select():
                fork: Fork | None = key.data
                if key.fileobj == 0:
                    _end_all(selector)
                    return None
                if fork is None:
                    connection, _ = listener.accept()
                    request = _read(connection)
                    if request is None:
                        connection.close()
                        continue
                    try:
                        pid = os.fork()
                    except OSError as error:  # no memory or no process left: this costs one launcher, not the server
                        print(f"the fork server cannot fork: {error}", file=sys.stderr)
                        pid = None
                    if pid == 0:
                        return request
                    for descriptor in request.descriptors:
                        os.close(descriptor)
                    if pid is None:
                        connection.close()
                        continue
                    fork = Fork(pid, os.pidfd_open(pid), connection)
                    selector.register(connection, selectors.EVENT_READ, fork)
                    selector.register(fork.descriptor, selectors.EVENT_READ, fork)
                elif key.fd == fork.descriptor:
                    _report(selector, fork)
                elif fork.connection.fileno() >= 0:  # not closed by a report in this very round
                    _forward(selector, fork)


def _read(connection: socket.socket) -> Request | None:
    """Read a request; return ``None`` if the launcher was killed in the meantime."""
    descriptors: list[int] = []
    try:
        head, descriptors, _, _ = socket.recv_fds(connection, LENGTH.size, 4)
        (length,) = LENGTH.unpack(head)
        fields: dict[str, Any] = json.loads(connection.recv(length, socket.MSG_WAITALL))
    except (ConnectionError, struct.error, ValueError):
        for descriptor in descriptors:
            os.close(descriptor)
        return None
    return Request(**fields, descriptors=descriptors)


def _report(selector: selectors.BaseSelector, fork: Fork) -> None:
    """Return the status of a fork that has ended to its launcher."""
    _, status = os.waitpid(fork.pid, 0)
    selector.unregister(fork.descriptor)
    os.close(fork.descriptor)
    with suppress(KeyError):
        selector.unregister(fork.connection)
    with suppress(OSError):
        fork.connection.sendall(STATUS.pack(os.waitstatus_to_exitcode(status)))
    fork.connection.close()


def _forward(selector: selectors.BaseSelector, fork: Fork) -> None:
    """Send the signals that the launcher got; kill the fork when the launcher is gone."""
    try:
        numbers = fork.connection.recv(16)
    except ConnectionResetError:
        numbers = b""
    if not numbers:
        selector.unregister(fork.connection)
    for number in numbers or [signal.SIGKILL]:
        os.kill(fork.pid, number)


def _end_all(selector: selectors.BaseSelector) -> None:
    for key in list(selector.get_map().values()):
        if isinstance(key.data, Fork):
            os.kill(key.data.pid, signal.SIGKILL)


def become(request: Request) -> None:
    """Make this fork look like an interpreter that was just started by the launcher."""
    os.setsid()
    *streams, folder = request.descriptors
    os.fchdir(folder)
    for target, stream in enumerate(streams):
        os.dup2(stream, target)
    os.closerange(3, os.sysconf("SC_OPEN_MAX"))
    os.environ.clear()
    os.environ.update(request.environment)
    os.umask(request.umask)
    del sys.path[0]  # the folder of the tests
    sys.argv = ["-c", *request.arguments[1:]]
    sys.stdin = sys.__stdin__ = os.fdopen(0, encoding="utf-8", errors="surrogateescape")
    sys.stdout = sys.__stdout__ = os.fdopen(1, "w", encoding="utf-8", errors="surrogateescape")
    sys.stderr = sys.__stderr__ = os.fdopen(2, "w", buffering=1, encoding="utf-8", errors="backslashreplace")


def warm_up() -> None:
    """Fill the caches that depend on the installation alone, such as its shapes and grammars."""
    from robbdd_tools.cli import main

    with TemporaryDirectory() as folder, redirect_stdout(StringIO()):
        model = str(shutil.copytree(EXAMPLE, Path(folder, "model")) / "pickplace.bdd")
        main(["check", model])
        main(["gherkin", model, "-o", str(Path(folder, "features"))])


def code_of_fork(address: str) -> str | None:
    """Serve until standard input ends. In the server, return ``None``; in a fork, return the code that it is to run."""
    # As in an agent: what it executes needs no graphics.
    with patch.dict(os.environ, MUJOCO_GL="disable"):
        for name in LOADED:
            import_module(name)
    warm_up()
    # What a fork starts is a fork, too: agents, the processes of a language server, workers of pytest.
    patch(STARTED_BY, interpreter_command(address)).start()
    patch(WORKER_STARTED_BY, worker_command(address)).start()
    compile_all()
    # The converter is the second argument that has a default.
    defaults = BaseLanguageServer.__init__.__defaults__
    assert defaults is not None
    protocol, _, *others = defaults
    patch.object(BaseLanguageServer.__init__, "__defaults__", (protocol, shared_converter, *others)).start()
    # What is loaded is not collected again in each fork.
    gc.collect()
    gc.freeze()
    request = serve(address)
    if request is None:
        return None
    become(request)
    return request.arguments[0]


def end_fork(code: object) -> NoReturn:
    """End a fork as the interpreter does, but without taking down each module.

    That would copy most of the memory that the fork shares with the server: a tenth of a second of processor time.

    Args:
        code: that of ``SystemExit``: a status, ``None`` for success, or anything else to print as an error.
    """
    if code is not None and not isinstance(code, int):
        print(code, file=sys.stderr)
        code = 1
    # In the order of the interpreter: wait for threads, call the functions of atexit, flush. The first two are private.
    threading._shutdown()  # pyright: ignore[reportAttributeAccessIssue, reportUnknownMemberType]
    atexit._run_exitfuncs()  # pyright: ignore[reportPrivateUsage]
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError):
            stream.flush()
    os._exit((code or 0) & 0xFF)
