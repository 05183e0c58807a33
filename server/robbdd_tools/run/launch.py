"""Start agent processes, send them orders, read their messages and stop them."""

from __future__ import annotations

import itertools
import os
import threading
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from io import TextIOWrapper
from pathlib import Path
from subprocess import TimeoutExpired
from time import monotonic
from typing import BinaryIO, cast

from robbdd_tools.base.descendants import MARK, end_marked
from robbdd_tools.base.interpreter import start
from robbdd_tools.base.processes import describe_exit, end_group, request_end
from robbdd_tools.protocol.messages import Execute, LogLine, RunMessage, decode, encode
from robbdd_tools.protocol.run_folder import CRASH, DEBUG_PORT, PAUSING
from robbdd_tools.protocol.run_folder import LIMIT as TIME_LIMIT
from robbdd_tools.run.agent_log import LIMIT, BoundedLog
from robbdd_tools.run.crashes import Crash, take_crash

LOGS = "logs"
WORK = "work"
"""Agents' working directory in the run folder: files written by users' code are kept with the run."""
MESSAGE_BEGIN = '{"type": '
"""First characters of every message of ``encode``. Inside a string, its quotes would be escaped."""
LONGEST = 1024 * 1024
"""Maximum bytes of a line on the message channel."""
MAX_STRANGE_LINES = 20
"""A run reports at most this many lines of each process that are not messages."""
PATIENCE = 0.2
"""Seconds that agents have to stop by themselves."""
_numbers = itertools.count(1)


class Agent:
    """One agent process of a run folder.

    ``number`` names the log of the process. ``module`` is the Python module to run, and ``arguments`` are its arguments
    after the run folder. ``log_limit`` is the maximum size of the log in bytes. With ``debug``, the process waits for a
    debugger on this port. With ``pausing``, it obeys the orders of a debugger (``protocol.pauses``).
    """

    def __init__(
        self,
        folder: Path,
        number: int = 1,
        module: str = "robbdd_tools.agent",
        arguments: Sequence[str] = (),
        log_limit: int = LIMIT,
        timeout: float = 0.0,
        debug: int | None = None,
        pausing: bool = False,
    ) -> None:
        folder = folder.absolute()
        self._work = folder / WORK
        self._work.mkdir(exist_ok=True)
        (folder / LOGS).mkdir(exist_ok=True)
        self._log = BoundedLog(folder / LOGS / f"agent-{number}.log", log_limit)
        self._mark = f"{os.getpid()}-{next(_numbers)}"
        self._base = folder / LOGS / f"agent-{number}"
        self._ordering = threading.Lock()
        self.crash = Crash()
        """Position of the process in the user's code when it ended, available after its last message."""
        more = {MARK: self._mark, CRASH: str(self._base), TIME_LIMIT: str(timeout)}
        if debug is not None:
            more[DEBUG_PORT] = str(debug)
        if pausing:
            more[PAUSING] = "1"
        with self._log.stream as log:
            self._process = start(module, str(folder), *arguments, folder=self._work, log=log, more=more)
        self._leftovers = threading.Thread(target=self._end_leftovers, daemon=True)
        self._leftovers.start()

    @property
    def pid(self) -> int:
        """The process id."""
        return self._process.pid

    def execute(self, index: int) -> None:
        """Order the agent to execute the scenario number ``index``. If the agent has ended, ``messages`` ends, too."""
        self.order(encode(Execute(index)))

    def order(self, line: str) -> None:
        """Send an order of one line, from any thread. If the process has ended, ``messages`` ends, too."""
        assert self._process.stdin is not None
        try:
            with self._ordering:
                self._process.stdin.write(line + "\n")
                self._process.stdin.flush()
        except (OSError, ValueError):  # the pipe is broken or already closed
            pass

    def messages(self) -> Iterator[RunMessage]:
        """Yield the agent's messages as they arrive until the process ends.

        A line that is no message becomes a log message.
        """
        strange = 0
        for line in _lines(cast(BinaryIO, cast(TextIOWrapper, self._process.stdout).buffer)):
            try:
                yield _decoded(line)
            except ValueError as error:
                strange += 1
                if strange <= MAX_STRANGE_LINES:
                    yield LogLine("warning", str(error))
        self._process.wait()
        self.crash = take_crash(self._base, self._work)
        self._close()

    def _close(self) -> None:
        """Close the file descriptors of an ended process, because this object may live longer than the process."""
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                with suppress(OSError):
                    pipe.close()

    def kill(self) -> None:
        """Kill the process and its children immediately."""
        if self._process.poll() is None:
            end_group(self._process)

    def ending(self) -> str:
        """Describe how the process ended. The text becomes the reason of the clauses that the process left open."""
        self._log.wait(PATIENCE)
        tail = self._log.last_line()
        return f"the agent process ended unexpectedly with {self.exit()}" + (f": {tail}" if tail else "")

    def exit(self) -> str:
        """Return the exit code of the ended process as text."""
        return describe_exit(self._process.wait())

    def terminate(self) -> None:
        """Ask the process to end now."""
        if self._process.poll() is None:
            request_end(self._process)

    def finish(self) -> None:
        """Kill remaining child processes and complete the log."""
        self._leftovers.join(PATIENCE)
        self._log.wait(PATIENCE)

    def wait(self, seconds: float) -> None:
        """Wait at most ``seconds`` for the process to end."""
        with suppress(TimeoutExpired):
            self._process.wait(max(0.0, seconds))

    def _end_leftovers(self) -> None:
        """Kill the child processes that outlive the agent, because they may hold the channel and the log open."""
        self._process.wait()
        end_group(self._process)
        end_marked(self._mark)


def _decoded(line: str) -> RunMessage:
    """Return the message that a line contains. Split off text that other code printed before it on the same line."""
    try:
        return decode(line)
    except ValueError:
        begin = line.rfind(MESSAGE_BEGIN)
        if begin <= 0:
            raise
        return decode(line[begin:])


def _lines(stream: BinaryIO) -> Iterator[str]:
    """Yield the non-empty lines of a stream. Each line is cut at the maximum length."""
    while part := stream.readline(LONGEST + 1):
        rest = part
        while len(rest) > LONGEST and not rest.endswith(b"\n"):
            rest = stream.readline(LONGEST + 1)
        if part.strip():
            yield part.decode("utf-8", "backslashreplace").rstrip("\n")


def stop(agents: Iterable[Agent]) -> None:
    """Ask all agent processes to end, and kill those that have not ended after ``PATIENCE`` seconds."""
    stopping = list(agents)
    for agent in stopping:
        agent.terminate()
    deadline = monotonic() + PATIENCE
    for agent in stopping:
        agent.wait(deadline - monotonic())
        agent.kill()
    for agent in stopping:
        agent.wait(PATIENCE)
        agent.finish()
