"""A Dask scheduler and workers as processes of this machine."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from collections.abc import Generator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from time import sleep

PRELOAD = Path(__file__).with_name("quick_worker.py")
TESTS = Path(__file__).parents[1]


class DaskProcesses:
    """A scheduler and workers, each a process of its own."""

    def __init__(self, folder: Path, stack: ExitStack, pause: float) -> None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self._port = int(free.getsockname()[1])
        self._folder, self._stack = folder, stack
        self._environment = {**os.environ, "PYTHONPATH": str(TESTS), "ROBBDD_PAUSE": str(pause)}
        self.address = f"tcp://127.0.0.1:{self._port}"
        self.scheduler = self.start_scheduler()
        self.workers: list[subprocess.Popen[bytes]] = []

    def start_scheduler(self) -> subprocess.Popen[bytes]:
        """Start a scheduler, and wait until it can be connected to: on a busy machine that takes many seconds."""
        started = self._start("scheduler", "--host", "127.0.0.1", "--port", str(self._port), "--no-dashboard")
        while started.poll() is None:
            with suppress(OSError), socket.create_connection(("127.0.0.1", self._port)):
                break
            sleep(0.05)
        return started

    def start_worker(self, *, quick: bool = True) -> None:
        preload = ["--preload", str(PRELOAD)] if quick else []
        own = ["--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", str(self._folder)]
        self.workers.append(self._start("worker", self.address, *own, *preload))

    def _start(self, name: str, *arguments: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", "distributed.cli.dask_" + name, *arguments]
        log = self._stack.enter_context((self._folder / f"{name}.log").open("ab"))
        process = subprocess.Popen(command, env=self._environment, stdout=log, stderr=log)
        self._stack.callback(process.wait)
        self._stack.callback(process.kill)
        return process


@contextmanager
def dask_processes(folder: Path, workers: int, pause: float = 0.0) -> Generator[DaskProcesses]:
    folder.mkdir(exist_ok=True)
    with ExitStack() as stack:
        made = DaskProcesses(folder, stack, pause)
        for _ in range(workers):
            made.start_worker()
        yield made
