"""Starts the agent process, streams its messages, stops it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

from robbdd_tools.run.protocol import LogLine, RunMessage, decode

LOG = "agent.log"
PATIENCE = 0.4
"""Seconds that the agent has to end by itself when it is told to stop."""


class Agent:
    """One agent process working on one run folder. ``cancel`` may be called from any thread."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.cancelled = False
        self._lock = threading.Lock()
        with (folder / LOG).open("wb") as log:
            # Its own session: Ctrl-C in a terminal reaches the parent, which then stops the agent in good order.
            self._process = subprocess.Popen(
                [sys.executable, "-m", "robbdd_tools.agent", str(folder)],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=log,
                text=True,
                encoding="utf-8",
                start_new_session=True,
            )

    def messages(self) -> Iterator[RunMessage]:
        """Yield the messages as they come until the process ends; a line that is no message becomes a log line."""
        assert self._process.stdout is not None
        for line in self._process.stdout:
            try:
                yield decode(line)
            except ValueError:
                yield LogLine("warning", line.rstrip())
        self._process.wait()

    def cancel(self) -> None:
        """Stop the process; its open clauses stay unjudged."""
        with self._lock:
            if self._process.poll() is None:
                self.cancelled = True
                self._process.terminate()
                try:
                    self._process.wait(PATIENCE)
                except subprocess.TimeoutExpired:
                    self._kill()

    def _kill(self) -> None:
        if hasattr(os, "killpg"):
            os.killpg(self._process.pid, signal.SIGKILL)
        else:
            self._process.kill()

    def ending(self) -> str:
        """Say how the process ended, for clauses that it left open."""
        if self.cancelled:
            return "the run was cancelled"
        code = self._process.poll()
        tail = self._last_log_line()
        return f"the agent process ended unexpectedly with code {code}" + (f": {tail}" if tail else "")

    def _last_log_line(self) -> str:
        try:
            lines = (self.folder / LOG).read_text(encoding="utf-8", errors="replace").split("\n")
        except OSError:
            return ""
        return next((line.strip() for line in reversed(lines) if line.strip()), "")
