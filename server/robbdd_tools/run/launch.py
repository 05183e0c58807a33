"""Starts agent processes, gives them orders, streams their messages, stops them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from subprocess import TimeoutExpired
from time import monotonic

from robbdd_tools.base.files import load_bytes
from robbdd_tools.base.interpreter import start
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.base.processes import describe_exit, end_group, request_end
from robbdd_tools.run.protocol import Execute, LogLine, RunMessage, decode, encode

LOGS = "logs"
WORK = "work"
"""Working directory of the agents, in the run's folder: files that users' code writes are kept with the run."""
PATIENCE = 0.2
"""Seconds that agents have to end by themselves when they are told to stop."""


class Agent:
    """One agent process working on a run folder; ``number`` names its log.

    ``module`` is what it runs, ``arguments`` what this is told beside the folder.
    """

    def __init__(
        self, folder: Path, number: int = 1, module: str = "robbdd_tools.agent", arguments: Sequence[str] = ()
    ) -> None:
        folder = folder.absolute()
        work = folder / WORK
        work.mkdir(exist_ok=True)
        self._log = folder / LOGS / f"agent-{number}.log"
        self._log.parent.mkdir(exist_ok=True)
        with self._log.open("wb") as log:
            self._process = start(module, str(folder), *arguments, folder=work, log=log)

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
        assert self._process.stdout is not None
        for line in self._process.stdout:
            try:
                yield decode(line)
            except ValueError:
                yield LogLine("warning", line.rstrip())
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
        tail = self._last_log_line()
        return f"the agent process ended unexpectedly with {describe_exit(code)}" + (f": {tail}" if tail else "")

    def terminate(self) -> None:
        """Ask the process to end now."""
        if self._process.poll() is None:
            request_end(self._process)

    def wait(self, seconds: float) -> None:
        """Wait for the process's end, at most for a time."""
        with suppress(TimeoutExpired):
            self._process.wait(max(0.0, seconds))

    def _last_log_line(self) -> str:
        try:
            lines = load_bytes(self._log, RESULT_SIZE).decode(errors="replace").split("\n")
        except OSError:
            return ""
        return next((line.strip() for line in reversed(lines) if line.strip()), "")


def stop(agents: Iterable[Agent]) -> None:
    """Stop processes together, in good order where they heed it, within ``PATIENCE``."""
    stopping = list(agents)
    for agent in stopping:
        agent.terminate()
    deadline = monotonic() + PATIENCE
    for agent in stopping:
        agent.wait(deadline - monotonic())
        agent.kill()
    for agent in stopping:
        agent.wait(PATIENCE)
