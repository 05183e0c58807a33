"""The channel for messages of a run. It leads to the parent process, or to the terminal if behave is run by hand."""

from __future__ import annotations

import os
import sys
from threading import Lock
from typing import TYPE_CHECKING

from robbdd_tools.agent import stack_dumps
from robbdd_tools.base.printable import printable
from robbdd_tools.protocol.messages import LogLine, ScenarioFinished, ScenarioStarted, encode

if TYPE_CHECKING:
    from robbdd_tools.protocol.messages import RunMessage


class Channel:
    """Prints warnings and errors to standard error, and drops all other messages, which behave prints itself."""

    def send(self, message: RunMessage) -> None:
        """Print or drop a message."""
        # behave captures sys.stderr.
        if isinstance(message, LogLine) and message.level != "info" and sys.__stderr__ is not None:
            print(f"{message.level}: {printable(message.text)}", file=sys.__stderr__)


class Lines(Channel):
    """Writes each message immediately to a file descriptor, as a line of JSON."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor
        self._writing = Lock()

    def send(self, message: RunMessage) -> None:
        """Write a message. If no process reads the channel any more, exit without a message."""
        data = (encode(message) + "\n").encode()
        try:
            # Threads of users' code print, too.
            with self._writing:
                while data:
                    data = data[os.write(self._descriptor, data) :]
        except BrokenPipeError:
            os._exit(1)


class Reports(Lines):
    """The channel of an agent. It records the current scenario, if any, and the finished scenarios."""

    def __init__(self, descriptor: int) -> None:
        super().__init__(descriptor)
        self.scenario: int | None = None
        self.finished: set[int] = set()

    def send(self, message: RunMessage) -> None:
        """Write a message."""
        super().send(message)
        match message:
            case ScenarioStarted(index):
                self.scenario = index
                stack_dumps.watch()
            case ScenarioFinished(index):
                stack_dumps.rest()
                self.scenario = None
                self.finished.add(index)
            case _:
                pass


_current = Channel()


def current_channel() -> Channel:
    """Return the channel of this process."""
    return _current


def use_channel(channel: Channel) -> None:
    """Set the channel of this process."""
    global _current
    _current = channel
