"""Starts agent processes, gives them orders, streams their messages, stops them."""

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
from robbdd_tools.run.agent_log import LIMIT, BoundedLog

LOGS = "logs"
WORK = "work"
"""Working directory of the agents, in the run's folder: files that users' code writes are kept with the run."""
MESSAGE_BEGIN = '{"type": '
"""How ``encode`` begins every message; within a string its quotes would be escaped."""
LONGEST = 1024 * 1024
"""Bytes that a line of the message channel has at most."""
MOST_STRANGE = 20
"""Lines that are no messages of which a run shows the text, for each process."""
PATIENCE = 0.2
"""Seconds that agents have to end by themselves when they are asked to stop."""
_numbers = itertools.count(1)


class Agent:
    """One agent process working on a run folder; ``number`` names its log.

    ``module`` is what it runs, ``arguments`` are its arguments after the folder. Of what it prints, ``log_limit``
    bytes are kept.
    """

    def __init__(
        self,
        folder: Path,
        number: int = 1,
        module: str = "robbdd_tools.agent",
        arguments: Sequence[str] = (),
        log_limit: int = LIMIT,
    ) -> None:
        folder = folder.absolute()
        work = folder / WORK
        work.mkdir(exist_ok=True)
        (folder / LOGS).mkdir(exist_ok=True)
        self._log = BoundedLog(folder / LOGS / f"agent-{number}.log", log_limit)
        self._mark = f"{os.getpid()}-{next(_numbers)}"
        with self._log.stream as log:
            self._process = start(module, str(folder), *arguments, folder=work, log=log, more={MARK: self._mark})
        self._leftovers = threading.Thread(target=self._end_leftovers, daemon=True)
        self._leftovers.start()

    @property
    def pid(self) -> int:
        """The process's number."""
        return self._process.pid

    def execute(self, index: int) -> None:
        """Order a scenario; an agent that is gone says so by the end of its messages."""
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(encode(Execute(index)) + "\n")
            self._process.stdin.flush()
        except (OSError, ValueError):  # its pipe is broken, or closed already
            pass

    def messages(self) -> Iterator[RunMessage]:
        """Yield the messages as they come until the process ends; a line that is no message becomes a log line."""
        strange = 0
        for line in _lines(cast(BinaryIO, cast(TextIOWrapper, self._process.stdout).buffer)):
            try:
                yield _decoded(line)
            except ValueError as error:
                strange += 1
                if strange <= MOST_STRANGE:
                    yield LogLine("warning", str(error))
        self._process.wait()
        self._close()

    def _close(self) -> None:
        """Give back the descriptors of a process that has ended: this object may live on."""
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                with suppress(OSError):
                    pipe.close()

    def kill(self) -> None:
        """End the process and its children at once."""
        if self._process.poll() is None:
            end_group(self._process)

    def ending(self) -> str:
        """Say how the process ended, for clauses that it left open."""
        code = self._process.wait()
        self._log.wait(PATIENCE)
        tail = self._log.last_line()
        return f"the agent process ended unexpectedly with {describe_exit(code)}" + (f": {tail}" if tail else "")

    def terminate(self) -> None:
        """Ask the process to end now."""
        if self._process.poll() is None:
            request_end(self._process)

    def finish(self) -> None:
        """End what is left of an ended process and complete its log."""
        self._leftovers.join(PATIENCE)
        self._log.wait(PATIENCE)

    def wait(self, seconds: float) -> None:
        """Wait for the process's end, at most for a time."""
        with suppress(TimeoutExpired):
            self._process.wait(max(0.0, seconds))

    def _end_leftovers(self) -> None:
        """End what the process leaves behind when it ends: it may hold the channel and the log open."""
        self._process.wait()
        end_group(self._process)
        end_marked(self._mark)


def _decoded(line: str) -> RunMessage:
    """Return the message of a line, behind what other code wrote to the channel without ending its line, if any."""
    try:
        return decode(line)
    except ValueError:
        begin = line.rfind(MESSAGE_BEGIN)
        if begin <= 0:
            raise
        return decode(line[begin:])


def _lines(stream: BinaryIO) -> Iterator[str]:
    """Yield the lines of a stream that are not empty; of one that is too long only its beginning."""
    while part := stream.readline(LONGEST + 1):
        rest = part
        while len(rest) > LONGEST and not rest.endswith(b"\n"):
            rest = stream.readline(LONGEST + 1)
        if part.strip():
            yield part.decode("utf-8", "backslashreplace").rstrip("\n")


def stop(agents: Iterable[Agent]) -> None:
    """Stop processes together, letting them end by themselves where they do, within ``PATIENCE``."""
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
